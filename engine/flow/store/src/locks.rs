//! Advisory locks, released when their process ends: one per running task, one for garbage collection.

use crate::layout::Layout;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_fingerprint::Digest;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

/// Opens (and creates) a lock file.
pub(crate) fn lock_file(path: &Path) -> io::Result<File> {
    OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)
}

/// Lock of one task while a process computes it, so that other processes compute other tasks meanwhile. Without it
/// tasks would be computed twice, with the same result.
#[derive(Debug)]
pub struct TaskLock {
    path: PathBuf,
    /// File that is open while the lock is held.
    _file: File,
}

impl TaskLock {
    /// Lock of a task; `None` while another process holds it.
    pub(crate) fn try_take(layout: &Layout, plan: &Digest) -> Result<Option<Self>> {
        let path = layout.root.join("locks").join(format!("task-{plan}"));
        let failed = |error: &io::Error| Diagnostic::io(format!("lock `{}`", path.display()), error);
        loop {
            let file = lock_file(&path).map_err(|error| failed(&error))?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Ok(None),
                Err(TryLockError::Error(error)) => return Err(failed(&error)),
            }
            // The previous holder may have removed the file while it was being opened here; the lock then holds no
            // file.
            if is_still_there(&file, &path) {
                return Ok(Some(Self { path, _file: file }));
            }
        }
    }
}

impl Drop for TaskLock {
    fn drop(&mut self) {
        // Removed before the release, so that no process can lock a file that is about to be removed.
        let _ = fs::remove_file(&self.path);
    }
}

#[cfg(unix)]
fn is_still_there(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    match (file.metadata(), fs::metadata(path)) {
        (Ok(held), Ok(named)) => held.ino() == named.ino() && held.dev() == named.dev(),
        _ => false,
    }
}

#[cfg(not(unix))]
fn is_still_there(_file: &File, path: &Path) -> bool {
    path.exists()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_task_is_held_by_one_and_free_again_afterwards() {
        let folder = tempfile::tempdir().unwrap();
        let layout = Layout::create_or_check(folder.path()).unwrap();
        let plan = Digest::of(b"task");
        let held = TaskLock::try_take(&layout, &plan).unwrap();
        assert!(held.is_some());
        assert!(TaskLock::try_take(&layout, &plan).unwrap().is_none());
        assert!(TaskLock::try_take(&layout, &Digest::of(b"other")).unwrap().is_some());
        drop(held);
        assert!(TaskLock::try_take(&layout, &plan).unwrap().is_some());
        assert_eq!(fs::read_dir(folder.path().join("locks")).unwrap().count(), 0);
    }
}
