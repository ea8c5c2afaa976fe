//! [`Turn`]: a lock beside a folder, so that runs with different stores that write it take turns.

use crate::locks::{is_still_there, lock_file};
use std::fs::{self, File};
use std::io::Result;
use std::path::{Path, PathBuf};

/// Lock beside a folder while it is written. The file goes with the lock; what a killed process left is taken over.
#[derive(Debug)]
pub(crate) struct Turn {
    path: PathBuf,
    _file: File,
}

impl Turn {
    /// Waits for the turn at a folder. None where the place takes no files or no locks: what is written there fails by itself.
    pub(crate) fn beside(folder: &Path) -> Option<Self> {
        let (parent, name) = (folder.parent()?, folder.file_name()?);
        let path = parent.join(format!(".{}.cosfly-turn", name.to_string_lossy()));
        fs::create_dir_all(parent).ok()?;
        loop {
            let file = locked(&path).ok()?;
            // The one before may have removed the file while it was waited for: the lock then holds no file.
            if is_still_there(&file, &path) {
                return Some(Self { path, _file: file });
            }
        }
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        // Removed before the release, so that no process can lock a file that is about to be removed.
        let _ = fs::remove_file(&self.path);
    }
}

fn locked(path: &Path) -> Result<File> {
    let file = lock_file(path)?;
    match file.lock() {
        Ok(()) => Ok(file),
        Err(error) => {
            let _ = fs::remove_file(path);
            Err(error)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU32, Ordering};

    #[test]
    fn one_at_a_time_has_the_turn_and_no_file_is_left() {
        let home = tempfile::tempdir().expect("scratch");
        let (folder, inside) = (home.path().join("new/out"), AtomicU32::new(0));
        std::thread::scope(|scope| {
            for _ in 0..6 {
                scope.spawn(|| {
                    for _ in 0..50 {
                        let turn = Turn::beside(&folder).expect("a turn");
                        assert_eq!(inside.fetch_add(1, Ordering::SeqCst), 0);
                        assert_eq!(inside.fetch_sub(1, Ordering::SeqCst), 1);
                        drop(turn);
                    }
                });
            }
        });
        assert_eq!(fs::read_dir(home.path().join("new")).expect("made").count(), 0);
    }
}
