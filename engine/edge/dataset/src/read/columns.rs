//! Named columns of a Parquet file, row group by row group.

use arrow::array::{Array, AsArray, RecordBatch, StringArray};
use arrow::datatypes::{DataType, Float32Type, Float64Type, Int64Type};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use std::fs::File;
use std::path::Path;

/// Some rows of a file.
pub struct Rows<'a> {
    batch: RecordBatch,
    path: &'a Path,
}

/// Gives the rows of `path` to `visit`, with the columns that `wanted` asks for only.
pub fn read(path: &Path, wanted: &dyn Fn(&str) -> bool, visit: &mut dyn FnMut(&Rows<'_>) -> Result<()>) -> Result<()> {
    let file = File::open(path).map_err(|error| Diagnostic::io(format!("open `{}`", path.display()), &error))?;
    let builder =
        ParquetRecordBatchReaderBuilder::try_new(file).map_err(|error| damaged(path, "it is not Parquet", error))?;
    let fields = builder.schema().fields().iter().enumerate();
    let kept: Vec<usize> = fields.filter(|(_, field)| wanted(field.name())).map(|(at, _)| at).collect();
    let mask = ProjectionMask::roots(builder.parquet_schema(), kept);
    let reader = builder.with_projection(mask).build().map_err(|error| damaged(path, "it cannot be read", error))?;
    for batch in reader {
        let batch = batch.map_err(|error| damaged(path, "it cannot be read", error))?;
        visit(&Rows { batch, path })?;
    }
    Ok(())
}

/// A file of the dataset that is not what it should be.
pub fn damaged(path: &Path, what: &str, cause: impl std::fmt::Display) -> Box<Diagnostic> {
    Diagnostic::new("dataset-damaged", Fault::Input, format!("`{}` is damaged: {what}", path.display()))
        .because(cause)
        .hint("`cosfly verify` lists everything that is wrong with a dataset")
}

impl Rows<'_> {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.batch.num_rows()
    }

    /// Names of the columns that were read.
    pub fn names(&self) -> Vec<String> {
        self.batch.schema_ref().fields().iter().map(|field| field.name().clone()).collect()
    }

    fn column(&self, name: &str, kind: fn(&DataType) -> bool) -> Result<&dyn Array> {
        let column = self.batch.column_by_name(name).filter(|column| kind(column.data_type()));
        column.map(AsRef::as_ref).ok_or_else(|| {
            let message = format!("`{}` has no column `{name}` of the documented type", self.path.display());
            Diagnostic::new("dataset-column", Fault::Input, message)
        })
    }

    /// A text; `None` for null.
    pub fn text(&self, name: &str, row: usize) -> Result<Option<String>> {
        let column = self.column(name, |kind| *kind == DataType::Utf8)?.as_string::<i32>();
        Ok(column.is_valid(row).then(|| column.value(row).to_owned()))
    }

    /// A finite number.
    pub fn real(&self, name: &str, row: usize) -> Result<f64> {
        let column = self.column(name, |kind| *kind == DataType::Float64)?.as_primitive::<Float64Type>();
        let value = column.is_valid(row).then(|| column.value(row)).filter(|value| value.is_finite());
        value.ok_or_else(|| damaged(self.path, &format!("column `{name}` has no number in row {row}"), "null or NaN"))
    }

    /// A finite number, or `default` in a dataset from before the column was there.
    pub fn real_or(&self, name: &str, row: usize, default: f64) -> Result<f64> {
        if self.batch.column_by_name(name).is_none() { Ok(default) } else { self.real(name, row) }
    }

    /// All texts of a column, none of them null.
    pub fn texts(&self, name: &str) -> Result<&StringArray> {
        let column = self.column(name, |kind| *kind == DataType::Utf8)?.as_string::<i32>();
        let refusal = || damaged(self.path, &format!("column `{name}` has a row without a text"), "null");
        if column.null_count() == 0 { Ok(column) } else { Err(refusal()) }
    }

    /// A text that is not null.
    pub fn text_at(&self, name: &str, row: usize) -> Result<&str> {
        let column = self.column(name, |kind| *kind == DataType::Utf8)?.as_string::<i32>();
        let value = column.is_valid(row).then(|| column.value(row));
        value.ok_or_else(|| damaged(self.path, &format!("column `{name}` has no text in row {row}"), "null"))
    }

    /// A text, or `default` for null and in a dataset from before the column was there.
    pub fn text_or(&self, name: &str, row: usize, default: &str) -> Result<String> {
        let text = if self.batch.column_by_name(name).is_none() { None } else { self.text(name, row)? };
        Ok(text.unwrap_or_else(|| default.to_owned()))
    }

    /// All numbers of a column, each of them finite.
    pub fn reals(&self, name: &str) -> Result<&[f64]> {
        let column = self.column(name, |kind| *kind == DataType::Float64)?.as_primitive::<Float64Type>();
        let sound = column.null_count() == 0 && column.values().iter().all(|value| value.is_finite());
        let refusal = || damaged(self.path, &format!("column `{name}` has a row without a number"), "null or NaN");
        if sound { Ok(column.values()) } else { Err(refusal()) }
    }

    /// All whole numbers of a column.
    pub fn integers(&self, name: &str) -> Result<&[i64]> {
        let column = self.column(name, |kind| *kind == DataType::Int64)?.as_primitive::<Int64Type>();
        let refusal = || damaged(self.path, &format!("column `{name}` has a row without a number"), "null");
        if column.null_count() == 0 { Ok(column.values()) } else { Err(refusal()) }
    }

    /// All boxes of a column: four edges each, null where there is none.
    pub fn boxes(&self, name: &str) -> Result<Vec<Option<[f32; 4]>>> {
        let column = self.column(name, |kind| matches!(kind, DataType::FixedSizeList(..)))?.as_fixed_size_list();
        let edges = column.values().as_primitive_opt::<Float32Type>().filter(|_| column.value_length() == 4);
        let refusal = || damaged(self.path, &format!("column `{name}` has no boxes of four numbers"), "wrong type");
        let edges = edges.ok_or_else(refusal)?.values().as_chunks::<4>().0;
        let row = |row: usize| if column.is_null(row) { None } else { edges.get(row).copied() };
        Ok((0..column.len()).map(row).collect())
    }

    /// All counts of a column; null is none.
    pub fn counts_or_null(&self, name: &str) -> Result<Vec<Option<u32>>> {
        let column = self.column(name, |kind| *kind == DataType::Int64)?.as_primitive::<Int64Type>();
        let refusal =
            |row: usize| damaged(self.path, &format!("column `{name}` has no count in row {row}"), "negative");
        let count = |row: usize| match column.is_valid(row).then(|| u32::try_from(column.value(row))) {
            None => Ok(None),
            Some(count) => count.map(Some).map_err(|_| refusal(row)),
        };
        (0..column.len()).map(count).collect()
    }

    /// True or false.
    pub fn flag(&self, name: &str, row: usize) -> Result<bool> {
        let column = self.column(name, |kind| *kind == DataType::Boolean)?.as_boolean();
        let value = column.is_valid(row).then(|| column.value(row));
        value.ok_or_else(|| damaged(self.path, &format!("column `{name}` has no value in row {row}"), "null"))
    }

    /// A number from 0 to 2^32 - 1; `None` for null.
    pub fn count_or_null(&self, name: &str, row: usize) -> Result<Option<u32>> {
        let column = self.column(name, |kind| *kind == DataType::Int64)?;
        if column.is_null(row) { Ok(None) } else { self.count(name, row).map(Some) }
    }

    /// A number from 0 to 2^32 - 1.
    pub fn count(&self, name: &str, row: usize) -> Result<u32> {
        let column = self.column(name, |kind| *kind == DataType::Int64)?.as_primitive::<Int64Type>();
        let value = column.is_valid(row).then(|| column.value(row)).and_then(|value| u32::try_from(value).ok());
        value.ok_or_else(|| {
            damaged(self.path, &format!("column `{name}` has no count in row {row}"), "null or negative")
        })
    }

    /// The whole numbers of a list; none for null and in a dataset from before the column was there.
    pub fn integers_or_none(&self, name: &str, row: usize) -> Result<Vec<i64>> {
        if self.batch.column_by_name(name).is_none() {
            return Ok(vec![]);
        }
        let column = self.column(name, |kind| matches!(kind, DataType::List(_)))?.as_list::<i32>();
        let values = column.is_valid(row).then(|| column.value(row));
        let numbers = values.as_ref().and_then(|values| values.as_primitive_opt::<Int64Type>());
        Ok(numbers.map_or_else(Vec::new, |numbers| numbers.values().to_vec()))
    }

    /// The number or the numbers of a row, as they are; none for null and in a dataset from before the column was there.
    pub fn numbers(&self, name: &str, row: usize) -> Option<Vec<f64>> {
        let column = self.batch.column_by_name(name).filter(|column| column.is_valid(row))?;
        if let Some(list) = column.as_fixed_size_list_opt() {
            return Some(list.value(row).as_primitive_opt::<Float64Type>()?.values().to_vec());
        }
        Some(vec![column.as_primitive_opt::<Float64Type>()?.value(row)])
    }

    /// `N` numbers, each of them finite.
    pub fn vector<const N: usize>(&self, name: &str, row: usize) -> Result<[f64; N]> {
        let column = self.column(name, |kind| matches!(kind, DataType::FixedSizeList(..)))?.as_fixed_size_list();
        let values = column.is_valid(row).then(|| column.value(row));
        let numbers = values.as_ref().and_then(|values| values.as_primitive_opt::<Float64Type>());
        let numbers = numbers.and_then(|numbers| <[f64; N]>::try_from(&numbers.values()[..]).ok());
        let numbers = numbers.filter(|numbers| numbers.iter().all(|number| number.is_finite()));
        numbers.ok_or_else(|| damaged(self.path, &format!("column `{name}` has no vector in row {row}"), "wrong size"))
    }

    /// Edges of a pixel box; `None` for null.
    pub fn edges(&self, name: &str, row: usize) -> Result<Option<[f32; 4]>> {
        let column = self.column(name, |kind| matches!(kind, DataType::FixedSizeList(..)))?.as_fixed_size_list();
        if column.is_null(row) {
            return Ok(None);
        }
        let values = column.value(row);
        let numbers = values.as_primitive_opt::<Float32Type>();
        Ok(numbers.and_then(|numbers| <[f32; 4]>::try_from(&numbers.values()[..]).ok()))
    }
}
