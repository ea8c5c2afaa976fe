//! [`LabelFolder`]: a version of the labels: `card.json`, `rounds/ROUND/EPISODE.jsonl`, and arrays over all of them.

use super::npy;
use super::rollout::{Label, Rollout};
use crate::results::{EnvironmentCard, PolicyCard, SuiteCard};
use crate::whole;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// What a version holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LabelCard {
    /// Suite.
    pub suite: SuiteCard,
    /// Settings of the environment.
    pub environment: EnvironmentCard,
    /// Rounds, the oldest first.
    pub rounds: Vec<RoundCard>,
    /// Version of cosfly.
    pub cosfly: String,
}

/// A round: flights of one policy under one mixture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoundCard {
    /// Name.
    pub name: String,
    /// Policy.
    pub policy: PolicyCard,
    /// Share of frames that the expert flew.
    pub by_expert: f64,
    /// Once whole: what came of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub made: Option<RoundMade>,
}

/// What came of a round.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoundMade {
    /// Episodes.
    pub episodes: u64,
    /// States.
    pub states: u64,
    /// States with an action of the expert.
    pub labels: u64,
    /// Digest of the episodes' files.
    pub digest: String,
}

/// A version of the labels.
pub struct LabelFolder {
    path: PathBuf,
}

impl LabelFolder {
    /// Opens the folder for a card whose last round is to be made, or makes it, with the rounds of the version `onto`.
    ///
    /// # Errors
    /// `dagger-out` where something else is in the folder; errors of the file system.
    pub fn open(path: &Path, card: &LabelCard, onto: Option<&Path>) -> Result<Self> {
        let folder = Self { path: path.to_owned() };
        match Self::card(path) {
            Ok(kept) if same_but_made(&kept, card) => {}
            Ok(_) => {
                let message = format!("`{}` holds another version of labels", path.display());
                return Err(Diagnostic::new("dagger-out", Fault::Recipe, message).hint(
                    "give a new folder with `--out`; a version is never changed, `--onto` begins with its rounds",
                ));
            }
            Err(_) if path.read_dir().is_ok_and(|mut entries| entries.next().is_some()) => {
                let message = format!("`{}` is a folder with other files", path.display());
                return Err(
                    Diagnostic::new("dagger-out", Fault::Recipe, message).hint("give another folder with `--out`")
                );
            }
            // The card comes first: a folder with one is gone on with.
            Err(_) => {
                std::fs::create_dir_all(path).map_err(|error| failed("make", path, &error))?;
                folder.write("card.json", pretty(card).as_bytes())?;
            }
        }
        for round in &card.rounds {
            let place = path.join("rounds").join(&round.name);
            std::fs::create_dir_all(&place).map_err(|error| failed("make", &place, &error))?;
            let Some(onto) = onto.filter(|_| round.made.is_some()) else { continue };
            let from = onto.join("rounds").join(&round.name);
            let entries = from.read_dir().map_err(|error| failed("read", &from, &error))?;
            for entry in entries {
                let entry = entry.map_err(|error| failed("read", &from, &error))?;
                let copy = place.join(entry.file_name());
                if !copy.exists() {
                    let copied = std::fs::read(entry.path()).and_then(|bytes| whole::write(&copy, &bytes));
                    copied.map_err(|error| failed("copy", &entry.path(), &error))?;
                }
            }
        }
        Ok(folder)
    }

    /// The card of a version.
    ///
    /// # Errors
    /// `dagger-version` where there is none.
    pub fn card(path: &Path) -> Result<LabelCard> {
        let refused = |cause: String| {
            let message = format!("`{}` is no version of labels", path.display());
            Diagnostic::new("dagger-version", Fault::Input, message)
                .because(cause)
                .hint("give a folder that `cosfly dagger` made")
        };
        let text = std::fs::read_to_string(path.join("card.json")).map_err(|error| refused(error.to_string()))?;
        serde_json::from_str(&text).map_err(|error| refused(error.to_string()))
    }

