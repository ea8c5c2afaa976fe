//! Whole columns of a table as plain values, and whole tables as Arrow streams.

use super::damage::damaged;
use super::parquet_metadata::{self, Batches};
use super::plain::{integers, reals, texts};
use arrow_array::cast::AsArray;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{Array, ArrayRef, RecordBatch, RecordBatchIterator};
use arrow_schema::{ArrowError, DataType, SchemaRef};
use cosfly_diagnose::{Diagnostic, Result};
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use std::fs::File;
use std::path::{Path, PathBuf};

/// A table as a stream of Arrow's C data interface.
pub type ArrowStream = FFI_ArrowArrayStream;

/// Values of a column; null numbers are NaN, null texts `None`.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Numbers with fractions.
    Reals(Vec<f64>),
    /// Whole numbers, class labels, and booleans as 0 and 1; a column with nulls is one of reals.
    Integers(Vec<i64>),
    /// Texts.
    Texts(Vec<Option<String>>),
    /// Byte strings, such as image files.
    Files(Vec<Option<Vec<u8>>>),
    /// Lists of numbers: all values, and the number of values up to the end of each row.
    Lists(Vec<f64>, Vec<usize>),
    /// Lists of texts.
    TextLists(Vec<Vec<String>>),
}

/// A table: files, or rows in memory.
#[derive(Clone, Debug)]
pub enum TableData {
    /// Parquet files, in the order of their rows.
    Files(Vec<PathBuf>),
    /// Rows.
    Rows(RecordBatch),
}

impl TableData {
    /// Parquet files of the table.
    pub fn files(&self) -> &[PathBuf] {
        match self {
            Self::Files(files) => files,
            Self::Rows(_) => &[],
        }
    }

    /// A table without rows, with the columns of the file at `path`.
    ///
    /// # Errors
    /// The file cannot be opened or is not Parquet.
    pub fn without_rows(path: &Path) -> Result<Self> {
        Ok(Self::Rows(RecordBatch::new_empty(SchemaRef::clone(builder(path)?.schema()))))
    }

    /// Names of the columns.
    ///
    /// # Errors
    /// A file cannot be opened or is not Parquet.
    pub fn columns(&self) -> Result<Vec<String>> {
        match self {
            Self::Files(files) => files.first().map_or(Ok(vec![]), |file| column_names(file)),
            Self::Rows(rows) => Ok(rows.schema_ref().fields().iter().map(|field| field.name().clone()).collect()),
        }
    }

    /// Number of rows.
    ///
    /// # Errors
    /// A file cannot be opened or is not Parquet.
    pub fn rows(&self) -> Result<usize> {
        match self {
            Self::Files(files) => files.iter().map(|file| row_count(file)).sum(),
            Self::Rows(rows) => Ok(rows.num_rows()),
        }
    }

    /// Values of column `name`.
    ///
    /// # Errors
    /// Those of [`column`].
    pub fn column(&self, name: &str) -> Result<Column> {
        match self {
            Self::Files(files) => column(files, name),
            Self::Rows(rows) => {
                let arrays: Vec<ArrayRef> = rows.column_by_name(name).into_iter().cloned().collect();
                plain(&arrays).ok_or_else(|| damaged(Path::new(name), "it has a type without a plain form", name))
            }
        }
    }

    /// The table as one stream.
    ///
    /// # Errors
    /// Those of [`stream`].
    pub fn stream(&self) -> Result<ArrowStream> {
        match self {
            Self::Files(files) => stream(files),
            Self::Rows(rows) => {
                let batches = RecordBatchIterator::new([Ok(rows.clone())], rows.schema());
                Ok(FFI_ArrowArrayStream::new(Box::new(batches)))
            }
        }
    }
}

/// Names of the columns of a table's file.
///
/// # Errors
/// The file cannot be opened or is not Parquet.
pub fn column_names(path: &Path) -> Result<Vec<String>> {
    let schema = builder(path)?.schema().clone();
    Ok(schema.fields().iter().map(|field| field.name().clone()).collect())
}

/// Number of rows of a table's file.
///
/// # Errors
/// The file cannot be opened or is not Parquet.
pub fn row_count(path: &Path) -> Result<usize> {
    Ok(usize::try_from(builder(path)?.metadata().file_metadata().num_rows()).unwrap_or(0))
}

