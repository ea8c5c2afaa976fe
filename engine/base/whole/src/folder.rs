//! [`NewFolder`]: a folder that is made beside its place and gets its name when it is whole.

use super::file::{write_file, written_draft};
use std::fs::{self, File};
use std::io::{Error, ErrorKind, Result};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Name of the file that marks an unfinished folder. Its maker holds a lock on it: an unlocked one is a leftover.
const MARK: &str = ".cosfly-unfinished";

/// Number of the next draft of this process.
static NEXT: AtomicUsize = AtomicUsize::new(0);

/// A folder in the making. Dropped before [`Self::appear`], it is removed; what a killed process left is removed by the next one
/// that makes a folder at the same place.
#[derive(Debug)]
pub struct NewFolder {
    draft: PathBuf,
    target: PathBuf,
    /// Folders around it that were made for it, the innermost first.
    around: Vec<PathBuf>,
    /// Locked while this process makes the folder.
    mark: Option<File>,
}

/// Outcome for a folder that was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Appeared {
    /// The folder is at its place.
    Here,
    /// Something else was there by then and stays; the folder is removed.
    Taken,
}

impl NewFolder {
    /// Begins the folder that will be at `target`, in the folder around it, which is made where there is none. A link to a folder
    /// is followed.
    ///
    /// # Errors
    /// Failures of the disk; [`ErrorKind::InvalidInput`] where `target` is no name of a folder.
    pub fn beside(target: &Path) -> Result<Self> {
        let target = fs::canonicalize(target).or_else(|_| std::path::absolute(target))?;
        let (Some(parent), Some(name)) = (target.parent(), target.file_name()) else {
            return Err(Error::new(ErrorKind::InvalidInput, "it is not the name of a new folder"));
        };
        let absent = parent.ancestors().take_while(|folder| fs::symlink_metadata(folder).is_err());
        let mut this = Self {
            draft: PathBuf::new(),
            around: absent.map(Path::to_owned).collect(),
            target: target.clone(),
            mark: None,
        };
        fs::create_dir_all(parent)?;
        let prefix = format!(".{}.unfinished", name.to_string_lossy());
        remove_leftovers(parent, &prefix);
        this.draft = loop {
            // No name twice: who still looks at a draft of ours finds nothing, not the next one.
            let number = NEXT.fetch_add(1, Ordering::Relaxed);
            let draft = parent.join(format!("{prefix}-{}-{number}", std::process::id()));
            match fs::create_dir(&draft) {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                made => break made.map(|()| draft)?,
            }
        };
        // Locked before it has its name: nobody sees it without its lock.
        let nameless = this.draft.join(".cosfly-lock");
        let mark = File::create_new(&nameless)?;
        // A file system without locks has no leftovers that are told from living drafts.
        if mark.lock().is_ok() {
            fs::rename(&nameless, this.draft.join(MARK))?;
        } else {
            fs::remove_file(&nameless)?;
        }
        this.mark = Some(mark);
        Ok(this)
    }

    /// Path of the folder until it is whole.
    pub fn path(&self) -> &Path {
        &self.draft
    }

    /// Number of its files, and their bytes.
    ///
    /// # Errors
    /// Failures of the disk.
    pub fn size(&self) -> Result<(u64, u64)> {
        let (mut files, mut bytes, mut folders) = (0, 0, vec![self.draft.clone()]);
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder)? {
                let entry = entry?;
                let kind = entry.metadata()?;
                if kind.is_dir() {
                    folders.push(entry.path());
                } else if entry.file_name() != MARK {
                    (files, bytes) = (files + 1, bytes + kind.len());
                }
            }
        }
        Ok((files, bytes))
    }

    /// Gives the folder its name, if nothing but an empty folder is there.
    ///
    /// # Errors
    /// Failures of the disk.
    pub fn appear(mut self) -> Result<Appeared> {
        match fs::remove_file(self.draft.join(MARK)) {
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(error),
            // Elsewhere the lock stays until the folder has its name: who opened the mark before must not take the draft for a leftover.
            _ if cfg!(windows) => self.mark = None,
            _ => {}
        }
        let renamed = fs::rename(&self.draft, &self.target).or_else(|error| {
            // Some systems do not replace an empty folder.
            fs::remove_dir(&self.target).map_err(|_| error).and_then(|()| fs::rename(&self.draft, &self.target))
        });
        match renamed {
            Ok(()) => Ok(Appeared::Here),
            Err(_) if fs::symlink_metadata(&self.target).is_ok() => Ok(Appeared::Taken),
            Err(error) => Err(error),
        }
    }
}

impl Drop for NewFolder {
    fn drop(&mut self) {
        // After `appear` there is none; the folders around it are empty where nothing appeared.
        if self.draft != Path::new("") {
            let _ = fs::remove_dir_all(&self.draft);
        }
        let _ = self.around.iter().try_for_each(fs::remove_dir);
    }
}

/// Writes files into the folder at `target`, which is made where there is none: all of them, or none where one cannot be written.
///
/// # Errors
/// Failures of the disk.
pub fn write_files(target: &Path, files: &[(String, &[u8])]) -> Result<()> {
    if !target.is_dir() {
        let new = NewFolder::beside(target)?;
        files.iter().try_for_each(|(name, bytes)| write_file(&new.path().join(name), bytes))?;
        if new.appear()? == Appeared::Here {
            return Ok(());
        }
    }
    let drafts = files.iter().map(|(name, bytes)| Ok((written_draft(&target.join(name), bytes)?, target.join(name))));
    for (draft, path) in drafts.collect::<Result<Vec<_>>>()? {
        draft.persist(path).map_err(|error| error.error)?;
    }
    Ok(())
}

