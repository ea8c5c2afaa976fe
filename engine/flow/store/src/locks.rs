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
///
/// The lock file of a task is a second name of a file that its process keeps locked while it lives. A new file for each
/// task would have to be removed again, and file systems are slow at making files where many were removed a moment ago.
#[derive(Debug)]
pub struct TaskLock {
    path: PathBuf,
    /// File that is open while the lock is held, where it is a file of its own.
    _file: Option<File>,
}

impl TaskLock {
    /// Lock of a task; `None` while another process, or another task of this one, holds it. `owner` is a file that this
    /// process keeps locked for longer than any of its tasks.
    pub(crate) fn try_take(layout: &Layout, owner: Option<&Path>, plan: &Digest) -> Result<Option<Self>> {
        let path = layout.root.join("locks").join(format!("task-{plan}"));
        let failed = |error: &io::Error| Diagnostic::io(format!("lock `{}`", path.display()), error);
        loop {
            let linked = owner.map(|owner| fs::hard_link(owner, &path));
            let is_taken = match linked {
                Some(Ok(())) => return Ok(Some(Self { path, _file: None })),
                Some(Err(error)) => error.kind() == io::ErrorKind::AlreadyExists,
                None => false,
            };
            // Without hard links, a file of its own is locked; with them, one whose process died is removed.
            let file = if is_taken { File::open(&path) } else { lock_file(&path) };
            let file = match file {
                Err(error) if is_taken && error.kind() == io::ErrorKind::NotFound => continue,
                file => file.map_err(|error| failed(&error))?,
            };
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Ok(None),
                Err(TryLockError::Error(error)) => return Err(failed(&error)),
            }
            // The previous holder may have removed the file while it was being opened here; the lock then holds no
            // file.
            if !is_still_there(&file, &path) {
                continue;
            }
            if !is_taken {
                return Ok(Some(Self { path, _file: Some(file) }));
            }
            // Nobody else removes it while it is locked here.
            fs::remove_file(&path).map_err(|error| failed(&error))?;
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
pub(crate) fn is_still_there(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    match (file.metadata(), fs::metadata(path)) {
        (Ok(held), Ok(named)) => held.ino() == named.ino() && held.dev() == named.dev(),
        _ => false,
    }
}

#[cfg(not(unix))]
pub(crate) fn is_still_there(_file: &File, path: &Path) -> bool {
    path.exists()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file that a living process keeps locked.
    fn owner(folder: &Path, name: &str) -> (PathBuf, File) {
        let path = folder.join(name);
        let file = lock_file(&path).unwrap();
        file.lock().unwrap();
        (path, file)
    }

    #[test]
    fn a_task_is_held_by_one_and_free_again_afterwards() {
        let folder = tempfile::tempdir().unwrap();
        let layout = Layout::create_or_check(&folder.path().join("store")).unwrap();
        let (one, _one) = owner(folder.path(), "one");
        let (two, _two) = owner(folder.path(), "two");
        let (plan, other_plan) = (Digest::of(b"task"), Digest::of(b"other"));
        for (first, others) in [(None, [None, Some(&one)]), (Some(&one), [Some(&one), Some(&two)])] {
            let take =
                |owner: Option<&PathBuf>, plan: &Digest| TaskLock::try_take(&layout, owner.map(PathBuf::as_path), plan);
            let held = take(first, &plan).unwrap();
            assert!(held.is_some());
            assert!(others.iter().all(|other| take(*other, &plan).unwrap().is_none()));
            assert!(take(first, &other_plan).unwrap().is_some());
            drop(held);
            assert!(take(others[1], &plan).unwrap().is_some());
            assert_eq!(fs::read_dir(layout.root.join("locks")).unwrap().count(), 0);
        }
    }

    #[test]
    fn the_lock_of_a_dead_process_is_taken_over_by_one() {
        let folder = tempfile::tempdir().unwrap();
        let layout = Layout::create_or_check(&folder.path().join("store")).unwrap();
        let plan = Digest::of(b"task");
        let owners: Vec<(PathBuf, File)> = (0..4).map(|n| owner(folder.path(), &n.to_string())).collect();
        for round in 0..50 {
            let (dead, file) = owner(folder.path(), &format!("dead-{round}"));
            std::mem::forget(TaskLock::try_take(&layout, Some(&dead), &plan).unwrap());
            assert!(TaskLock::try_take(&layout, Some(&owners[0].0), &plan).unwrap().is_none(), "it lives");
            drop(file);
            let take = |owner: &PathBuf| TaskLock::try_take(&layout, Some(owner), &plan).unwrap();
            let taken: Vec<Option<TaskLock>> = std::thread::scope(|scope| {
                let take = &take;
                let threads: Vec<_> = owners.iter().map(|(owner, _)| scope.spawn(move || take(owner))).collect();
                threads.into_iter().map(|thread| thread.join().unwrap()).collect()
            });
            assert!(taken.iter().flatten().count() <= 1, "two hold one task");
            drop(taken);
            assert!(TaskLock::try_take(&layout, Some(&owners[0].0), &plan).unwrap().is_some());
        }
    }
}
