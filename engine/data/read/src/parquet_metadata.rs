//! Metadata and rows of Parquet files. The library panics on negative places and lengths of columns: they are refused before.
//! It panics on damaged pages, too: these panics are contained.

use arrow_array::RecordBatch;
use arrow_schema::ArrowError;
use cosfly_diagnose::contained;
use parquet::arrow::arrow_reader::{
    ArrowReaderMetadata, ArrowReaderOptions, ParquetRecordBatchReader, ParquetRecordBatchReaderBuilder,
};
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::PageIndexPolicy;
use std::collections::BTreeSet;
use std::fs::File;

/// Metadata of a file.
///
/// # Errors
/// The file is not Parquet, two of its columns have one name, or its columns lie outside of it.
pub fn load(file: &File) -> Result<ArrowReaderMetadata> {
    let metadata = metadata_of(file, ArrowReaderOptions::new())?;
    let mut names = BTreeSet::new();
    if let Some(twice) = metadata.schema().fields().iter().find(|field| !names.insert(field.name())) {
        return Err(ParquetError::General(format!("two columns are called `{}`", twice.name())));
    }
    let end = i64::try_from(file.metadata()?.len()).unwrap_or(i64::MAX);
    for column in metadata.metadata().row_groups().iter().flat_map(|group| group.columns()) {
        let starts = [Some(column.data_page_offset()), column.dictionary_page_offset()];
        let is_inside = |start: i64| {
            start >= 0 && column.compressed_size() >= 0 && start.saturating_add(column.compressed_size()) <= end
        };
        let first = starts[1].or(starts[0]).unwrap_or(-1);
        if !(is_inside(first) && starts.into_iter().flatten().all(|start| (0..=end).contains(&start))) {
            return Err(ParquetError::General("a column lies outside of the file".to_owned()));
        }
    }
    Ok(metadata)
}

/// Metadata of a file, with the places of pages where it has them, so that one row can be read.
///
/// # Errors
/// Those of [`load`].
pub fn load_with_pages(file: &File) -> Result<ArrowReaderMetadata> {
    load(file)?;
    metadata_of(file, ArrowReaderOptions::new().with_offset_index_policy(PageIndexPolicy::Optional))
}

fn metadata_of(file: &File, options: ArrowReaderOptions) -> Result<ArrowReaderMetadata> {
    let damaged = || ParquetError::General("its metadata is damaged".to_owned());
    contained(|| ArrowReaderMetadata::load(file, options)).ok_or_else(damaged)?
}

/// Rows of a file up to its end or the first fault.
pub struct Batches(Option<ParquetRecordBatchReader>);

impl Batches {
    /// Rows that `reader` reads.
    pub fn of(reader: ParquetRecordBatchReader) -> Self {
        Self(Some(reader))
    }
}

impl Iterator for Batches {
    type Item = std::result::Result<RecordBatch, ArrowError>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut reader = self.0.take()?;
        let read = contained(move || {
            let batch = reader.next();
            (reader, batch)
        });
        let Some((reader, batch)) = read else {
            return Some(Err(ArrowError::ParquetError("its pages are damaged".to_owned())));
        };
        self.0 = matches!(batch, Some(Ok(_))).then_some(reader);
        batch
    }
}

/// Reader of a file.
///
/// # Errors
/// Those of [`load`].
pub fn builder(file: File) -> Result<ParquetRecordBatchReaderBuilder<File>> {
    let metadata = load(&file)?;
    Ok(ParquetRecordBatchReaderBuilder::new_with_metadata(file, metadata))
}
