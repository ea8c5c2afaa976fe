//! Writes tables as Parquet files: the same rows give the same bytes, and one row group is in memory at a time.

use super::{Cell, Column, Kind, Table};
use arrow::array::{
    ArrayRef, BinaryBuilder, BooleanBuilder, FixedSizeListBuilder, Float32Builder, Float64Builder, Int64Builder,
    ListBuilder, RecordBatch, StringBuilder, StructBuilder,
};
use arrow::datatypes::{DataType, Field, Fields, Schema};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression, ZstdLevel};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use std::collections::BTreeMap;
use std::io::Write;
use std::sync::Arc;

const ZSTD_LEVEL: i32 = 3;

/// Writes one Parquet file of one table.
pub struct TableWriter<'t, S, W: Write + Send> {
    table: &'t Table<S>,
    writer: ArrowWriter<W>,
    rows: u64,
}

impl<'t, S, W: Write + Send> TableWriter<'t, S, W> {
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
        let arrays = self.table.columns.iter().map(|column| self.array(column, record, rows)).collect::<Result<_>>()?;
        let batch = RecordBatch::try_new(Arc::new(schema(self.table)), arrays)
            .map_err(|error| write_error(self.table.name, error.into()))?;
        self.writer.write(&batch).map_err(|error| write_error(self.table.name, error))?;
        self.rows += rows as u64;
        Ok(())
    }

    /// Ends the file; gives its number of rows.
    pub fn finish(self) -> Result<u64> {
        self.writer.close().map_err(|error| write_error(self.table.name, error))?;
        Ok(self.rows)
    }

    fn array(&self, column: &Column<S>, record: &S, rows: usize) -> Result<ArrayRef> {
        let cells: Vec<Cell> = (0..rows).map(|row| (column.cell)(record, row)).collect();
        for (row, cell) in cells.iter().enumerate() {
            check_cell(column, cell).map_err(|rule| {
                let place = format!("column `{}`, row {row} of table `{}`", column.name, self.table.name);
                Diagnostic::new("table-cell", Fault::Bug, format!("{place}: {rule}"))
            })?;
        }
        Ok(build_array(column.kind, cells))
    }
}

fn check_cell<S>(column: &Column<S>, cell: &Cell) -> std::result::Result<(), String> {
    let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
    let fits = match (column.kind, cell) {
        (_, Cell::Null) => column.nullable,
        (Kind::Real, Cell::Real(value)) => value.is_finite(),
        (Kind::Reals(length), Cell::Reals(values)) => values.len() == length && finite(values),
        (Kind::RealList, Cell::Reals(values)) => finite(values),
        (Kind::FloatList, Cell::Floats(values)) => values.iter().all(|value| value.is_finite()),
        (Kind::Label(names), Cell::Integer(value)) => (0..names.len() as i64).contains(value),
        (Kind::Text, Cell::Text(_))
        | (Kind::Integer, Cell::Integer(_))
        | (Kind::Flag, Cell::Flag(_))
        | (Kind::Box, Cell::Box(_))
        | (Kind::IntegerList, Cell::Integers(_))
        | (Kind::TextList, Cell::Texts(_))
        | (Kind::Image, Cell::Image(_)) => true,
        _ => false,
    };
    if fits { Ok(()) } else { Err(format!("`{cell:?}` is not a finite value of kind {:?}", column.kind)) }
}

/// The cells, checked to be of `kind` or null, as one array.
fn build_array(kind: Kind, cells: Vec<Cell>) -> ArrayRef {
    macro_rules! simple {
        ($builder:ty, $variant:ident) => {{
            let mut builder = <$builder>::new();
            cells.into_iter().for_each(|cell| match cell {
                Cell::$variant(value) => builder.append_value(value),
                _ => builder.append_null(),
            });
            Arc::new(builder.finish())
        }};
    }
    macro_rules! list {
        ($values:expr, $variant:ident) => {{
            let mut builder = ListBuilder::new($values).with_field(item_field(kind));
            cells.into_iter().for_each(|cell| match cell {
                Cell::$variant(values) => {
                    values.into_iter().for_each(|value| builder.values().append_value(value));
                    builder.append(true);
                }
                _ => builder.append(false),
            });
            Arc::new(builder.finish())
        }};
    }
    macro_rules! fixed_list {
        ($values:expr, $length:expr, $variant:ident) => {{
            let mut builder = FixedSizeListBuilder::new($values, $length as i32).with_field(item_field(kind));
            cells.into_iter().for_each(|cell| match cell {
                Cell::$variant(values) => {
                    values.into_iter().for_each(|value| builder.values().append_value(value));
                    builder.append(true);
                }
                _ => {
                    (0..$length).for_each(|_| builder.values().append_null());
                    builder.append(false);
                }
            });
            Arc::new(builder.finish())
        }};
    }
    match kind {
        Kind::Text => simple!(StringBuilder, Text),
        Kind::Integer | Kind::Label(_) => simple!(Int64Builder, Integer),
        Kind::Real => simple!(Float64Builder, Real),
        Kind::Flag => simple!(BooleanBuilder, Flag),
        Kind::Reals(length) => fixed_list!(Float64Builder::new(), length, Reals),
        Kind::Box => fixed_list!(Float32Builder::new(), 4, Box),
        Kind::RealList => list!(Float64Builder::new(), Reals),
        Kind::FloatList => list!(Float32Builder::new(), Floats),
        Kind::IntegerList => list!(Int64Builder::new(), Integers),
        Kind::TextList => list!(StringBuilder::new(), Texts),
        Kind::Image => image_array(cells),
    }
}

