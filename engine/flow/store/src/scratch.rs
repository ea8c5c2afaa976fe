//! Temporary folder of one process, and the removal of those of dead processes.

use crate::layout::{Layout, read_dir_or_nothing};
use crate::locks::lock_file;
use cosfly_diagnose::{Diagnostic, Result};
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

const OWNER: &str = "owner";

/// A folder below `tmp/` that belongs to one open store and is removed when the store is closed.
#[derive(Debug)]
pub(crate) struct Scratch {
    folder: PathBuf,
    next: AtomicU64,
    /// File that is locked while the owner lives; `None` in a store opened for reading.
    owner: Option<File>,
}

impl Scratch {
    /// Creates a new folder of this process.
    pub(crate) fn create(layout: &Layout) -> Result<Self> {
        Self::try_create(layout).map_err(|error| {
            Diagnostic::io(format!("create a temporary folder in `{}`", layout.folder("tmp").display()), &error)
        })
    }

    fn try_create(layout: &Layout) -> io::Result<Self> {
        // Creators need not wait for each other: a folder is created in one step.
        let guard = guard(layout)?;
        guard.lock_shared()?;
        let mut attempt = 0_u64;
        let folder = loop {
            let folder = layout.folder("tmp").join(format!("{}-{attempt}", std::process::id()));
            match fs::create_dir(&folder) {
                Ok(()) => break folder,
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => attempt += 1,
                Err(error) => return Err(error),
            }
        };
        let owner = lock_file(&folder.join(OWNER))?;
        owner.lock()?;
        Ok(Self { folder, next: AtomicU64::new(0), owner: Some(owner) })
    }

    /// Placeholder for a store opened for reading: the folder does not exist, so that nothing can be written into it.
    pub(crate) fn none(layout: &Layout) -> Self {
        Self { folder: layout.folder("tmp").join("read-only"), next: AtomicU64::new(0), owner: None }
    }

    /// File that this process keeps locked while the store is open; `None` in a store opened for reading.
    pub(crate) fn owner(&self) -> Option<PathBuf> {
        self.owner.as_ref().map(|_| self.folder.join(OWNER))
    }

    /// An unused path in the folder.
    pub(crate) fn next_path(&self) -> PathBuf {
        self.folder.join(self.next.fetch_add(1, Ordering::Relaxed).to_string())
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        if self.owner.is_some() {
            let _ = fs::remove_dir_all(&self.folder);
        }
    }
}

/// Number and bytes of the folders below `tmp/` whose owner is dead; they are removed unless `dry_run`.
pub(crate) fn sweep_orphans(layout: &Layout, dry_run: bool) -> io::Result<(u64, u64)> {
    let guard = guard(layout)?;
    guard.lock()?;
    let (mut folders, mut bytes) = (0, 0);
    for entry in read_dir_or_nothing(&layout.folder("tmp"))? {
        let folder = entry?.path();
        if is_orphan(&folder) {
            folders += 1;
            bytes += folder_bytes(&folder);
            if !dry_run {
                remove_unless_gone(&folder)?;
            }
        }
    }
    Ok((folders, bytes))
}

/// Removes a folder whose owner may be closing the store, and removing it, at the same time.
fn remove_unless_gone(folder: &Path) -> io::Result<()> {
    for _ in 0..100 {
        match fs::remove_dir_all(folder) {
            // A file in it disappeared, or the folder itself; try again.
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::DirectoryNotEmpty) => {}
            other => return other,
        }
        if fs::symlink_metadata(folder).is_err_and(|error| error.kind() == io::ErrorKind::NotFound) {
            break;
        }
    }
    Ok(())
}

fn is_orphan(folder: &Path) -> bool {
    if !folder.file_name().and_then(|name| name.to_str()).is_some_and(is_our_name) {
        return false;
    }
    // Without an owner file the process died between creating the folder and locking it (creators hold the guard).
    File::open(folder.join(OWNER))
        .map_or_else(|error| error.kind() == io::ErrorKind::NotFound && folder.is_dir(), |file| file.try_lock().is_ok())
}

/// Whether a name has the form `<process>-<attempt>`.
fn is_our_name(name: &str) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    name.split_once('-').is_some_and(|(process, attempt)| is_number(process) && is_number(attempt))
}

fn folder_bytes(folder: &Path) -> u64 {
    let Ok(entries) = fs::read_dir(folder) else { return 0 };
    entries.flatten().filter_map(|entry| entry.metadata().ok()).map(|metadata| metadata.len()).sum()
}

/// Lock that creators of temporary folders share, and that their removers hold alone.
fn guard(layout: &Layout) -> io::Result<File> {
    lock_file(&layout.root.join("locks/tmp"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_of_dead_owners_are_swept_and_those_of_the_living_stay() {
        let root = tempfile::tempdir().unwrap();
        let layout = Layout::create_or_check(root.path()).unwrap();
        let living = Scratch::create(&layout).unwrap();
        fs::write(living.next_path(), b"mine").unwrap();
        let dead = root.path().join("tmp/999999-0");
        fs::create_dir(&dead).unwrap();
        fs::write(dead.join(OWNER), b"").unwrap();
        fs::write(dead.join("0"), b"12345").unwrap();
        assert_eq!(sweep_orphans(&layout, true).unwrap(), (1, 5));
        assert_eq!(sweep_orphans(&layout, false).unwrap(), (1, 5));
        assert!(!dead.exists() && living.folder.exists());
        let folder = living.folder.clone();
        drop(living);
        assert!(!folder.exists());
    }

    #[test]
    fn a_worker_leaves_what_the_dead_left_and_others_remove_it() {
        let root = tempfile::tempdir().unwrap();
        let dead = root.path().join("tmp/999999-0");
        fs::create_dir_all(root.path().join("locks")).unwrap();
        fs::create_dir_all(&dead).unwrap();
        drop(crate::Store::open_as_worker(root.path()).unwrap());
        assert!(dead.exists());
        drop(crate::Store::open(root.path()).unwrap());
        assert!(!dead.exists());
    }

    #[test]
    fn what_is_not_ours_is_never_swept() {
        let root = tempfile::tempdir().unwrap();
        let layout = Layout::create_or_check(root.path()).unwrap();
        fs::create_dir(root.path().join("tmp/precious")).unwrap();
        assert_eq!(sweep_orphans(&layout, false).unwrap(), (0, 0));
    }

    #[test]
    fn sweeping_and_closing_together_never_fails() {
        let root = tempfile::tempdir().unwrap();
        let layout = Layout::create_or_check(root.path()).unwrap();
        std::thread::scope(|scope| {
            for _ in 0..2 {
                scope.spawn(|| (0..200).for_each(|_| drop(Scratch::create(&layout).unwrap())));
                scope.spawn(|| (0..200).for_each(|_| assert!(sweep_orphans(&layout, false).is_ok())));
            }
        });
    }
}
