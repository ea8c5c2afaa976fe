//! Tables of plugins as Parquet: the flight, the row number where there may be several rows, then the declared columns.

use super::extra::{Extra, ExtraSource};
use crate::flight_table::{ColumnKind, DeclaredColumn, Values};
use arrow_array::{ArrayRef, BinaryArray, BooleanArray, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow_schema::ArrowError;
use arrow_schema::{DataType, Field, Schema};
use std::sync::Arc;

/// All columns; those added by the dataset first.
pub fn columns_of(source: &ExtraSource) -> Vec<DeclaredColumn> {
    let own = |name: &str, kind, doc: &str| DeclaredColumn { name: name.to_owned(), kind, doc: doc.to_owned() };
    let mut columns = vec![own("trajectory_id", ColumnKind::Text, "the flight")];
    if source.shape.has_rows() {
        columns.push(own("row", ColumnKind::Integer, "number of the row among those of the flight, from 0"));
    }
    columns.extend(source.columns.iter().cloned());
    columns
}

/// Arrow schema of the table.
pub fn schema_of(source: &ExtraSource) -> Arc<Schema> {
    let field = |column: &DeclaredColumn| {
        let kind = match column.kind {
            ColumnKind::Real => DataType::Float64,
            ColumnKind::Integer => DataType::Int64,
            ColumnKind::Boolean => DataType::Boolean,
            ColumnKind::Text => DataType::Utf8,
            ColumnKind::Bytes => DataType::Binary,
        };
        Field::new(&column.name, kind, false)
    };
    Arc::new(Schema::new(columns_of(source).iter().map(field).collect::<Vec<_>>()))
}

/// Record batch with the rows of one flight.
pub fn write_batch(trajectory_id: &str, extra: &Extra) -> Result<RecordBatch, ArrowError> {
    let rows = extra.values.first().map_or(0, Values::len);
    let mut arrays: Vec<ArrayRef> = vec![Arc::new(StringArray::from(vec![trajectory_id; rows]))];
    if extra.source.shape.has_rows() {
        arrays.push(Arc::new(Int64Array::from_iter_values(0..rows as i64)));
    }
    arrays.extend(extra.values.iter().map(|values| -> ArrayRef {
        match values {
            Values::Reals(values) => Arc::new(Float64Array::from(values.clone())),
            Values::Integers(values) => Arc::new(Int64Array::from(values.clone())),
            Values::Booleans(values) => Arc::new(BooleanArray::from(values.clone())),
            Values::Texts(values) => Arc::new(StringArray::from_iter_values(values)),
            Values::Bytes(values) => Arc::new(BinaryArray::from_iter_values(values)),
        }
    }));
    RecordBatch::try_new(schema_of(&extra.source), arrays)
}
