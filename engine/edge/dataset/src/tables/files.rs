//! Table `files`: every file of the dataset with its size and hash.

use super::{Column, Kind, Table};

/// One file of the dataset.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct FileRecord {
    /// Path from the dataset's folder, with `/`.
    pub path: String,
    /// Size.
    pub bytes: u64,
    /// SHA-256, 64 hex digits.
    pub sha256: String,
}

/// The table.
pub fn table() -> Table<FileRecord> {
    Table {
        name: "files",
        doc: "Every file with its size and SHA-256, except for this one, `croissant.json` and `SHA256SUMS`.",
        key: &["path"],
        rows: |_| 1,
        per_frame: false,
        rows_per_group: 50_000,
        reads_previews: false,
        reads_expert: false,
        columns: vec![
            Column::new("path", Kind::Text, "path from the dataset's folder", |it, _| (&it.path).into()),
            Column::new("bytes", Kind::Integer, "size", |it, _| it.bytes.into()),
            Column::new("sha256", Kind::Text, "SHA-256, hexadecimal", |it, _| (&it.sha256).into()),
        ],
    }
}
