//! [`Bundle`]: a result as one file that anyone can fly again.
//!
//! The file is JSON lines in zstd: the card; the policy, where the bundle holds it; for each episode its row and the actions of all
//! steps; the digest of all lines before it. Texts of the task and of failures are left out: they may hold paths.

use crate::flight::Row;
use crate::log::LogLine;
use crate::pilot::{OnnxPolicy, wrong_number};
use crate::results::{Card, Folder};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use cosfly_diagnose::{Diagnostic, Fault, Result, absent, counted};
use cosfly_env::Action;
use cosfly_fingerprint::Digest;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::io::Read;
use std::path::Path;

/// Format and version of bundles.
const FORMAT: &str = "cosfly-result/1";
/// Largest text of a bundle, bytes.
pub const MOST_BYTES: u64 = 1 << 27;
/// Largest first line of a bundle, bytes, and largest text in a row.
const MOST_WORDS: [usize; 2] = [1 << 16, 300];
/// Strength of the compression.
const LEVEL: i32 = 9;

/// A result as one file.
#[derive(Clone, Debug, PartialEq)]
pub struct Bundle {
    /// The card, without the text of the task.
    pub card: Card,
    /// Episodes in the order of the suite.
    pub episodes: Vec<EpisodeRecord>,
    /// The file of the policy, a network in ONNX.
    pub policy: Option<Vec<u8>>,
}

/// An episode in a bundle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EpisodeRecord {
    /// The outcome.
    pub row: Row,
    /// The steps.
    pub steps: Vec<StepRecord>,
}

/// A step in a bundle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepRecord {
    /// The action that the policy gave before the step; none while the one before was on its way.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
    /// Time that the policy took for it, where latencies are measured, seconds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub latency_s: Option<f64>,
    /// First eight digits of the digest of the step's line in the log.
    pub check: String,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Head {
    format: String,
    card: Card,
    /// Whether the second line is the policy.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    holds_policy: bool,
}

/// The line of the policy.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Held {
    /// The file, in base 64.
    onnx: String,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Tail {
    blake3: String,
}

impl EpisodeRecord {
    /// The record of an episode that was flown.
    pub fn of(row: &Row, steps: &[LogLine]) -> Self {
        let step = |line: &LogLine| StepRecord { action: line.flown, latency_s: line.latency_s, check: check(line) };
        Self { row: without_words(row), steps: steps.iter().map(step).collect() }
    }

    /// The row as text: the bytes that must come out again.
    pub fn row_text(&self) -> String {
        serde_json::to_string(&self.row).unwrap_or_default()
    }

    fn problem(&self) -> Option<String> {
        let number = |at: usize, it: &StepRecord| {
            let numbers = it.action.iter().flat_map(Action::all_numbers).chain(it.latency_s).collect::<Vec<f64>>();
            wrong_number(&numbers, numbers.len().max(1)).map(|wrong| format!("step {}: {wrong}", at + 1))
        };
        let late = |at: usize, it: &StepRecord| {
            let latency_s = it.latency_s.filter(|latency_s| *latency_s < 0.0)?;
            Some(format!("step {}: its latency is {latency_s} s; it must be at least 0", at + 1))
        };
        let unchecked = |at: usize, it: &StepRecord| {
            (it.check.len() != 8).then(|| format!("step {}: its `check` must have eight digits", at + 1))
        };
        if [Some(&self.row.episode), self.row.policy_failure.as_ref()]
            .into_iter()
            .flatten()
            .any(|it| it.len() > MOST_WORDS[1])
        {
            return Some(format!("its row has a text of more than {} bytes", MOST_WORDS[1]));
        }
        let problem = |(at, step)| number(at, step).or_else(|| late(at, step)).or_else(|| unchecked(at, step));
        self.steps.iter().enumerate().find_map(problem)
    }
}

