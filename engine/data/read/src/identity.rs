//! Identity of a dataset: tells the one in a folder from another one that was put there later, without reading it whole.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::sha256::sha256_of;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// File with the hash of the list of all files.
const SUMS: &str = "SHA256SUMS";
/// List of all files.
const LIST: &str = "files.parquet";
/// Longest [`SUMS`] that is read, bytes; two lines need less.
const SUMS_LIMIT: u64 = 64 << 10;
/// Bytes at the end of a table that tell it from another one: its footer with the statistics of its columns.
const FOOTER: u64 = 64 << 10;
/// Digits of a digest in messages.
const SHOWN: usize = 12;

/// The dataset that a folder held when it was opened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity {
    folder: PathBuf,
    digest: String,
}

impl Identity {
    /// Identity of the dataset that `folder` holds now: the hash of `files.parquet`, which names the hash of every file, as
    /// `SHA256SUMS` states it. Of a folder without it: a hash over the ends of its tables `trajectories`.
    pub fn of(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), digest: stated(folder).unwrap_or_else(|| of_tables(folder)) }
    }

    /// The digest, 64 hex digits.
    pub fn digest(&self) -> &str {
        &self.digest
    }

    /// Refuses to go on where the folder holds another dataset than it did. Asked *after* a file was opened, so that an open
    /// file is of the dataset that was opened.
    ///
    /// # Errors
    /// `dataset-changed`.
    pub fn check(&self) -> Result<()> {
        let now = Self::of(&self.folder);
        if now.digest == self.digest { Ok(()) } else { Err(changed(&self.folder, &self.digest, &now.digest)) }
    }
}

/// Refusal of a folder whose dataset is another one than before; both by their digests.
pub fn changed(folder: &Path, before: &str, now: &str) -> Box<Diagnostic> {
    let short = |digest: &str| digest.get(..SHOWN).unwrap_or(digest).to_owned();
    let message = format!(
        "`{}` was made anew since it was opened: it held dataset {} and now holds {}",
        folder.display(),
        short(before),
        short(now)
    );
    Diagnostic::new("dataset-changed", Fault::Input, message)
        .hint("pictures of one dataset do not belong to labels of another: open the folder again")
        .hint("to keep a dataset while a training reads it, give the next run another folder with `--out`")
}

/// The hash that [`SUMS`] states for [`LIST`].
fn stated(folder: &Path) -> Option<String> {
    let mut text = String::new();
    File::open(folder.join(SUMS)).ok()?.take(SUMS_LIMIT).read_to_string(&mut text).ok()?;
    let of_list = |line: &str| line.split_once("  ").filter(|(_, path)| *path == LIST).map(|(hash, _)| hash.to_owned());
    let is_hash = |hash: &String| hash.len() == 64 && hash.bytes().all(|byte| byte.is_ascii_hexdigit());
    text.lines().find_map(of_list).filter(is_hash)
}

/// A hash over names, sizes and ends of the tables `trajectories`; those that cannot be read count by their name.
fn of_tables(folder: &Path) -> String {
    let tables = folder.join("data").join("trajectories");
    let entries = std::fs::read_dir(&tables).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    let mut known: Vec<u8> = vec![];
    for path in paths {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let (bytes, end) = end_of(&path).unwrap_or_default();
        known.extend((name.len() as u64).to_le_bytes());
        known.extend(name.as_bytes());
        known.extend(bytes.to_le_bytes());
        known.extend(end);
    }
    sha256_of(&known)
}

/// Size and last bytes of a file.
fn end_of(path: &Path) -> std::io::Result<(u64, Vec<u8>)> {
    let mut file = File::open(path)?;
    let bytes = file.metadata()?.len();
    let mut end = vec![];
    file.seek(SeekFrom::Start(bytes.saturating_sub(FOOTER)))?;
    file.take(FOOTER).read_to_end(&mut end)?;
    Ok((bytes, end))
}
