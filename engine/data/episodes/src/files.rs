//! The files of a folder, and whether it is a dataset of cosfly.

use cosfly_diagnose::{Diagnostic, Result};
use std::path::{Path, PathBuf};

/// All files below a folder, sorted; links to folders are not followed.
pub fn files_below(folder: &Path) -> Result<Vec<PathBuf>> {
    let (mut files, mut open) = (vec![], vec![folder.to_owned()]);
    while let Some(directory) = open.pop() {
        let refused = |error| Diagnostic::io(format!("read `{}`", directory.display()), &error);
        for entry in std::fs::read_dir(&directory).map_err(refused)? {
            let entry = entry.map_err(refused)?;
            if entry.file_type().map_err(refused)?.is_dir() {
                open.push(entry.path())
            } else {
                files.push(entry.path())
            }
        }
    }
    files.sort();
    Ok(files)
}

/// Whether `folder` is a dataset of cosfly.
pub fn is_of_cosfly(folder: &Path) -> bool {
    folder.join("data/trajectories").is_dir()
}
