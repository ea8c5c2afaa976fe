//! Foreign Parquet tables: columns of numbers, texts and pictures, by name.

use super::damage::damaged;
use super::parquet_metadata::Batches;
use super::{parquet_metadata, plain};
use arrow_array::cast::AsArray;
use arrow_array::{Array, ArrayRef};
use arrow_schema::DataType;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_fingerprint::Digest;
use parquet::arrow::ProjectionMask;
use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;

/// Rows decoded at once: pictures may be large.
const BATCH: usize = 64;

/// Columns of the rows of a file, all of the same length.
#[derive(Clone, Debug, Default)]
pub struct ForeignRows {
    /// Numbers of each row: one, or those of its list; empty where it is null.
    pub numbers: BTreeMap<String, Vec<Vec<f64>>>,
    /// Texts; lists of texts are joined by line ends.
    pub texts: BTreeMap<String, Vec<String>>,
    /// Digests of picture files stored in the table; empty where the row only names a file.
    pub pictures: BTreeMap<String, Vec<String>>,
    /// Number of rows.
    pub rows: usize,
}

/// Reads the columns of a Parquet file that are numbers, texts or, if asked for, pictures.
///
/// # Errors
/// The file cannot be opened or read to its end.
pub fn foreign_rows(path: &Path, with_pictures: bool) -> Result<ForeignRows> {
    let file = File::open(path).map_err(|error| Diagnostic::io(format!("open `{}`", path.display()), &error))?;
    let builder = parquet_metadata::builder(file).map_err(|error| damaged(path, "it is not Parquet", error))?;
    let fields = builder.schema().fields().iter().enumerate();
    let wanted = fields.filter(|(_, field)| with_pictures || !is_of_pixels(field.data_type()));
    let mask = ProjectionMask::roots(builder.parquet_schema(), wanted.map(|(at, _)| at));
    let reader = builder.with_projection(mask).with_batch_size(BATCH).build();
    let mut all = ForeignRows::default();
    for batch in Batches::of(reader.map_err(|error| damaged(path, "it cannot be read", error))?) {
        let batch = batch.map_err(|error| damaged(path, "it cannot be read", error))?;
        for (field, column) in batch.schema_ref().fields().iter().zip(batch.columns()) {
            let name = || field.name().clone();
            if let Some(pictures) = pictures(column) {
                all.pictures.entry(name()).or_default().extend(pictures);
            } else if let Some(numbers) = numbers(column) {
                all.numbers.entry(name()).or_default().extend(numbers);
            } else if let Some(texts) = texts(column) {
                all.texts.entry(name()).or_default().extend(texts);
            }
        }
        all.rows += batch.num_rows();
    }
    Ok(all)
}

/// Whether a column holds pictures, or images as lists of rows.
fn is_of_pixels(kind: &DataType) -> bool {
    match kind {
        DataType::Struct(_) => true,
        DataType::List(item) | DataType::LargeList(item) | DataType::FixedSizeList(item, _) => {
            item.data_type().is_nested()
        }
        _ => false,
    }
}

/// Values of the lists in a column, row by row; `None` when the column has no lists.
fn lists(column: &ArrayRef) -> Option<Vec<Option<ArrayRef>>> {
    let rows = 0..column.len();
    let valid = |row: usize, value: &dyn Fn(usize) -> ArrayRef| column.is_valid(row).then(|| value(row));
    Some(match column.data_type() {
        DataType::List(_) => rows.map(|row| valid(row, &|row| column.as_list::<i32>().value(row))).collect(),
        DataType::LargeList(_) => rows.map(|row| valid(row, &|row| column.as_list::<i64>().value(row))).collect(),
        DataType::FixedSizeList(..) => {
            rows.map(|row| valid(row, &|row| column.as_fixed_size_list().value(row))).collect()
        }
        _ => return None,
    })
}

fn plain_numbers(column: &ArrayRef) -> Option<Vec<Option<f64>>> {
    Some(plain::reals(column)?.iter().collect())
}

fn numbers(column: &ArrayRef) -> Option<Vec<Vec<f64>>> {
    if let Some(values) = plain_numbers(column) {
        return Some(values.into_iter().map(|value| value.into_iter().collect()).collect());
    }
    let of_row = |row: Option<ArrayRef>| match row {
        Some(row) => Some(plain_numbers(&row)?.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect()),
        None => Some(vec![]),
    };
    lists(column)?.into_iter().map(of_row).collect()
}

fn plain_texts(column: &ArrayRef) -> Option<Vec<String>> {
    Some(plain::texts(column)?.iter().map(|text| text.unwrap_or_default().to_owned()).collect())
}

fn texts(column: &ArrayRef) -> Option<Vec<String>> {
    if let Some(texts) = plain_texts(column) {
        return Some(texts);
    }
    let of_row = |row: Option<ArrayRef>| match row {
        Some(row) => Some(plain_texts(&row)?.join("\n")),
        None => Some(String::new()),
    };
    lists(column)?.into_iter().map(of_row).collect()
}

fn pictures(column: &ArrayRef) -> Option<Vec<String>> {
    let bytes = column.as_struct_opt()?.column_by_name("bytes")?;
    Some(
        plain::files(bytes)?
            .iter()
            .map(|file| file.map_or_else(String::new, |file| Digest::of(file).to_string()))
            .collect(),
    )
}