    /// Whether an episode of a round is there.
    pub fn has(&self, round: &str, episode: &str) -> bool {
        self.path.join("rounds").join(round).join(format!("{episode}.jsonl")).exists()
    }

    /// Keeps the labels of an episode.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn keep(&self, round: &str, episode: &str, rollout: &Rollout) -> Result<()> {
        let line = |label: &Label| serde_json::to_string(label).unwrap_or_default() + "\n";
        let text: String = rollout.labels.iter().map(line).collect();
        self.write(&format!("rounds/{round}/{episode}.jsonl"), text.as_bytes())
    }

    /// Writes the arrays over all rounds and the card, once the last round has all episodes (in this order).
    ///
    /// # Errors
    /// Errors of the file system; `dagger-version` where a file is damaged.
    pub fn finish(&self, mut card: LabelCard, episodes: &[&str]) -> Result<LabelCard> {
        let mut all = Vec::new();
        for round in &mut card.rounds {
            let first = all.len();
            let mut listed = String::new();
            for episode in episodes {
                let path = self.path.join("rounds").join(&round.name).join(format!("{episode}.jsonl"));
                let text = std::fs::read_to_string(&path).map_err(|error| failed("read", &path, &error))?;
                listed.push_str(&format!("{episode} {}\n", Digest::of(text.as_bytes())));
                for line in text.lines() {
                    let label = serde_json::from_str::<Label>(line).map_err(|error| {
                        let message = format!("`{}` is damaged", path.display());
                        Diagnostic::new("dagger-version", Fault::Input, message).because(error.to_string())
                    })?;
                    all.push(label);
                }
            }
            let of_round = &all[first..];
            let made = RoundMade {
                episodes: episodes.len() as u64,
                states: of_round.len() as u64,
                labels: of_round.iter().filter(|label| label.expert_action.is_some()).count() as u64,
                digest: Digest::of(listed.as_bytes()).to_string(),
            };
            if round.made.as_ref().is_some_and(|kept| *kept != made) {
                let message = format!("round `{}` is not what its card says", round.name);
                return Err(Diagnostic::new("dagger-version", Fault::Input, message)
                    .because("a file of it was changed or is damaged")
                    .hint("make the version that `--onto` names again, or begin with another one"));
            }
            round.made = Some(made);
        }
        let labelled = || all.iter().filter_map(|label| Some((label, label.expert_action?)));
        self.write("states.npy", &npy::floats(labelled().flat_map(|(label, _)| label.state), 16))?;
        self.write("expert_actions.npy", &npy::floats(labelled().flat_map(|(_, action)| action), 5))?;
        self.write("actions.npy", &npy::floats(labelled().flat_map(|(label, _)| label.action), 5))?;
        let seen = labelled().map(|(label, _)| label.expert_visibility.unwrap_or(0.0) as f32);
        self.write("expert_visibility.npy", &npy::floats(seen, 1))?;
        self.write("by_expert.npy", &npy::flags(labelled().map(|(label, _)| label.by_expert)))?;
        self.write("card.json", pretty(&card).as_bytes())?;
        Ok(card)
    }

    fn write(&self, name: &str, bytes: &[u8]) -> Result<()> {
        let path = self.path.join(name);
        whole::write(&path, bytes).map_err(|error| failed("write", &path, &error))
    }
}

/// Whether two cards ask for the same version, whatever of it is made.
fn same_but_made(kept: &LabelCard, asked: &LabelCard) -> bool {
    let unmade = |card: &LabelCard| {
        let mut card = card.clone();
        card.rounds.last_mut().into_iter().for_each(|round| round.made = None);
        card
    };
    unmade(kept) == unmade(asked)
}

fn failed(what: &str, path: &Path, error: &std::io::Error) -> Box<Diagnostic> {
    Diagnostic::io(format!("{what} {}", path.display()), error)
}

fn pretty(value: &impl Serialize) -> String {
    serde_json::to_string_pretty(value).unwrap_or_default() + "\n"
}