/// First eight digits of the digest of a line.
fn check(line: &LogLine) -> String {
    let text = serde_json::to_string(line).unwrap_or_default();
    Digest::of(text.as_bytes()).to_string()[..8].to_owned()
}

/// A row without the words of a failure, which may hold paths and texts of the policy.
fn without_words(row: &Row) -> Row {
    let step = |failure: &String| failure.split(':').next().unwrap_or_default().to_owned();
    Row { policy_failure: row.policy_failure.as_ref().map(step), ..row.clone() }
}

impl Bundle {
    /// The result in a folder.
    ///
    /// # Errors
    /// `fly-result` where there is none, or it is damaged or from an earlier cosfly; errors of the file system.
    pub fn of(folder: &Path) -> Result<Self> {
        let (mut card, rows) = Folder::read(folder)?;
        let kept = Folder::open(folder, &card)?;
        let episode = |row: &Row| {
            let steps = kept.steps(&row.episode)?;
            if steps.iter().any(|line| line.action.is_some() && line.flown.is_none()) {
                let message = format!("the log of `{}` has no `flown`: an earlier cosfly wrote it", row.episode);
                return Err(Diagnostic::new("fly-result", Fault::Input, message).hint("fly the suite again"));
            }
            Ok(EpisodeRecord::of(row, &steps))
        };
        let episodes = rows.iter().map(episode).collect::<Result<_>>()?;
        card.policy.prompt.clear();
        Ok(Self { card, episodes, policy: None })
    }

    /// Bundle with the file of its policy.
    ///
    /// # Errors
    /// `fly-bundle` where the card names another file.
    pub fn with_policy(self, policy: &OnnxPolicy) -> Result<Self> {
        let (theirs, ours) = (policy.digest().to_string(), self.card.policy.source.clone().unwrap_or_default());
        if theirs != ours {
            let message = format!("`{}` is not the policy that flew this result", policy.name());
            let refusal = Diagnostic::new("fly-bundle", Fault::Recipe, message);
            return Err(refusal
                .because(format!(
                    "its digest is {theirs}; the card has {}",
                    if ours.is_empty() { "none" } else { &ours }
                ))
                .hint("give the file that `cosfly fly --policy onnx:FILE` flew"));
        }
        Ok(Self { policy: Some(policy.bytes().to_vec()), ..self })
    }

    /// The file.
    ///
    /// # Errors
    /// Errors of the compression.
    pub fn bytes(&self) -> Result<Vec<u8>> {
        let mut text =
            json(&Head { format: FORMAT.to_owned(), card: self.card.clone(), holds_policy: self.policy.is_some() });
        if let Some(policy) = &self.policy {
            text += &json(&Held { onnx: STANDARD.encode(policy) });
        }
        self.episodes.iter().for_each(|episode| text += &json(episode));
        text += &json(&Tail { blake3: Digest::of(text.as_bytes()).to_string() });
        if text.len() as u64 > MOST_BYTES {
            let message = format!(
                "the result has {} MB of steps and policy; a bundle holds {}",
                text.len() >> 20,
                MOST_BYTES >> 20
            );
            return Err(Diagnostic::new("fly-bundle", Fault::Recipe, message)
                .hint("fly fewer episodes into a result, such as a tier of a benchmark"));
        }
        zstd::stream::encode_all(text.as_bytes(), LEVEL).map_err(|error| Diagnostic::io("compress the bundle", &error))
    }

