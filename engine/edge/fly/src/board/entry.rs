//! [`Entry`]: a bundle on a board. [`Found`]: its files, as they lie in a folder.

use super::notes::Notes;
use super::sees::PolicySees;
use crate::bundle::MOST_BYTES;
use crate::flight::Row;
use crate::results::{Card, SuiteCard};
use cosfly_diagnose::{Diagnostic, Result, counted};
use std::collections::BTreeSet;
use std::path::Path;

/// Ending of the files of bundles.
const BUNDLE: &str = ".jsonl.zst";
/// Ending of the files of notes.
const NOTES: &str = ".toml";
/// Ending of the files of policies.
const POLICY: &str = ".onnx";

/// Proof of an entry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Proof {
    /// The policy was run again here on what it sees, and gave the same actions.
    Rerun,
    /// The actions were flown again here and came to the same rows, byte for byte. Where the policy was run and gave other actions, in
    /// words.
    Reflown(Vec<String>),
    /// The actions came to the same rows; the policy could not be run. Why, in words.
    NotRun(Vec<String>),
    /// Rows that came out otherwise: the scores are a claim. Where they differ, in words.
    Claimed(Vec<String>),
}

impl Proof {
    /// The word.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Rerun => "re-run",
            Self::Reflown(_) | Self::NotRun(_) => "re-flown",
            Self::Claimed(_) => "claimed",
        }
    }

    /// Differences in words, an entry for each episode; or why the policy could not be run.
    pub fn differs(&self) -> &[String] {
        match self {
            Self::Rerun => &[],
            Self::Reflown(differ) | Self::NotRun(differ) | Self::Claimed(differ) => differ,
        }
    }
}

/// A bundle on a board.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Name of its file, without the ending.
    pub file: String,
    /// Its card.
    pub card: Card,
    /// The suite as it is here.
    pub suite: SuiteCard,
    /// Its rows, in the order of the suite.
    pub rows: Vec<Row>,
    /// Notes of its maker.
    pub notes: Notes,
    /// Inputs that the policy sees.
    pub sees: PolicySees,
    /// Proof of the entry.
    pub proof: Proof,
    /// Its worst episode as a drawing (SVG).
    pub clip: String,
}

/// The file of a bundle with its notes and its policy.
pub struct Found {
    /// Bytes of the file.
    pub bytes: Vec<u8>,
    /// The policy beside it, a network in ONNX.
    pub policy: Option<Vec<u8>>,
    /// Notes of its maker.
    pub notes: Notes,
}

/// Names of the entries of a folder, sorted: of all files of bundles, notes and policies, without their endings.
///
/// # Errors
/// Errors of the file system.
pub fn names(folder: &Path) -> Result<BTreeSet<String>> {
    let refused = |error: std::io::Error| Diagnostic::io(format!("read {}", folder.display()), &error);
    let mut names = BTreeSet::new();
    for entry in folder.read_dir().map_err(refused)? {
        let name = entry.map_err(refused)?.file_name().to_string_lossy().into_owned();
        let stem = name.strip_suffix(BUNDLE).or_else(|| [NOTES, POLICY].iter().find_map(|end| name.strip_suffix(end)));
        names.extend(stem.filter(|stem| !stem.is_empty() && !stem.starts_with('.')).map(str::to_owned));
    }
    Ok(names)
}

impl Found {
    /// Reads an entry of a folder.
    ///
    /// # Errors
    /// Fault of its files, in words.
    pub fn read(folder: &Path, name: &str) -> std::result::Result<Self, String> {
        let bytes = bytes_of(&folder.join(format!("{name}{BUNDLE}")), MOST_BYTES)?;
        let bytes = bytes.ok_or_else(|| format!("there is no `{name}{BUNDLE}` beside its notes or its policy"))?;
        let policy = bytes_of(&folder.join(format!("{name}{POLICY}")), cosfly_onnx::MOST_BYTES as u64)?;
        let notes = match bytes_of(&folder.join(format!("{name}{NOTES}")), 1 << 16)? {
            Some(notes) => {
                let text = String::from_utf8(notes).map_err(|_| format!("`{name}{NOTES}` is no text in UTF-8"))?;
                Notes::of_text(&format!("{name}{NOTES}"), &text)?
            }
            None => Notes::default(),
        };
        Ok(Self { bytes, policy, notes })
    }
}

/// Bytes of a file; `None` where there is none.
fn bytes_of(path: &Path, most: u64) -> std::result::Result<Option<Vec<u8>>, String> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    // A link could show what lies elsewhere on this machine.
    match path.symlink_metadata() {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(format!("`{name}` cannot be read: {error}")),
        Ok(about) if !about.is_file() => Err(format!("`{name}` is a link or a folder, no file")),
        Ok(about) if about.len() > most => {
            Err(format!("`{name}` has {}; it may have {most}", counted(about.len(), "byte")))
        }
        Ok(_) => std::fs::read(path).map(Some).map_err(|error| format!("`{name}` cannot be read: {error}")),
    }
}
