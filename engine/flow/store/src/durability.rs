//! Makes a group of files durable with one system call.

use crate::layout::Layout;
use crate::mutex::locked;
use cosfly_diagnose::{Diagnostic, Result};
use std::collections::BTreeSet;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// Syncs the file system of the store; where `syncfs` is missing, syncs the written files one by one.
#[derive(Debug)]
pub(crate) struct Durability {
    /// Folder of the store; absent in a store that only reads.
    #[cfg(target_os = "linux")]
    root: Option<File>,
    /// Files renamed into place since the last sync.
    unsynced: Mutex<Vec<PathBuf>>,
}

impl Durability {
    pub(crate) fn of(layout: &Layout) -> Result<Self> {
        #[cfg(target_os = "linux")]
        let root = File::open(&layout.root)
            .map_err(|error| Diagnostic::io(format!("open `{}`", layout.root.display()), &error))?;
        #[cfg(not(target_os = "linux"))]
        let _ = layout;
        Ok(Self {
            #[cfg(target_os = "linux")]
            root: Some(root),
            unsynced: Mutex::default(),
        })
    }

    /// For a store that only reads, and may not exist.
    pub(crate) fn none() -> Self {
        Self {
            #[cfg(target_os = "linux")]
            root: None,
            unsynced: Mutex::default(),
        }
    }

    /// Registers a file that was renamed into place.
    pub(crate) fn note(&self, path: &Path) {
        locked(&self.unsynced).push(path.to_owned());
    }

    /// Makes all files registered before the call durable.
    pub(crate) fn sync(&self) -> io::Result<()> {
        let files = std::mem::take(&mut *locked(&self.unsynced));
        #[cfg(target_os = "linux")]
        match self.root.as_ref().map_or(Err(rustix::io::Errno::NOSYS), rustix::fs::syncfs) {
            Ok(()) => return Ok(()),
            Err(rustix::io::Errno::NOSYS | rustix::io::Errno::PERM | rustix::io::Errno::OPNOTSUPP) => {}
            Err(error) => return Err(error.into()),
        }
        sync_one_by_one(&files)
    }
}

fn sync_one_by_one(files: &[PathBuf]) -> io::Result<()> {
    let mut folders = BTreeSet::new();
    for path in files {
        match File::open(path) {
            Ok(file) => file.sync_all()?,
            // The file was replaced or collected meanwhile.
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(error),
        }
        folders.extend(path.parent());
    }
    if cfg!(unix) {
        folders.into_iter().try_for_each(|folder| File::open(folder)?.sync_all())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn syncing_one_by_one_passes_over_files_that_are_gone() {
        let folder = tempfile::tempdir().unwrap();
        let there = folder.path().join("a");
        std::fs::write(&there, b"a").unwrap();
        sync_one_by_one(&[there, folder.path().join("gone")]).unwrap();
    }
}