    /// Reads a file that [`Self::bytes`] made.
    ///
    /// # Errors
    /// `fly-bundle` for any other file, with the line; errors of the file system.
    pub fn read(path: &Path) -> Result<Self> {
        let shown = path.display();
        let absent = absent(path).map(|why| (why, "give the file that `cosfly fly bundle` made".to_owned()));
        let a_folder = || ("is a folder".to_owned(), format!("`cosfly fly bundle {shown}` makes the file of a result"));
        if let Some((what, hint)) = absent.or_else(|| path.is_dir().then(a_folder)) {
            return Err(Diagnostic::new("fly-bundle", Fault::Input, format!("`{shown}` {what}")).hint(hint));
        }
        let bytes = std::fs::read(path).map_err(|error| Diagnostic::unread(format!("`{shown}`"), &error))?;
        Self::of_bytes(&bytes).map_err(|rule| {
            Diagnostic::new("fly-bundle", Fault::Input, format!("`{shown}` is no whole bundle of `cosfly fly bundle`"))
                .because(rule)
                .hint("get the file again from whoever made it, or make it anew from the folder of the result")
        })
    }

    /// Reads the bytes of a file.
    ///
    /// # Errors
    /// The fault, in words.
    pub fn of_bytes(bytes: &[u8]) -> std::result::Result<Self, String> {
        let mut text = String::new();
        let reader = zstd::stream::read::Decoder::new(bytes).map_err(|error| error.to_string())?;
        let read = reader.take(MOST_BYTES + 1).read_to_string(&mut text);
        read.map_err(|error| format!("it cannot be unpacked: {error}"))?;
        if text.len() as u64 > MOST_BYTES {
            return Err(format!("it holds more than {} MB", MOST_BYTES >> 20));
        }
        let body = text.strip_suffix('\n').ok_or("its last line is cut")?;
        let (kept, tail) = body.rsplit_once('\n').ok_or("it has one line only")?;
        let tail: Tail = serde_json::from_str(tail).map_err(|_| "its last line, the digest, is missing".to_owned())?;
        if Digest::of(&text.as_bytes()[..=kept.len()]).to_string() != tail.blake3 {
            return Err("its digest is another one: it was edited or damaged".to_owned());
        }
        Self::of_text(kept)
    }

    /// Reads the lines of a file, without that of the digest.
    ///
    /// # Errors
    /// The fault, in words.
    pub fn of_text(text: &str) -> std::result::Result<Self, String> {
        let mut lines = text.lines().zip(1..);
        let head = lines.next().map_or("", |it| it.0);
        if head.len() > MOST_WORDS[0] {
            return Err(format!("its first line has {}; it may have {}", counted(head.len(), "byte"), MOST_WORDS[0]));
        }
        let format = serde_json::from_str::<serde_json::Value>(head).ok();
        let format = format.as_ref().and_then(|head| head["format"].as_str()).unwrap_or("nothing").to_owned();
        if format != FORMAT {
            return Err(format!("its format is `{format}`; this cosfly reads `{FORMAT}`"));
        }
        let Head { card, holds_policy, .. } = serde_json::from_str(head).map_err(|error| format!("line 1: {error}"))?;
        let policy = if holds_policy { Some(held(lines.next().map_or("", |it| it.0))?) } else { None };
        let (mut episodes, mut names): (Vec<EpisodeRecord>, BTreeSet<String>) = (vec![], BTreeSet::new());
        for (line, number) in lines {
            let episode: EpisodeRecord =
                serde_json::from_str(line).map_err(|error| format!("line {number}: {error}"))?;
            if let Some(problem) = episode.problem() {
                return Err(format!("line {number}: {problem}"));
            }
            if !names.insert(episode.row.episode.clone()) {
                return Err(format!("line {number}: `{}` stands in it twice", episode.row.episode));
            }
            episodes.push(episode);
        }
        if episodes.len() as u64 != card.suite.episodes {
            return Err(format!("it has {} of {}", episodes.len(), counted(card.suite.episodes, "episode")));
        }
        Ok(Self { card, episodes, policy })
    }
}

/// The file in the line of the policy.
fn held(line: &str) -> std::result::Result<Vec<u8>, String> {
    let Held { onnx } = serde_json::from_str(line).map_err(|error| format!("line 2, the policy: {error}"))?;
    STANDARD.decode(onnx).map_err(|error| format!("line 2, the policy: {error}"))
}

fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).unwrap_or_default() + "\n"
}
