//! Predictions in a Parquet file: the same fields as columns, lists as nested or flat lists of any float type.

use super::model_text;
use super::rows::{Block, Predictions, Refusal, RowProblem};
use super::waypoint::DIMENSIONS;
use crate::parquet_metadata::Batches;
use crate::{parquet_metadata, plain};
use arrow_array::cast::AsArray;
use arrow_array::{Array, ArrayRef, Int64Array, RecordBatch, StringArray};
use arrow_schema::DataType;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use std::fs::File;
use std::path::Path;

/// Rows read at once.
const ROWS_AT_ONCE: usize = 8192;

/// Reads all rows of `file`, which is at `path`.
pub fn read(path: &Path, file: File) -> Result<Predictions> {
    let unreadable = |error: &dyn std::fmt::Display| {
        let message = format!("`{}` cannot be read as Parquet", path.display());
        Diagnostic::new("predictions-damaged", Fault::Input, message)
            .because(error)
            .hint("write the file anew; `cosfly eval --help` has its columns")
    };
    let builder = parquet_metadata::builder(file).map_err(|e| unreadable(&e))?;
    let mut found = Predictions::default();
    let mut line = 0;
    let reader = builder.with_batch_size(ROWS_AT_ONCE).build().map_err(|e| unreadable(&e))?;
    for batch in Batches::of(reader) {
        let batch = batch.map_err(|e| unreadable(&e))?;
        let columns = Columns::of(&batch, path)?;
        let mut block = Block::default();
        for row in 0..batch.num_rows() {
            line += 1;
            if let Err((kind, reason)) = columns.take_row(row, line, &mut block) {
                found.problems.push(RowProblem::new(line, kind, reason));
            }
        }
        block.shrink();
        found.append(block);
    }
    Ok(found)
}

/// Columns of some rows, converted to common types.
struct Columns {
    trajectory_id: StringArray,
    frame: Int64Array,
    deltas: Option<ArrayRef>,
    /// Deltas, where all of them are lists of lists of numbers.
    plain: Option<PlainDeltas>,
    text: Option<StringArray>,
    boxes: Option<ArrayRef>,
}

impl Columns {
    fn of(batch: &RecordBatch, path: &Path) -> Result<Self> {
        let find = |name: &str| batch.column_by_name(name);
        let missing = |what: &str| {
            let schema = batch.schema();
            let names: Vec<&str> = schema.fields().iter().map(|field| field.name().as_str()).collect();
            let message = format!("`{}` has no column {what}", path.display());
            Diagnostic::new("predictions-column", Fault::Input, message)
                .hint(format!("its columns are {}", names.join(", ")))
        };
        let unfit = |name: &str| missing(&format!("`{name}` of a type that fits"));
        let text_of = |name: &str| find(name).filter(|column| !column.data_type().is_nested());
        let text = text_of("text").or_else(|| text_of("prediction"));
        let deltas = find("waypoint_deltas").cloned();
        if deltas.is_none() && text.is_none() {
            return Err(missing("`waypoint_deltas`, `text` or `prediction`"));
        }
        Ok(Self {
            trajectory_id: plain::texts(find("trajectory_id").ok_or_else(|| missing("`trajectory_id`"))?)
                .ok_or_else(|| unfit("trajectory_id"))?,
            frame: plain::integers(find("frame").ok_or_else(|| missing("`frame`"))?).ok_or_else(|| unfit("frame"))?,
            plain: deltas.as_ref().and_then(PlainDeltas::of),
            deltas,
            text: text.map(|column| plain::texts(column).ok_or_else(|| unfit("text"))).transpose()?,
            boxes: find("boxes").cloned(),
        })
    }

    fn take_row(&self, row: usize, line: u64, block: &mut Block) -> std::result::Result<(), Refusal> {
        let missing = |field: &str| ("field-missing", format!("the row has no `{field}`"));
        let (ids, frames) = (&self.trajectory_id, &self.frame);
        let trajectory_id = ids.is_valid(row).then(|| ids.value(row)).ok_or_else(|| missing("trajectory_id"))?;
        let frame = frames.is_valid(row).then(|| frames.value(row)).ok_or_else(|| missing("frame"))?;
        let frame = u64::try_from(frame)
            .map_err(|_| ("frame", format!("`frame` is {frame}; it must be a whole number from 0")))?;
        let given = self.deltas.as_ref().filter(|column| column.is_valid(row));
        let said = self.text.as_ref().filter(|column| column.is_valid(row));
        let deltas = match (given, &self.plain, said) {
            (Some(_), Some(plain), _) => plain.row(row)?,
            (Some(column), None, _) => waypoints(&item(column, row)?)?,
            (None, _, Some(text)) => model_text::deltas_in(text.value(row)).map_err(|why| ("model-text", why))?,
            (None, _, None) => return Err(missing("waypoint_deltas`, `text` or `prediction")),
        };
        let boxes = match self.boxes.as_ref().filter(|column| column.is_valid(row)) {
            Some(column) => boxes(&item(column, row)?)?,
            None => vec![],
        };
        block.take(line, trajectory_id, frame, &deltas, &boxes)
    }
}

