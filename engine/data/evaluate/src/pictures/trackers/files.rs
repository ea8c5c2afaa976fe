//! Which file of a tracker is of which sequence.

use super::lines;
use super::sequences::TrackedSequence;
use crate::pictures::files::files_below;
use crate::pictures::report::FileProblem;
use crate::pictures::settings::PictureKind;
use cosfly_diagnose::Result;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Files that are looked into for the kind of results.
const LOOKED_INTO: usize = 8;

/// A tracker's files.
#[derive(Debug, Default)]
pub struct TrackerFiles {
    /// Paths from the folder on, by place of the sequence.
    pub files: BTreeMap<usize, PathBuf>,
    /// Files in all.
    pub read: u64,
    /// Files that are no results.
    pub passed_over: u64,
    /// Files that belong to no sequence.
    pub problems: Vec<FileProblem>,
}

/// Text files below `folder`, and the number of other files. Those of got10k's times are none.
fn texts(folder: &Path) -> Result<(Vec<PathBuf>, u64)> {
    let is_time = |path: &Path| path.parent().is_some_and(|parent| parent.ends_with("times"));
    files_below(folder, &|path| path.extension().is_some_and(|ending| ending == "txt") && !is_time(path))
        .map_err(|refusal| refusal.hint("a tracker's results are a folder with a text file for each sequence"))
}

/// The kind of a tracker's results, by the first line that has something; `None` for a folder without text files.
///
/// # Errors
/// A folder that cannot be read.
pub fn recognise(folder: &Path) -> Result<Option<PictureKind>> {
    let (texts, _) = texts(folder)?;
    let columns = |path: &PathBuf| lines::columns(&std::fs::read(folder.join(path)).ok()?);
    let found = texts.iter().take(LOOKED_INTO).find_map(columns);
    let kind = if found == Some(lines::OF_TARGET) { PictureKind::Target } else { PictureKind::Tracks };
    Ok((!texts.is_empty()).then_some(kind))
}

impl TrackerFiles {
    /// Looks up the sequence of every text file below `folder`: its name without the ending.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn of(folder: &Path, sequences: &[TrackedSequence]) -> Result<Self> {
        let by_name: BTreeMap<&str, usize> =
            sequences.iter().enumerate().map(|(place, sequence)| (sequence.name.as_str(), place)).collect();
        let (texts, passed_over) = texts(folder)?;
        let mut found = Self { read: texts.len() as u64, passed_over, ..Self::default() };
        for path in texts {
            let stem = path.file_stem().map(|stem| stem.to_string_lossy()).unwrap_or_default();
            let problem = match by_name.get(&*stem) {
                None => ("unknown-sequence", format!("there is no sequence `{stem}`")),
                Some(place) => match found.files.get(place) {
                    Some(first) => {
                        ("duplicate", format!("a second file of the sequence; `{}` counts", first.display()))
                    }
                    None => {
                        found.files.insert(*place, path);
                        continue;
                    }
                },
            };
            found.problems.push(FileProblem::new(path.display(), problem.0, problem.1));
        }
        Ok(found)
    }
}
