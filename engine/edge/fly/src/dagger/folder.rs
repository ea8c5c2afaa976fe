//! [`LabelFolder`]: a version of the labels: `card.json`, `rounds/ROUND/EPISODE.jsonl`, and arrays over all of them.

use super::kept::{KeptShape, ObservationKeeper};
use super::npy;
use super::rollout::{ExpertLabel, Rollout};
use crate::results::{EnvironmentCard, PicturesCard, PolicyCard, SuiteCard, differences};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_whole::{Appeared, NewFolder, draft, write_file};
use serde::{Deserialize, Serialize};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Content of a version.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LabelCard {
    /// Suite.
    pub suite: SuiteCard,
    /// Settings of the environment.
    pub environment: EnvironmentCard,
    /// Pictures that are kept with every label, in all rounds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pictures: Option<PicturesCard>,
    /// Sensors whose readings are kept with every label, in all rounds.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub readings: Vec<String>,
    /// Rounds, the oldest first.
    pub rounds: Vec<RoundCard>,
    /// Version of cosfly.
    pub cosfly: String,
}

impl LabelCard {
    /// Names and shapes of the observations that are kept.
    fn kept(&self) -> Vec<(&'static str, KeptShape)> {
        let pictures = self.pictures.iter();
        let pictures = pictures.flat_map(|of| of.channels().map(|it| (it.name, KeptShape::of(it, of.size()))));
        let sensors = self.readings.iter().filter_map(|name| cosfly_sensors::called(name));
        pictures.chain(sensors.map(|it| (it.name, KeptShape::of_readings(it)))).collect()
    }
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

/// Outcome of a round.
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

/// A version of the labels. Its folder appears with its card and the rounds before when the first episode is kept: a policy that
/// never flies leaves none.
pub struct LabelFolder {
    path: PathBuf,
    card: LabelCard,
    onto: Option<PathBuf>,
    /// Whether the folder with this card was there, or was made.
    is_there: AtomicBool,
}

impl LabelFolder {
    /// The folder for a card whose last round is to be made, with the rounds of the version `onto`. It may be there already.
    ///
    /// # Errors
    /// `dagger-out` where something else is in the folder; errors of the file system.
    pub fn open(path: &Path, card: &LabelCard, onto: Option<&Path>) -> Result<Self> {
        let (path, onto) = (path.to_owned(), onto.map(Path::to_owned));
        let folder = Self { path, card: card.clone(), onto, is_there: AtomicBool::new(false) };
        if folder.look()? {
            folder.copy_rounds(&folder.path)?;
        }
        Ok(folder)
    }

    /// Whether the folder is there with this card.
    fn look(&self) -> Result<bool> {
        let (path, refused) = (&self.path, |message: String| Diagnostic::new("dagger-out", Fault::Recipe, message));
        loop {
            let is_empty = match path.read_dir() {
                Ok(mut entries) => entries.next().is_none(),
                Err(error) => error.kind() == ErrorKind::NotFound,
            };
            match Self::card(path) {
                Ok(kept) if same_but_made(&kept, &self.card) => {
                    self.is_there.store(true, Ordering::Relaxed);
                    return Ok(true);
                }
                Ok(kept) => {
                    let value = |card: &LabelCard| serde_json::to_value(unmade(card)).unwrap_or_default();
                    let refusal = refused(format!("`{}` holds another version of labels", path.display()));
                    let differ = differences("", &value(&kept), &value(&self.card));
                    return Err(differ.into_iter().fold(refusal, Diagnostic::because).hint(
                        "give a new folder with `--out`; a version is never changed, `--onto` begins with its rounds",
                    ));
                }
                Err(_) if is_empty && !path.join("card.json").exists() => return Ok(false),
                // Made between the two looks.
                Err(_) if is_empty => {}
                Err(_) => {
                    let message = format!("`{}` is a folder with other files", path.display());
                    return Err(refused(message).hint("give another folder with `--out`"));
                }
            }
        }
    }

    /// Makes the folder with its card and the rounds before, where nobody has.
    fn make(&self) -> Result<()> {
        if self.is_there.load(Ordering::Relaxed) {
            return Ok(());
        }
        let refused = |error: std::io::Error| failed("make", &self.path, &error);
        let folder = NewFolder::beside(&self.path).map_err(refused)?;
        self.copy_rounds(folder.path())?;
        std::fs::write(folder.path().join("card.json"), pretty(&self.card)).map_err(refused)?;
        if folder.appear().map_err(refused)? == Appeared::Taken && self.look()? {
            self.copy_rounds(&self.path)?;
        }
        self.is_there.store(true, Ordering::Relaxed);
        Ok(())
    }

