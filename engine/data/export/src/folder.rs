//! The folder that an export becomes: written beside its place and renamed when whole.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Component, Path, PathBuf};

/// Name of the file that marks an unfinished folder.
const MARK: &str = ".cosfly-unfinished";

/// A folder that is being written. Dropped before [`Self::finish`], it is removed; after a crash, it is left under a name
/// that says so and is replaced by the next export.
#[derive(Debug)]
pub struct OutFolder {
    staging: PathBuf,
    target: PathBuf,
    is_whole: bool,
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
            Err(error) => error.kind() == std::io::ErrorKind::NotFound,
        };
        if !is_free {
            return Err(Diagnostic::new("export-exists", Fault::Recipe, format!("`{shown}` exists already"))
                .hint("an export is a whole new folder; give another one with `--out`, or remove this one"));
        }
        let name = target.file_name().map(|name| name.to_string_lossy().into_owned());
        let name = name.ok_or_else(|| {
            Diagnostic::new("export-exists", Fault::Recipe, format!("`{shown}` is not the name of a new folder"))
        })?;
        let parent = target.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let refused = |error: std::io::Error| Diagnostic::io(format!("write into `{}`", parent.display()), &error);
        std::fs::create_dir_all(parent).map_err(refused)?;
        let is_inside = parent.canonicalize().map_err(refused)?.starts_with(dataset.canonicalize().map_err(refused)?);
        if is_inside {
            let message = format!("`{shown}` lies inside of the dataset");
            return Err(Diagnostic::new("export-inside", Fault::Recipe, message)
                .hint("`cosfly verify` would find files there that do not belong to it; give a folder beside it"));
        }
        let staging = parent.join(format!(".{name}.unfinished"));
        if staging.join(MARK).exists() {
            std::fs::remove_dir_all(&staging).map_err(refused)?;
        }
        std::fs::create_dir(&staging).map_err(refused)?;
        let this = Self { staging, target: target.to_owned(), is_whole: false };
        this.put(MARK, b"An export that was not finished. It can be deleted.\n")?;
        Ok(this)
    }

    /// Path of a file until the folder is whole.
    pub fn path(&self, name: &str) -> PathBuf {
        self.staging.join(name)
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
        let folder = path.parent().unwrap_or(&self.staging);
        let file = std::fs::create_dir_all(folder).and_then(|()| File::create(&path));
        file.map(|file| BufWriter::with_capacity(1 << 18, file)).map_err(|error| self.refusal(name, &error))
    }

    /// The refusal to write the file `name`.
    pub fn refusal(&self, name: &str, error: &std::io::Error) -> Box<Diagnostic> {
        Diagnostic::io(format!("write `{}`", self.target.join(name).display()), error)
    }

    /// Gives the folder its name.
    pub fn finish(mut self) -> Result<Written> {
        let refused = |error: std::io::Error| Diagnostic::io(format!("write `{}`", self.target.display()), &error);
        std::fs::remove_file(self.path(MARK)).map_err(refused)?;
        let written = size_of(&self.staging).map_err(refused)?;
        if self.target.is_dir() {
            std::fs::remove_dir(&self.target).map_err(refused)?;
        }
        std::fs::rename(&self.staging, &self.target).map_err(refused)?;
        self.is_whole = true;
        Ok(written)
    }
}

impl Drop for OutFolder {
    fn drop(&mut self) {
        if !self.is_whole {
            let _ = std::fs::remove_dir_all(&self.staging);
        }
    }
}

fn size_of(folder: &Path) -> std::io::Result<Written> {
    let mut written = Written::default();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder)? {
            let entry = entry?;
            let kind = entry.metadata()?;
            if kind.is_dir() {
                folders.push(entry.path());
            } else {
                written = Written { files: written.files + 1, bytes: written.bytes + kind.len() };
            }
        }
    }
    Ok(written)
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
        assert_eq!(std::fs::read_dir(home.path().join("new")).unwrap().count(), 1);
        let out = OutFolder::begin(&home.path().join("other"), &dataset).unwrap();
        for name in ["../dataset/x", "a/../../x", "/tmp/x"] {
            assert_eq!(out.put(name, b"").unwrap_err().code, "export-name", "{name}");
        }
    }

    #[test]
    fn what_a_crash_left_is_replaced_and_what_was_given_up_goes() {
        let home = tempfile::tempdir().unwrap();
        let (dataset, target) = (home.path().join("dataset"), home.path().join("export"));
        std::fs::create_dir(&dataset).unwrap();
        let out = OutFolder::begin(&target, &dataset).unwrap();
        out.put("half.txt", b"half").unwrap();
        std::mem::forget(out);
        let again = OutFolder::begin(&target, &dataset).unwrap();
        assert!(!again.path("half.txt").exists());
        drop(again);
        assert_eq!(std::fs::read_dir(home.path()).unwrap().count(), 1, "the dataset alone");
    }
}
