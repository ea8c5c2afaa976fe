//! Layout of a store, and the version of the layout.

use crate::hex::{digest_of_hex, push_digest};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Version of the layout and of every record in it.
const VERSION: u32 = 1;
const FORMAT_NAME: &str = "cosfly-store";
/// Folders of a store.
const OWN_FOLDERS: [&str; 18] = [
    "answers",
    "locks",
    "tmp",
    "cas",
    "ac",
    "done",
    "plan",
    "build",
    "runs",
    "index",
    "pins",
    "packs",
    "divergence",
    "out",
    "spare",
    "failed",
    "costs",
    "lost+found",
];

/// Folders that hold one file per digest.
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
        let mut hex = String::with_capacity(64);
        push_digest(&mut hex, digest);
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

    /// Digests that have a file in `area`, sorted. Foreign names are skipped.
    pub(crate) fn list(&self, area: Area) -> io::Result<Vec<Digest>> {
        let mut digests = Vec::new();
        for shard in 0..=u8::MAX {
            digests.append(&mut self.list_shard(area, shard)?);
        }
        Ok(digests)
    }

    /// Digests in one folder of `area`, sorted.
    pub(crate) fn list_shard(&self, area: Area, shard: u8) -> io::Result<Vec<Digest>> {
        let mut digests = Vec::new();
        let folder = self.folder(area.folder()).join(format!("{shard:02x}"));
        for entry in read_dir_or_nothing(&folder)? {
            digests.extend(entry?.file_name().to_str().and_then(digest_of_hex));
        }
        digests.retain(|digest| digest.0[0] == shard);
        digests.sort_unstable();
        Ok(digests)
    }

    /// Makes `root` a store, or checks that it is one of a supported version.
    pub(crate) fn create_or_check(root: &Path) -> Result<Self> {
        if !is_a_store(root)? {
            create(root)?;
        }
        for folder in ["locks", "tmp"] {
            let path = root.join(folder);
            fs::create_dir_all(&path)
                .map_err(|error| Diagnostic::io(format!("create `{}`", path.display()), &error))?;
        }
        Ok(Self { root: root.to_owned() })
    }

    /// Like [`Self::create_or_check`] for an existing store, without writing; `None` where there is none.
    pub(crate) fn check(root: &Path) -> Result<Option<Self>> {
        Ok(is_a_store(root)?.then(|| Self { root: root.to_owned() }))
    }
}

/// Whether `root` is a store of this version (false where it has no format file); an error where it is anything else.
fn is_a_store(root: &Path) -> Result<bool> {
    if root.as_os_str().is_empty() {
        return Err(not_a_store("the path of the store is empty"));
    }
    if fs::metadata(root).is_ok_and(|metadata| !metadata.is_dir()) {
        return Err(not_a_store(format!("`{}` is a file, and a store is a folder", root.display())));
    }
    let format = root.join("format");
    match fs::read(&format) {
        Ok(bytes) => check_format(root, &String::from_utf8_lossy(&bytes)).map(|()| true),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) if error.kind() == io::ErrorKind::IsADirectory => Err(damaged_format(root, "is a folder")),
        Err(error) => Err(Diagnostic::io(format!("read `{}`", format.display()), &error)),
    }
}

fn not_a_store(message: impl Into<String>) -> Box<Diagnostic> {
    Diagnostic::new("store-not-a-store", Fault::Input, message).hint("choose an empty or a new folder with `--store`")
}

/// Entries of a folder; none where it is absent or not a folder.
pub(crate) fn read_dir_or_nothing(path: &Path) -> io::Result<impl Iterator<Item = io::Result<fs::DirEntry>>> {
    match fs::read_dir(path) {
        Ok(entries) => Ok(Some(entries).into_iter().flatten()),
        Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
            Ok(None.into_iter().flatten())
        }
        Err(error) => Err(error),
    }
}

/// Makes `root` a store. The format file is written first and in one step: a store with any content has one.
fn create(root: &Path) -> Result<()> {
    let failed = |error: io::Error| Diagnostic::io(format!("create the store `{}`", root.display()), &error);
    fs::create_dir_all(root).map_err(failed)?;
    // Between the check of the format and the listing of the folder, another process may have made it a store.
    if !could_be_a_store(root).map_err(failed)? && !is_a_store(root)? {
        return Err(not_a_store(format!("`{}` is not empty and holds no cosfly store", root.display())));
    }
    // Another process may be creating the same store: both write the same bytes.
    let temporary = root.join(format!("format.{}-{:?}", std::process::id(), std::thread::current().id()));
    fs::write(&temporary, format!("{FORMAT_NAME} {VERSION}\n")).map_err(failed)?;
    fs::rename(&temporary, root.join("format")).map_err(failed)
}