/// Images as Hugging Face stores them: a struct of file bytes and an empty path.
fn image_array(cells: Vec<Cell>) -> ArrayRef {
    let mut builder =
        StructBuilder::new(image_fields(), vec![Box::new(BinaryBuilder::new()), Box::new(StringBuilder::new())]);
    for cell in cells {
        let file = match cell {
            Cell::Image(file) => Some(file),
            _ => None,
        };
        builder.append(file.is_some());
        builder.field_builder::<BinaryBuilder>(0).expect("field 0 is binary").append_option(file);
        builder.field_builder::<StringBuilder>(1).expect("field 1 is text").append_null();
    }
    Arc::new(builder.finish())
}

fn image_fields() -> Fields {
    Fields::from(vec![Field::new("bytes", DataType::Binary, true), Field::new("path", DataType::Utf8, true)])
}

fn item_field(kind: Kind) -> Arc<Field> {
    let item = match kind {
        Kind::Box | Kind::FloatList => DataType::Float32,
        Kind::IntegerList => DataType::Int64,
        Kind::TextList => DataType::Utf8,
        _ => DataType::Float64,
    };
    Arc::new(Field::new("item", item, true))
}

/// The Arrow schema of a table. Columns with a Hugging Face feature must be nullable for `datasets` to find them.
pub fn schema<S>(table: &Table<S>) -> Schema {
    let field = |column: &Column<S>| {
        let kind = match column.kind {
            Kind::Text => DataType::Utf8,
            Kind::Integer | Kind::Label(_) => DataType::Int64,
            Kind::Real => DataType::Float64,
            Kind::Flag => DataType::Boolean,
            Kind::Reals(length) => DataType::FixedSizeList(item_field(column.kind), length as i32),
            Kind::Box => DataType::FixedSizeList(item_field(column.kind), 4),
            Kind::RealList | Kind::FloatList | Kind::IntegerList | Kind::TextList => {
                DataType::List(item_field(column.kind))
            }
            Kind::Image => DataType::Struct(image_fields()),
        };
        let featured = matches!(column.kind, Kind::Label(_) | Kind::Image);
        Field::new(column.name, kind, column.nullable || featured)
    };
    let features = hugging_face_features(table).map(|json| ("huggingface".to_owned(), json));
    Schema::new(table.columns.iter().map(field).collect::<Vec<_>>())
        .with_metadata(features.into_iter().collect::<BTreeMap<_, _>>())
}

/// Everything that could vary between machines and versions is fixed here.
fn properties<S>(table: &Table<S>) -> WriterProperties {
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

/// The `huggingface` metadata of a table with labels or images.
fn hugging_face_features<S>(table: &Table<S>) -> Option<String> {
    let feature = |column: &Column<S>| match column.kind {
        Kind::Label(names) => Some(serde_json::json!({"names": names, "_type": "ClassLabel"})),
        Kind::Image => Some(serde_json::json!({"_type": "Image"})),
        _ => None,
    };
    let features: serde_json::Map<String, serde_json::Value> =
        table.columns.iter().filter_map(|column| Some((column.name.to_owned(), feature(column)?))).collect();
    if features.is_empty() {
        return None;
    }
    Some(serde_json::json!({"info": {"features": features}}).to_string())
}

/// What kept a table from being written.
pub(crate) fn write_error(table: &str, error: ParquetError) -> Box<Diagnostic> {
    if let ParquetError::External(inner) = &error
        && let Some(error) = inner.downcast_ref::<std::io::Error>()
    {
        return Diagnostic::io(format!("write table `{table}`"), error);
    }
    Diagnostic::new("table-write", Fault::Bug, format!("could not write table `{table}`")).because(error)
}