/// Column `name` of files of one table, file after file.
///
/// # Errors
/// A file is not Parquet, lacks the column, or the column has a type without a plain form.
pub fn column(paths: &[PathBuf], name: &str) -> Result<Column> {
    let (mut arrays, mut empty) = (vec![], None);
    for path in paths {
        let builder = builder(path)?;
        let at = builder.schema().index_of(name);
        let at = at.map_err(|_| damaged(path, "a column is missing", format!("`{name}`")))?;
        empty.get_or_insert_with(|| arrow_array::new_empty_array(builder.schema().field(at).data_type()));
        let mask = ProjectionMask::roots(builder.parquet_schema(), [at]);
        let reader = builder.with_projection(mask).build();
        for batch in Batches::of(reader.map_err(|error| damaged(path, "it cannot be read", error))?) {
            let batch = batch.map_err(|error| damaged(path, "it cannot be read", error))?;
            arrays.extend(batch.columns().first().cloned());
        }
    }
    if arrays.is_empty() {
        // A column without rows has its type, too.
        arrays.extend(empty);
    }
    plain(&arrays).ok_or_else(|| {
        let path = paths.first().map_or(Path::new(""), PathBuf::as_path);
        damaged(path, "a column has a type without a plain form", format!("`{name}`"))
    })
}

/// Files of one table as one stream; nothing is read before it is asked for.
///
/// # Errors
/// A file is not Parquet.
pub fn stream(paths: &[PathBuf]) -> Result<ArrowStream> {
    let (mut schema, mut readers) = (None::<SchemaRef>, vec![]);
    for path in paths {
        let reader = builder(path)?.build().map_err(|error| damaged(path, "it cannot be read", error))?;
        schema.get_or_insert_with(|| arrow_array::RecordBatchReader::schema(&reader));
        readers.push(Batches::of(reader));
    }
    let schema = schema.unwrap_or_else(|| SchemaRef::new(arrow_schema::Schema::empty()));
    let known = SchemaRef::clone(&schema);
    let batches = readers.into_iter().flatten().map(move |batch: std::result::Result<RecordBatch, ArrowError>| {
        batch.and_then(|batch| batch.with_schema(SchemaRef::clone(&known)))
    });
    Ok(FFI_ArrowArrayStream::new(Box::new(RecordBatchIterator::new(batches, schema))))
}

fn builder(path: &Path) -> Result<ParquetRecordBatchReaderBuilder<File>> {
    let file = File::open(path).map_err(|error| Diagnostic::io(format!("open `{}`", path.display()), &error))?;
    parquet_metadata::builder(file).map_err(|error| damaged(path, "it is not Parquet", error))
}

/// Plain values of the arrays of one column; `None` for other types.
fn plain(arrays: &[ArrayRef]) -> Option<Column> {
    let Some(first) = arrays.first() else { return Some(Column::Reals(vec![])) };
    match first.data_type() {
        DataType::List(_) | DataType::FixedSizeList(..) => lists(arrays),
        // The hub's images: a file and its path.
        DataType::Struct(_) => {
            let files: Option<Vec<_>> =
                arrays.iter().map(|it| it.as_struct().column_by_name("bytes").cloned()).collect();
            plain(&files?)
        }
        kind if kind.is_numeric() || *kind == DataType::Boolean => {
            let of_whole = |it: &ArrayRef| integers(it).filter(|it| it.null_count() == 0 && !kind.is_floating());
            if let Some(parts) = arrays.iter().map(of_whole).collect::<Option<Vec<_>>>() {
                return Some(Column::Integers(parts.iter().flat_map(|part| part.values().iter().copied()).collect()));
            }
            let parts: Option<Vec<_>> = arrays.iter().map(reals).collect();
            Some(Column::Reals(parts?.iter().flat_map(|it| it.iter().map(|it| it.unwrap_or(f64::NAN))).collect()))
        }
        _ => match arrays.iter().map(texts).collect::<Option<Vec<_>>>() {
            Some(parts) => {
                let all = parts.iter().flat_map(|part| part.iter().map(|text| text.map(str::to_owned)));
                Some(Column::Texts(all.collect()))
            }
            None => {
                let parts = arrays.iter().map(super::plain::files).collect::<Option<Vec<_>>>()?;
                Some(Column::Files(parts.iter().flat_map(|it| it.iter().map(|it| it.map(<[u8]>::to_vec))).collect()))
            }
        },
    }
}

fn lists(arrays: &[ArrayRef]) -> Option<Column> {
    let mut rows: Vec<ArrayRef> = vec![];
    for array in arrays {
        for row in 0..array.len() {
            rows.push(match array.data_type() {
                DataType::List(_) => array.as_list::<i32>().value(row),
                _ => array.as_fixed_size_list().value(row),
            });
        }
    }
    if rows.iter().any(|row| texts(row).is_some()) {
        let all = rows.iter().map(|row| Some(texts(row)?.iter().flatten().map(str::to_owned).collect()));
        return Some(Column::TextLists(all.collect::<Option<_>>()?));
    }
    let (mut values, mut ends) = (vec![], vec![]);
    for row in &rows {
        values.extend(reals(row)?.iter().map(|value| value.unwrap_or(f64::NAN)));
        ends.push(values.len());
    }
    Some(Column::Lists(values, ends))
}
