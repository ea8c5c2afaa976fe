//! Which file of a folder of predictions belongs to which frame; files that belong to none, with the reason.

use super::report::FileProblem;
use crate::windows::Flights;
use cosfly_diagnose::{Diagnostic, Result, counted};
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// Folders of an export that hold pictures of one kind.
const KINDS: [&str; 4] = ["rgb", "depth", "semantic", "instance"];

/// Files by flight and frame.
#[derive(Debug, Default)]
pub struct PredictedFiles {
    /// Paths by place of the flight and frame.
    pub files: BTreeMap<(usize, usize), PathBuf>,
    /// Pictures in all.
    pub read: u64,
    /// Files that are no pictures, or pictures of another kind.
    pub passed_over: u64,
    /// Files that belong to no frame.
    pub problems: Vec<FileProblem>,
}

/// Pictures below `folder`, sorted, from its path on: PNG files and NumPy arrays. Second: files that are none.
///
/// # Errors
/// A folder that cannot be read.
pub fn pictures(folder: &Path) -> Result<(Vec<PathBuf>, u64)> {
    files_below(folder, &|path| path.extension().is_some_and(is_picture))
}

/// Files below `folder` that are wanted, sorted, from its path on. Second: the number of the others.
///
/// # Errors
/// A folder that cannot be read.
pub fn files_below(folder: &Path, is_wanted: &dyn Fn(&Path) -> bool) -> Result<(Vec<PathBuf>, u64)> {
    let (mut found, mut others, mut open) = (vec![], 0, vec![PathBuf::new()]);
    while let Some(inner) = open.pop() {
        let path = folder.join(&inner);
        let refused = |error: std::io::Error| Diagnostic::unread(format!("`{}`", path.display()), &error);
        for entry in std::fs::read_dir(&path).map_err(refused)? {
            let entry = entry.map_err(refused)?;
            let name = inner.join(entry.file_name());
            // Symbolic links to folders are not followed: no way round in circles.
            if entry.file_type().map_err(refused)?.is_dir() {
                open.push(name);
            } else if is_wanted(&name) {
                found.push(name);
            } else {
                others += 1;
            }
        }
    }
    found.sort();
    Ok((found, others))
}

fn is_picture(ending: &OsStr) -> bool {
    ["png", "npy"].iter().any(|known| ending.eq_ignore_ascii_case(known))
}

/// The folder of an export that `path` lies in, if any: `depth` and so on.
pub fn kind_folder(path: &Path) -> Option<&'static str> {
    let folders = path.parent()?.iter();
    folders.rev().find_map(|part| KINDS.iter().copied().find(|kind| part == *kind))
}

impl PredictedFiles {
    /// Looks up the frame of every picture of `paths` that lies in no folder of another kind than `kind`.
    pub fn new(folder: &Path, (paths, others): (Vec<PathBuf>, u64), kind: &str, flights: &Flights) -> Self {
        let mut found = Self { passed_over: others, ..Self::default() };
        for path in paths {
            if kind_folder(&path).is_some_and(|other| other != kind) {
                found.passed_over += 1;
                continue;
            }
            found.read += 1;
            let mut refuse = |kind, reason| found.problems.push(FileProblem::new(path.display(), kind, reason));
            match frame_of(&path, flights) {
                Err((kind, reason)) => refuse(kind, reason),
                Ok(key) => match found.files.get(&key) {
                    Some(first) => {
                        let first = first.strip_prefix(folder).unwrap_or(first).display();
                        refuse("duplicate", format!("a second picture of the frame; `{first}` counts"));
                    }
                    None => {
                        found.files.insert(key, folder.join(&path));
                    }
                },
            }
        }
        found
    }
}

/// Flight and frame: the number at the end of the file's name, in a folder of the flight's name or after that name.
fn frame_of(path: &Path, flights: &Flights) -> std::result::Result<(usize, usize), (&'static str, String)> {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy()).unwrap_or_default();
    let name = stem.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let Ok(frame) = stem[name.len()..].parse::<usize>() else {
        return Err(("name", "its name does not end in the number of a frame".to_owned()));
    };
    let folders = path.parent().into_iter().flat_map(Path::iter).rev();
    let by_folder = folders.filter_map(OsStr::to_str).find_map(|part| flights.place(part));
    let before = name.trim_end_matches(['_', '-', '.']);
    let by_name = || flights.place(before).or_else(|| flights.place_by_key(before));
    let Some(flight) = by_folder.or_else(by_name) else {
        return Err((
            "unknown-trajectory",
            "neither a folder of its path nor the beginning of its name is a trajectory of the dataset".to_owned(),
        ));
    };
    let row = &flights.rows[flight];
    if frame >= row.frames {
        let (id, frames) = (&row.trajectory_id, row.frames);
        return Err((
            "no-frame",
            format!("`{id}` has {frames}: there is no frame {frame}", frames = counted(frames, "frame")),
        ));
    }
    Ok((flight, frame))
}
