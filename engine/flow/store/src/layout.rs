//! Where things lie in a store, and the version of that.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Version of the layout and of every record in it.
const VERSION: u32 = 1;
const FORMAT_NAME: &str = "cosfly-store";

/// The folders that hold one file per digest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Area {
    Blobs,
    Actions,
    Done,
    Plans,
    Builds,
}

impl Area {
    pub(crate) fn folder(self) -> &'static str {
        match self {
            Self::Blobs => "cas",
            Self::Actions => "ac",
            Self::Done => "done",
            Self::Plans => "plan",
            Self::Builds => "build",
        }
    }
}

/// Paths below the root of a store.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub(crate) root: PathBuf,
}

impl Layout {
    pub(crate) fn file(&self, area: Area, digest: &Digest) -> PathBuf {
        let hex = digest.to_string();
        let mut path = PathBuf::with_capacity(self.root.as_os_str().len() + 80);
        path.push(&self.root);
        path.push(area.folder());
        path.push(&hex[..2]);
        path.push(&hex);
        path
    }

    pub(crate) fn folder(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }

    /// Every digest that has a file in `area`, sorted. Foreign names are passed over.
    pub(crate) fn list(&self, area: Area) -> io::Result<Vec<Digest>> {
        let mut digests = Vec::new();
        for shard in 0..=u8::MAX {
            digests.append(&mut self.list_shard(area, shard)?);
        }
        Ok(digests)
    }

    /// Every digest in one folder of `area`, sorted.
    pub(crate) fn list_shard(&self, area: Area, shard: u8) -> io::Result<Vec<Digest>> {
        let mut digests = Vec::new();
        let folder = self.folder(area.folder()).join(format!("{shard:02x}"));
        for entry in read_dir_or_nothing(&folder)? {
            digests.extend(entry?.file_name().to_str().and_then(|name| name.parse::<Digest>().ok()));
        }
        digests.retain(|digest| digest.0[0] == shard);
        digests.sort_unstable();
        Ok(digests)
    }

    /// Makes `root` a store, or checks that it is one that this cosfly can read.
    pub(crate) fn create_or_check(root: &Path) -> Result<Self> {
        let format = root.join("format");
        match fs::read_to_string(&format) {
            Ok(text) => check_format(root, &text)?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => create(root, &format)?,
            Err(error) => return Err(Diagnostic::io(format!("read `{}`", format.display()), &error)),
        }
        for folder in ["locks", "tmp"] {
            let path = root.join(folder);
            fs::create_dir_all(&path)
                .map_err(|error| Diagnostic::io(format!("create `{}`", path.display()), &error))?;
        }
        Ok(Self { root: root.to_owned() })
    }
}

/// Entries of a folder; a folder that is absent or is no folder has none.
pub(crate) fn read_dir_or_nothing(path: &Path) -> io::Result<impl Iterator<Item = io::Result<fs::DirEntry>>> {
    match fs::read_dir(path) {
        Ok(entries) => Ok(Some(entries).into_iter().flatten()),
        Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
            Ok(None.into_iter().flatten())
        }
        Err(error) => Err(error),
    }
}

fn create(root: &Path, format: &Path) -> Result<()> {
    let failed = |error: io::Error| Diagnostic::io(format!("create the store `{}`", root.display()), &error);
    fs::create_dir_all(root).map_err(failed)?;
    for entry in fs::read_dir(root).map_err(failed)? {
        let name = entry.map_err(failed)?.file_name();
        let ours = name.to_str().is_some_and(|n| n.starts_with("format") || matches!(n, "locks" | "tmp"));
        if !ours {
            return Err(Diagnostic::new(
                "store-not-a-store",
                Fault::Input,
                format!("`{}` is not empty and holds no cosfly store", root.display()),
            )
            .hint("choose an empty or a new folder with `--store`"));
        }
    }
    // Another process may be creating the same store: both write the same bytes.
    let temporary = root.join(format!("format.{}", std::process::id()));
    fs::write(&temporary, format!("{FORMAT_NAME} {VERSION}\n")).map_err(failed)?;
    fs::rename(&temporary, format).map_err(failed)
}

fn check_format(root: &Path, text: &str) -> Result<()> {
    let found = text.trim_end();
    if found == format!("{FORMAT_NAME} {VERSION}") {
        return Ok(());
    }
    let version = found.strip_prefix(FORMAT_NAME).map_or(found, str::trim_start);
    Err(Diagnostic::new(
        "store-newer-version",
        Fault::Input,
        format!("the store `{}` has version `{version}`; this cosfly reads version `{VERSION}`", root.display()),
    )
    .hint("use the cosfly that wrote it, or choose another folder with `--store`: everything can be computed again"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_store_of_a_newer_version_is_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("format"), "cosfly-store 7\n").unwrap();
        let refusal = Layout::create_or_check(folder.path()).unwrap_err();
        assert_eq!(refusal.code, "store-newer-version");
        assert!(refusal.message.contains("`7`") && refusal.message.contains("`1`"), "{}", refusal.message);
    }

    #[test]
    fn a_folder_with_other_things_is_not_made_a_store() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("thesis.tex"), "x").unwrap();
        assert_eq!(Layout::create_or_check(folder.path()).unwrap_err().code, "store-not-a-store");
    }

    #[test]
    fn a_store_is_created_once_and_opened_again() {
        let folder = tempfile::tempdir().unwrap();
        for _ in 0..2 {
            Layout::create_or_check(&folder.path().join("deep/store")).unwrap();
        }
    }
}
