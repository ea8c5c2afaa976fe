//! Writes tables as Parquet files: the same rows give the same bytes, and one row group is in memory at a time.

use arrow_array::RecordBatch;
use arrow_schema::SchemaRef;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_schema::tables::{AnyColumn, Table, hugging_face_features, schema};
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression, ZstdLevel};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use std::io::Write;
use std::sync::Arc;

const ZSTD_LEVEL: i32 = 3;

/// Writes one Parquet file of one table.
pub struct TableWriter<'t, S: 'static, W: Write + Send> {
    table: &'t Table<S>,
    writer: ArrowWriter<W>,
    rows: u64,
}

impl<'t, S: 'static, W: Write + Send> TableWriter<'t, S, W> {
    /// Begins a file.
    pub fn new(table: &'t Table<S>, output: W) -> Result<Self> {
        Self::with_notes(table, output, &[])
    }

    /// Begins a file with more entries in the metadata of its schema, such as those of pandas.
    pub fn with_notes(table: &'t Table<S>, output: W, notes: &[(&str, String)]) -> Result<Self> {
        let mut schema = schema(table);
        schema.metadata.extend(notes.iter().map(|(key, value)| ((*key).to_owned(), value.clone())));
        let writer = ArrowWriter::try_new(output, Arc::new(schema), Some(properties(table)))
            .map_err(|error| write_error(table.name, error))?;
        Ok(Self { table, writer, rows: 0 })
    }

    /// Appends all rows of one record.
    pub fn append(&mut self, record: &S) -> Result<()> {
        let rows = (self.table.rows)(record);
        if rows == 0 {
            return Ok(());
        }
        let array = |column: &&dyn AnyColumn<S>| {
            column.array(record, rows).map_err(|problem| {
                let (row, table) = (problem.row, self.table.name);
                let place = format!("column `{}`, row {row} of table `{table}`", column.name());
                Diagnostic::new("table-cell", Fault::Bug, format!("{place}: {}", problem.rule))
            })
        };
        let arrays = self.table.columns.iter().map(array).collect::<Result<_>>()?;
        let batch = RecordBatch::try_new(Arc::new(schema(self.table)), arrays)
            .map_err(|error| write_error(self.table.name, error.into()))?;
        self.writer.write(&batch).map_err(|error| write_error(self.table.name, error))?;
        self.rows += rows as u64;
        Ok(())
    }

    /// Name of the table.
    pub fn name(&self) -> &'static str {
        self.table.name
    }

    /// Ends the file; gives its number of rows and what it was written to.
    pub fn into_inner(self) -> Result<(u64, W)> {
        let output = self.writer.into_inner().map_err(|error| write_error(self.table.name, error))?;
        Ok((self.rows, output))
    }

    /// Ends the file; gives its number of rows.
    pub fn finish(self) -> Result<u64> {
        self.writer.close().map_err(|error| write_error(self.table.name, error))?;
        Ok(self.rows)
    }
}

/// Writes one Parquet file of columns whose names are known at run time alone.
pub struct BatchWriter<W: Write + Send> {
    name: &'static str,
    writer: ArrowWriter<W>,
}

impl<W: Write + Send> BatchWriter<W> {
    /// Begins a file of table `name`.
    pub fn new(name: &'static str, schema: SchemaRef, rows_per_group: usize, output: W) -> Result<Self> {
        let writer = ArrowWriter::try_new(output, schema, Some(writer_properties(rows_per_group, None)));
        Ok(Self { name, writer: writer.map_err(|error| write_error(name, error))? })
    }

    /// Appends rows.
    pub fn append(&mut self, rows: &RecordBatch) -> Result<()> {
        self.writer.write(rows).map_err(|error| write_error(self.name, error))
    }

    /// Ends the file.
    pub fn finish(self) -> Result<()> {
        self.writer.close().map(|_| ()).map_err(|error| write_error(self.name, error))
    }
}

/// Everything that could vary between machines and versions is fixed here.
fn properties<S: 'static>(table: &Table<S>) -> WriterProperties {
    writer_properties(table.rows_per_group, hugging_face_features(table))
}

/// See [`properties`]; `features` are what Hugging Face is to make of columns.
pub(crate) fn writer_properties(rows_per_group: usize, features: Option<String>) -> WriterProperties {
    let level = ZstdLevel::try_new(ZSTD_LEVEL).expect("level 3 exists");
    WriterProperties::builder()
        .set_created_by("cosfly".to_owned())
        .set_compression(Compression::ZSTD(level))
        .set_max_row_group_row_count(Some(rows_per_group))
        .set_statistics_enabled(EnabledStatistics::Page)
        .set_key_value_metadata(features.map(|json| vec![KeyValue::new("huggingface".into(), json)]))
        .build()
}

/// The diagnostic of a table that cannot be written.
pub(crate) fn write_error(table: &str, error: ParquetError) -> Box<Diagnostic> {
    if let ParquetError::External(inner) = &error
        && let Some(error) = inner.downcast_ref::<std::io::Error>()
    {
        return Diagnostic::io(format!("write table `{table}`"), error);
    }
    Diagnostic::new("table-write", Fault::Bug, format!("could not write table `{table}`")).because(error)
}
