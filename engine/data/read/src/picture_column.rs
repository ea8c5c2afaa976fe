//! Random access to pictures in a foreign Parquet table: one row is read, and the page that holds it.

use super::damage::damaged;
use super::parquet_metadata::Batches;
use super::{parquet_metadata, plain};
use arrow_array::cast::AsArray;
use arrow_array::{Array, ArrayRef};
use cosfly_diagnose::{Diagnostic, Result};
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::{ArrowReaderMetadata, ParquetRecordBatchReaderBuilder, RowSelection, RowSelector};
use prost::bytes::Bytes;
use std::fs::File;
use std::path::{Path, PathBuf};

/// A column of pictures: structures of `bytes` and `path`, or byte strings.
pub struct PictureColumn {
    path: PathBuf,
    metadata: ArrowReaderMetadata,
    column: usize,
}

/// A picture as a row has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PictureFile {
    /// The file itself.
    Stored(Bytes),
    /// Path of the file.
    Named(String),
}

impl PictureColumn {
    /// Opens the column `name` of the table at `path`; the file is opened anew for each picture.
    ///
    /// # Errors
    /// The file cannot be opened, is not Parquet or lacks the column.
    pub fn open(path: &Path, name: &str) -> Result<Self> {
        let file = open(path)?;
        let metadata =
            parquet_metadata::load_with_pages(&file).map_err(|error| damaged(path, "it is not Parquet", error))?;
        let column = metadata.schema().index_of(name);
        let column = column.map_err(|_| damaged(path, "a column is missing", format!("`{name}`")))?;
        Ok(Self { path: path.to_owned(), metadata, column })
    }

    /// The picture in `row`.
    ///
    /// # Errors
    /// The file was changed or is damaged, or the row has no picture.
    pub fn file(&self, row: usize) -> Result<PictureFile> {
        let absent = || damaged(&self.path, "a picture is missing", format!("row {row}"));
        let (mut group, mut at) = (0, row);
        for rows in self.metadata.metadata().row_groups().iter().map(|it| usize::try_from(it.num_rows()).unwrap_or(0)) {
            if at < rows {
                break;
            }
            (group, at) = (group + 1, at - rows);
        }
        if group >= self.metadata.metadata().num_row_groups() {
            return Err(absent());
        }
        let unreadable = |error: &dyn std::fmt::Display| damaged(&self.path, "it cannot be read", error);
        let builder = ParquetRecordBatchReaderBuilder::new_with_metadata(open(&self.path)?, self.metadata.clone());
        let mask = ProjectionMask::roots(self.metadata.parquet_schema(), [self.column]);
        let selection = RowSelection::from(vec![RowSelector::skip(at), RowSelector::select(1)]);
        let builder = builder.with_row_groups(vec![group]).with_projection(mask).with_row_selection(selection);
        let reader = builder.with_batch_size(1).build().map_err(|error| unreadable(&error))?;
        let batch = Batches::of(reader).next().ok_or_else(absent)?.map_err(|error| unreadable(&error))?;
        batch.columns().first().and_then(picture).ok_or_else(absent)
    }
}

fn open(path: &Path) -> Result<File> {
    File::open(path).map_err(|error| Diagnostic::io(format!("open `{}`", path.display()), &error))
}

fn picture(column: &ArrayRef) -> Option<PictureFile> {
    let parts = column.as_struct_opt();
    let part = |name: &str| parts.map_or_else(|| Some(column), |parts| parts.column_by_name(name));
    let files = part("bytes").and_then(plain::files);
    if let Some(files) = files.filter(|files| !files.is_empty() && files.is_valid(0)) {
        return Some(PictureFile::Stored(Bytes::copy_from_slice(files.value(0))));
    }
    let names = part("path").and_then(plain::texts)?;
    (!names.is_empty() && names.is_valid(0)).then(|| PictureFile::Named(names.value(0).to_owned()))
}
