//! The folder that an export becomes: written beside its place and renamed when whole.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_whole::{Appeared, NewFolder};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Component, Path, PathBuf};

/// A folder that is being written. Dropped before [`Self::finish`], it is removed; after a crash, it is left under a name
/// that says so and is replaced by the next export.
#[derive(Debug)]
pub struct OutFolder {
    draft: NewFolder,
    target: PathBuf,
}

/// Size of an export.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Written {
    /// Number of files.
    pub files: u64,
    /// Size of the files, bytes.
    pub bytes: u64,
}

impl OutFolder {
    /// Begins the folder that will be `target`, for an export of the dataset in `dataset`.
    ///
    /// # Errors
    /// `export-exists` where the folder exists already, `export-inside` within the dataset itself.
    pub fn begin(target: &Path, dataset: &Path) -> Result<Self> {
        let shown = target.display();
        let is_free = match std::fs::read_dir(target) {
            Ok(mut entries) => entries.next().is_none(),
            Err(_) => std::fs::symlink_metadata(target).is_err(),
        };
        // Not made for nothing; whether the place is free in the end, the folder's appearance says.
        if !is_free {
            return Err(exists(target));
        }
        if target.file_name().is_none() {
            let message = format!("`{shown}` is not the name of a new folder");
            return Err(Diagnostic::new("export-exists", Fault::Recipe, message));
        }
        let refused = |error: std::io::Error| Diagnostic::io(format!("write `{shown}`"), &error);
        let place = std::path::absolute(target).map_err(refused)?;
        let around = place.ancestors().skip(1).find(|folder| folder.is_dir()).unwrap_or(&place);
        let is_inside = around.canonicalize().map_err(refused)?.starts_with(dataset.canonicalize().map_err(refused)?);
        if is_inside {
            let message = format!("`{shown}` lies inside of the dataset");
            return Err(Diagnostic::new("export-inside", Fault::Recipe, message)
                .hint("`cosfly verify` would find files there that do not belong to it; give a folder beside it"));
        }
        Ok(Self { draft: NewFolder::beside(target).map_err(refused)?, target: target.to_owned() })
    }

    /// Path of a file until the folder is whole.
    pub fn path(&self, name: &str) -> PathBuf {
        self.draft.path().join(name)
    }

    /// Writes a file, and the folders that it is in.
    pub fn put(&self, name: &str, bytes: &[u8]) -> Result<()> {
        let mut file = self.create(name)?;
        file.write_all(bytes).and_then(|()| file.flush()).map_err(|error| self.refusal(name, &error))
    }

    /// Begins a file, and the folders that it is in.
    ///
    /// # Errors
    /// `export-name` for a name that leads out of the folder: ids come from the dataset, which may be of anybody.
    pub fn create(&self, name: &str) -> Result<BufWriter<File>> {
        if !Path::new(name).components().all(|part| matches!(part, Component::Normal(_))) {
            let message = format!("`{name}` is no name of a file inside of an export");
            return Err(Diagnostic::new("export-name", Fault::Input, message)
                .hint("it is made of ids of the dataset; `cosfly verify` says what else is wrong with them"));
        }
        let path = self.path(name);
        let folder = path.parent().unwrap_or(self.draft.path());
        let file = std::fs::create_dir_all(folder).and_then(|()| File::create(&path));
        file.map(|file| BufWriter::with_capacity(1 << 18, file)).map_err(|error| self.refusal(name, &error))
    }

    /// The refusal to write the file `name`.
    pub fn refusal(&self, name: &str, error: &std::io::Error) -> Box<Diagnostic> {
        Diagnostic::io(format!("write `{}`", self.target.join(name).display()), error)
    }

    /// Gives the folder its name.
    ///
    /// # Errors
    /// `export-exists` where another process was first.
    pub fn finish(self) -> Result<Written> {
        let Self { draft, target } = self;
        let refused = |error: std::io::Error| Diagnostic::io(format!("write `{}`", target.display()), &error);
        let (files, bytes) = draft.size().map_err(refused)?;
        match draft.appear().map_err(refused)? {
            Appeared::Here => Ok(Written { files, bytes }),
            Appeared::Taken => Err(exists(&target)),
        }
    }
}

fn exists(target: &Path) -> Box<Diagnostic> {
    Diagnostic::new("export-exists", Fault::Recipe, format!("`{}` exists already", target.display()))
        .hint("an export is a whole new folder; give another one with `--out`, or remove this one")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_appears_when_it_is_whole_and_not_before() {
        let home = tempfile::tempdir().unwrap();
        let (dataset, target) = (home.path().join("dataset"), home.path().join("new/export"));
        std::fs::create_dir(&dataset).unwrap();
        let out = OutFolder::begin(&target, &dataset).unwrap();
        out.put("a/b.txt", b"four").unwrap();
        assert!(!target.exists());
        assert_eq!(out.finish().unwrap(), Written { files: 1, bytes: 4 });
        assert_eq!(std::fs::read(target.join("a/b.txt")).unwrap(), b"four");
        assert_eq!(OutFolder::begin(&target, &dataset).unwrap_err().code, "export-exists");
        assert_eq!(OutFolder::begin(&dataset.join("x"), &dataset).unwrap_err().code, "export-inside");
        assert_eq!(
            OutFolder::begin(&target.join("a/b.txt/x"), &dataset).unwrap_err().code,
            "machine-io",
            "below a file"
        );
        assert_eq!(std::fs::read_dir(home.path().join("new")).unwrap().count(), 1);
        let out = OutFolder::begin(&home.path().join("other"), &dataset).unwrap();
        for name in ["../dataset/x", "a/../../x", "/tmp/x"] {
            assert_eq!(out.put(name, b"").unwrap_err().code, "export-name", "{name}");
        }
    }

    #[test]
    fn what_was_given_up_goes_and_a_place_that_was_taken_meanwhile_stays() {
        let home = tempfile::tempdir().unwrap();
        let (dataset, target) = (home.path().join("dataset"), home.path().join("export"));
        std::fs::create_dir(&dataset).unwrap();
        let out = OutFolder::begin(&target, &dataset).unwrap();
        out.put("half.txt", b"half").unwrap();
        drop(out);
        assert_eq!(std::fs::read_dir(home.path()).unwrap().count(), 1, "the dataset alone");
        let (one, other) = (OutFolder::begin(&target, &dataset).unwrap(), OutFolder::begin(&target, &dataset).unwrap());
        one.put("whose.txt", b"one").unwrap();
        other.put("whose.txt", b"other").unwrap();
        one.finish().unwrap();
        assert_eq!(other.finish().unwrap_err().code, "export-exists");
        assert_eq!(std::fs::read(target.join("whose.txt")).unwrap(), b"one");
        assert_eq!(std::fs::read_dir(home.path()).unwrap().count(), 2, "the dataset and the export");
    }
}