/// Increments as lists of lists without nulls, unpacked once for all rows.
struct PlainDeltas {
    /// Offsets of each row's waypoints and of each waypoint's numbers, with one more for the end.
    rows: Vec<usize>,
    waypoints: Vec<usize>,
    numbers: Vec<f64>,
}

impl PlainDeltas {
    fn of(column: &ArrayRef) -> Option<Self> {
        let (rows, lists) = taken_apart(column)?;
        let (waypoints, values) = taken_apart(&lists)?;
        if values.data_type().is_nested() || values.null_count() > 0 || lists.null_count() > 0 {
            return None;
        }
        Some(Self { rows, waypoints, numbers: plain::reals(&values)?.values().to_vec() })
    }

    fn row(&self, row: usize) -> std::result::Result<Vec<[f64; 6]>, Refusal> {
        let numbers = |at: usize| &self.numbers[self.waypoints[at]..self.waypoints[at + 1]];
        (self.rows[row]..self.rows[row + 1]).map(|at| waypoint(numbers(at))).collect()
    }
}

/// Offsets of the lists, with the end of the last one, and the values of all lists.
fn taken_apart(column: &ArrayRef) -> Option<(Vec<usize>, ArrayRef)> {
    match column.data_type() {
        DataType::List(_) => {
            let lists = column.as_list::<i32>();
            Some((lists.value_offsets().iter().map(|at| *at as usize).collect(), lists.values().clone()))
        }
        DataType::LargeList(_) => {
            let lists = column.as_list::<i64>();
            Some((lists.value_offsets().iter().map(|at| *at as usize).collect(), lists.values().clone()))
        }
        DataType::FixedSizeList(_, length) => {
            let (length, lists) = (usize::try_from(*length).ok()?, column.as_fixed_size_list());
            Some(((0..=lists.len()).map(|row| row * length).collect(), lists.values().clone()))
        }
        _ => None,
    }
}

/// List in row `row`.
fn item(column: &ArrayRef, row: usize) -> std::result::Result<ArrayRef, Refusal> {
    match column.data_type() {
        DataType::List(_) => Ok(column.as_list::<i32>().value(row)),
        DataType::LargeList(_) => Ok(column.as_list::<i64>().value(row)),
        DataType::FixedSizeList(..) => Ok(column.as_fixed_size_list().value(row)),
        other => Err(("field-type", format!("a list was expected, not {other}"))),
    }
}

/// Numbers of a flat array; nulls are an error.
fn numbers(array: &ArrayRef) -> std::result::Result<Vec<f64>, Refusal> {
    let unfit = || ("field-type", format!("numbers were expected, not {}", array.data_type()));
    let values = plain::reals(array).ok_or_else(unfit)?;
    if values.null_count() > 0 {
        return Err(("field-type", "a number is null".to_owned()));
    }
    Ok(values.values().to_vec())
}

/// Increments: lists, objects, or one flat list of six numbers each.
fn waypoints(list: &ArrayRef) -> std::result::Result<Vec<[f64; 6]>, Refusal> {
    match list.data_type() {
        DataType::Struct(_) => waypoints_of_objects(list),
        kind if kind.is_nested() => (0..list.len()).map(|at| waypoint(&numbers(&item(list, at)?)?)).collect(),
        _ => {
            let flat = numbers(list)?;
            let (waypoints, rest) = flat.as_chunks::<6>();
            if rest.is_empty() {
                Ok(waypoints.to_vec())
            } else {
                Err(("length", format!("a flat list of {} numbers; six each were expected", flat.len())))
            }
        }
    }
}

fn waypoint(given: &[f64]) -> std::result::Result<[f64; 6], Refusal> {
    if given.is_empty() || given.len() > 6 {
        return Err(("field-type", format!("a waypoint has {} numbers; one to six were expected", given.len())));
    }
    let mut waypoint = [0.0; 6];
    waypoint[..given.len()].copy_from_slice(given);
    Ok(waypoint)
}

fn waypoints_of_objects(list: &ArrayRef) -> std::result::Result<Vec<[f64; 6]>, Refusal> {
    let (objects, mut waypoints) = (list.as_struct(), vec![[0.0; 6]; list.len()]);
    let mut known = false;
    for (place, name) in DIMENSIONS.iter().enumerate() {
        if let Some(column) = objects.column_by_name(name) {
            known = true;
            for (waypoint, value) in waypoints.iter_mut().zip(numbers(column)?) {
                waypoint[place] = value;
            }
        }
    }
    if known {
        Ok(waypoints)
    } else {
        Err(("field-type", "a waypoint names none of dx, dy, dz, dpitch, dyaw, droll".into()))
    }
}

fn boxes(list: &ArrayRef) -> std::result::Result<Vec<Option<[f64; 4]>>, Refusal> {
    let one = |at: usize| {
        if list.is_null(at) {
            return Ok(None);
        }
        let edges = numbers(&item(list, at)?)?;
        let count = edges.len();
        <[f64; 4]>::try_from(edges).map(Some).map_err(|_| ("field-type", format!("a box has {count} numbers, not 4")))
    };
    (0..list.len()).map(one).collect()
}