    /// Copies what is missing of the rounds before into a folder.
    fn copy_rounds(&self, folder: &Path) -> Result<()> {
        for round in &self.card.rounds {
            let place = folder.join("rounds").join(&round.name);
            std::fs::create_dir_all(&place).map_err(|error| failed("make", &place, &error))?;
            let Some(onto) = self.onto.as_ref().filter(|_| round.made.is_some()) else { continue };
            let from = onto.join("rounds").join(&round.name);
            let entries = from.read_dir().map_err(|error| failed("read", &from, &error))?;
            for entry in entries {
                let entry = entry.map_err(|error| failed("read", &from, &error))?;
                let copy = place.join(entry.file_name());
                if !copy.exists() {
                    let copied = std::fs::read(entry.path()).and_then(|bytes| write_file(&copy, &bytes));
                    copied.map_err(|error| failed("copy", &entry.path(), &error))?;
                }
            }
        }
        Ok(())
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
    pub fn keep(&self, round: &str, episode: &str, rollout: &Rollout, kept: &ObservationKeeper) -> Result<()> {
        self.make()?;
        for (name, file) in kept.files() {
            self.write(&format!("rounds/{round}/{episode}.{name}.npy"), &file)?;
        }
        let line = |label: &ExpertLabel| serde_json::to_string(label).unwrap_or_default() + "\n";
        let text: String = rollout.labels.iter().map(line).collect();
        self.write(&format!("rounds/{round}/{episode}.jsonl"), text.as_bytes())
    }

    /// Writes the arrays over all rounds and the card, once the last round has all episodes (in this order).
    ///
    /// # Errors
    /// Errors of the file system; `dagger-version` where a file is damaged.
    pub fn finish(&self, mut card: LabelCard, episodes: &[&str]) -> Result<LabelCard> {
        self.make()?;
        let (mut all, mut files) = (Vec::new(), Vec::new());
        for round in &mut card.rounds {
            let first = all.len();
            let mut listed = String::new();
            for episode in episodes {
                let path = self.path.join("rounds").join(&round.name).join(format!("{episode}.jsonl"));
                let text = std::fs::read_to_string(&path).map_err(|error| failed("read", &path, &error))?;
                listed.push_str(&format!("{episode} {}\n", Digest::of(text.as_bytes())));
                files.push((path.with_extension(""), all.len()));
                for line in text.lines() {
                    let label = serde_json::from_str::<ExpertLabel>(line);
                    all.push(label.map_err(|error| damaged(&path, &error.to_string()))?);
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
        let is_labelled: Vec<bool> = all.iter().map(|label| label.expert_action.is_some()).collect();
        for (name, shape) in card.kept() {
            self.gather(name, &shape, &files, &is_labelled)?;
        }
        self.write("card.json", pretty(&card).as_bytes())?;
        Ok(card)
    }

    /// Writes the observations of all labelled states. `files` are the episodes' files without their extension, and the first of
    /// their steps among all.
    fn gather(&self, name: &str, shape: &KeptShape, files: &[(PathBuf, usize)], is_labelled: &[bool]) -> Result<()> {
        let path = self.path.join(format!("{name}.npy"));
        let refused = |error: std::io::Error| failed("write", &path, &error);
        let mut file = draft(&path).map_err(refused)?;
        file.write_all(&shape.head(is_labelled.iter().filter(|it| **it).count())).map_err(refused)?;
        let ends = files.iter().skip(1).map(|(_, first)| *first).chain([is_labelled.len()]);
        for ((episode, first), end) in files.iter().zip(ends) {
            let of_episode = PathBuf::from(format!("{}.{name}.npy", episode.display()));
            let bytes = std::fs::read(&of_episode).map_err(|error| failed("read", &of_episode, &error))?;
            let is_labelled = &is_labelled[*first..end];
            let Some(pixels) = bytes.strip_prefix(&shape.head(is_labelled.len())[..]) else {
                return Err(damaged(&of_episode, "it does not begin as a file of so many steps of this shape"));
            };
            if pixels.len() != is_labelled.len() * shape.bytes() {
                return Err(damaged(&of_episode, "it is not as long as its beginning says"));
            }
            for (pixels, _) in pixels.chunks_exact(shape.bytes()).zip(is_labelled).filter(|it| *it.1) {
                file.write_all(pixels).map_err(refused)?;
            }
        }
        file.persist(&path).map_err(|error| refused(error.error))?;
        Ok(())
    }

    fn write(&self, name: &str, bytes: &[u8]) -> Result<()> {
        let path = self.path.join(name);
        write_file(&path, bytes).map_err(|error| failed("write", &path, &error))
    }
}

/// Whether two cards ask for the same version, whatever of it is made.
fn same_but_made(kept: &LabelCard, asked: &LabelCard) -> bool {
    unmade(kept) == unmade(asked)
}

/// A card without what is made of its last round.
fn unmade(card: &LabelCard) -> LabelCard {
    let mut card = card.clone();
    card.rounds.last_mut().into_iter().for_each(|round| round.made = None);
    card
}

fn damaged(path: &Path, why: &str) -> Box<Diagnostic> {
    let message = format!("`{}` is damaged", path.display());
    Diagnostic::new("dagger-version", Fault::Input, message).because(why)
}

fn failed(what: &str, path: &Path, error: &std::io::Error) -> Box<Diagnostic> {
    Diagnostic::io(format!("{what} {}", path.display()), error)
}

fn pretty(value: &impl Serialize) -> String {
    serde_json::to_string_pretty(value).unwrap_or_default() + "\n"
}