/// Removes drafts of the same folder whose makers are dead.
fn remove_leftovers(parent: &Path, prefix: &str) {
    for entry in fs::read_dir(parent).into_iter().flatten().flatten() {
        if !entry.file_name().to_string_lossy().starts_with(prefix) {
            continue;
        }
        let path = entry.path().join(MARK);
        let Ok(mark) = File::open(&path) else { continue };
        // A mark that is gone by now was of a folder that has its name.
        if mark.try_lock().is_ok() && path.exists() {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("a folder").flatten();
        let mut names: Vec<String> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn of_many_makers_at_once_one_is_first_and_the_others_learn_of_it() {
        let home = tempfile::tempdir().expect("scratch");
        for round in 0..20 {
            let target = home.path().join(format!("new/deep/{round}"));
            let make = |maker: usize| {
                let folder = NewFolder::beside(&target).expect("a draft");
                for file in 0..5 {
                    fs::write(folder.path().join(file.to_string()), maker.to_string()).expect("written");
                }
                folder.appear().expect("an outcome")
            };
            let outcomes: Vec<Appeared> = std::thread::scope(|scope| {
                let makers: Vec<_> = (0..6).map(|maker| scope.spawn(move || make(maker))).collect();
                makers.into_iter().map(|maker| maker.join().expect("no panic")).collect()
            });
            assert_eq!(outcomes.iter().filter(|it| **it == Appeared::Here).count(), 1);
            let texts: Vec<String> =
                (0..5).map(|file| fs::read_to_string(target.join(file.to_string())).expect("a file")).collect();
            assert!(texts.iter().all(|text| *text == texts[0]), "one maker's files: {texts:?}");
        }
        assert_eq!(names(&home.path().join("new/deep")).len(), 20, "no draft is left");
    }

    #[test]
    fn empty_folders_are_filled_and_others_stay() {
        let home = tempfile::tempdir().expect("scratch");
        let (empty, full, file) = (home.path().join("empty"), home.path().join("full"), home.path().join("file"));
        fs::create_dir(&empty).expect("made");
        fs::create_dir_all(full.join("mine")).expect("made");
        fs::write(&file, "text").expect("written");
        let made = |target: &Path| NewFolder::beside(target).expect("a draft").appear().expect("an outcome");
        assert_eq!(
            [&empty, &full, &file].map(|target| made(target)),
            [Appeared::Here, Appeared::Taken, Appeared::Taken]
        );
        assert_eq!(names(home.path()), ["empty", "file", "full"]);
        assert_eq!(names(&full), ["mine"]);
    }

    #[test]
    fn of_files_that_cannot_all_be_written_none_is_and_no_folder_stays() {
        let home = tempfile::tempdir().expect("scratch");
        let (good, bad) = (("a".to_owned(), &b"new"[..]), ("no/such/folder".to_owned(), &b""[..]));
        let target = home.path().join("around/it/new");
        write_files(&target, &[good.clone(), bad.clone()]).expect_err("refused");
        assert_eq!(names(home.path()), [""; 0], "neither the folder nor those around it");
        write_files(&target, std::slice::from_ref(&good)).expect("written");
        fs::write(target.join("a"), "old").expect("written");
        fs::write(target.join("mine"), "").expect("written");
        write_files(&target, &[good.clone(), bad]).expect_err("refused");
        assert_eq!(
            (names(&target), fs::read_to_string(target.join("a")).expect("there")),
            (vec!["a".to_owned(), "mine".to_owned()], "old".to_owned())
        );
        write_files(&target, &[good]).expect("written");
        assert_eq!((names(&target).len(), fs::read_to_string(target.join("a")).expect("there")), (2, "new".to_owned()));
    }

    #[test]
    fn leftovers_of_the_dead_go_and_drafts_of_the_living_stay() {
        let home = tempfile::tempdir().expect("scratch");
        let target = home.path().join("new");
        let dead = home.path().join(".new.unfinished-1-0");
        fs::create_dir(&dead).expect("made");
        fs::write(dead.join(MARK), "").expect("written");
        let foreign = home.path().join(".new.unfinished-notes");
        fs::create_dir(&foreign).expect("made");
        let living = NewFolder::beside(&target).expect("a draft");
        let other = NewFolder::beside(&target).expect("a draft");
        assert!(!dead.exists() && foreign.exists() && living.path().exists());
        drop(other);
        assert_eq!(living.appear().expect("an outcome"), Appeared::Here);
        assert_eq!(names(home.path()), [".new.unfinished-notes", "new"]);
        assert!(names(&target).is_empty(), "the mark is gone");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_an_empty_folder_stays_a_link() {
        let home = tempfile::tempdir().expect("scratch");
        let disk = home.path().join("disk");
        fs::create_dir(&disk).expect("made");
        let link = home.path().join("link");
        std::os::unix::fs::symlink(&disk, &link).expect("a link");
        let folder = NewFolder::beside(&link).expect("a draft");
        fs::write(folder.path().join("file"), "text").expect("written");
        assert_eq!(folder.appear().expect("an outcome"), Appeared::Here);
        assert!(link.is_symlink() && disk.join("file").is_file());
    }
}
