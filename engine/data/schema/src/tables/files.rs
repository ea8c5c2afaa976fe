//! Table `files`: every file of the dataset with its size and hash.

use super::Table;
use super::column::columns;
use serde::{Deserialize, Serialize};

/// One file of the dataset.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct FileRecord {
    /// Path from the dataset's folder, with `/`.
    pub path: String,
    /// Size of the file, bytes.
    pub bytes: u64,
    /// SHA-256, 64 hex digits.
    pub sha256: String,
}

/// Definition of the table.
pub fn table() -> Table<FileRecord> {
    let doc = "Every file with its size and SHA-256, except for this one, `croissant.json`, `SHA256SUMS`, and `.cosfly-version`, \
               by which `cosfly run` knows a folder that it may replace.";
    Table::new("files", doc, &["path"], |_: &FileRecord| 1, Files::COLUMNS)
}

/// Columns of table `files`.
pub struct Files;

columns! { Files::COLUMNS of FileRecord;
    /// Path from the dataset's folder.
    path: String = |it, _| it.path.clone();
    /// Size of the file.
    bytes: u64 ["bytes"] = |it, _| it.bytes;
    /// SHA-256 of the file, hexadecimal.
    sha256: String = |it, _| it.sha256.clone();
}