/// Whether a folder without a format file is empty, or a store that lost only its format file.
fn could_be_a_store(root: &Path) -> io::Result<bool> {
    let (mut folders, mut has_locks) = (0, false);
    for entry in fs::read_dir(root)? {
        let entry = entry?;
        let name = entry.file_name();
        let Some(name) = name.to_str() else { return Ok(false) };
        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        match name {
            _ if is_folder && OWN_FOLDERS.contains(&name) => {
                folders += usize::from(name != "lost+found");
                has_locks |= name == "locks";
            }
            _ if !is_folder && name.starts_with("format") => {}
            _ => return Ok(false),
        }
    }
    // A store always has locks; a folder with only a `build` or a `tmp` belongs to another program.
    Ok(folders == 0 || has_locks)
}

fn check_format(root: &Path, text: &str) -> Result<()> {
    let found = text.trim_end();
    if found == format!("{FORMAT_NAME} {VERSION}") {
        return Ok(());
    }
    let version = found.strip_prefix(FORMAT_NAME).and_then(|rest| rest.strip_prefix(' ')).unwrap_or_default();
    let is_number = !version.is_empty() && version.bytes().all(|byte| byte.is_ascii_digit());
    if !is_number || version.bytes().all(|byte| byte == b'0') {
        let start: String = found.chars().take(40).collect();
        return Err(if start.is_empty() {
            damaged_format(root, "is empty")
        } else {
            damaged_format(root, &format!("holds `{}`", start.escape_debug()))
        });
    }
    Err(Diagnostic::new(
        "store-newer-version",
        Fault::Input,
        format!("the store `{}` has version `{version}`; this cosfly reads version `{VERSION}`", root.display()),
    )
    .hint("use the cosfly that wrote it, or choose another folder with `--store`: everything can be computed again"))
}

fn damaged_format(root: &Path, what: &str) -> Box<Diagnostic> {
    let format = root.join("format");
    Diagnostic::new(
        "store-damaged-format",
        Fault::Input,
        format!("`{}` {what} instead of the version of a store", format.display()),
    )
    .hint(format!(
        "if this is a cosfly store, write `{FORMAT_NAME} {VERSION}` into it, or remove the folder: everything can be computed again"
    ))
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

    #[test]
    fn a_format_that_is_empty_or_garbage_is_called_damaged_and_not_newer() {
        let folder = tempfile::tempdir().unwrap();
        let format = folder.path().join("format");
        for (bytes, code) in [
            (&b""[..], "store-damaged-format"),
            (b"garbage", "store-damaged-format"),
            (b"cosfly-store 0\n", "store-damaged-format"),
            (b"cosfly-store -1", "store-damaged-format"),
            (b"cosfly-store\xff", "store-damaged-format"),
            (b"cosfly-store 99999999999999999999", "store-newer-version"),
        ] {
            fs::write(&format, bytes).unwrap();
            assert_eq!(Layout::create_or_check(folder.path()).unwrap_err().code, code, "{bytes:?}");
        }
        fs::remove_file(&format).unwrap();
        fs::create_dir(&format).unwrap();
        assert_eq!(Layout::create_or_check(folder.path()).unwrap_err().code, "store-damaged-format");
    }

    #[test]
    fn a_file_is_not_a_store() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("recipe.toml");
        fs::write(&file, "x").unwrap();
        let refusal = Layout::create_or_check(&file).unwrap_err();
        assert_eq!(refusal.code, "store-not-a-store");
        assert!(refusal.message.contains("is a file") && !refusal.hints.is_empty());
        assert_eq!(Layout::create_or_check(Path::new("")).unwrap_err().code, "store-not-a-store");
    }

    #[test]
    fn a_store_that_lost_its_format_gets_it_back_and_a_folder_of_somebody_else_does_not() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["build", "tmp"] {
            fs::create_dir(folder.path().join(name)).unwrap();
        }
        assert_eq!(Layout::create_or_check(folder.path()).unwrap_err().code, "store-not-a-store");
        for name in ["locks", "cas", "ac", "done"] {
            fs::create_dir(folder.path().join(name)).unwrap();
        }
        Layout::create_or_check(folder.path()).unwrap();
        assert!(folder.path().join("format").is_file());
    }

    #[test]
    fn threads_that_create_one_store_together_all_succeed() {
        let folder = tempfile::tempdir().unwrap();
        for round in 0..50 {
            let root = folder.path().join(round.to_string());
            std::thread::scope(|scope| {
                for _ in 0..4 {
                    scope.spawn(|| {
                        let layout = Layout::create_or_check(&root).unwrap();
                        fs::create_dir_all(layout.folder("cas")).unwrap();
                    });
                }
            });
        }
    }
}
