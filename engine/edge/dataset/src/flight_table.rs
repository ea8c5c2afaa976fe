//! A flight as an Arrow stream for stages that are plugins, and their answers read back.

use crate::flight_labels;
use arrow::array::{Array, BooleanArray, Float64Array, RecordBatch, StringArray};
use arrow::datatypes::{DataType, Field, Schema};
use arrow::ipc::reader::StreamReader;
use arrow::ipc::writer::StreamWriter;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_planner::Trajectory;
use std::panic::AssertUnwindSafe;
use std::sync::Arc;

/// Most labels of a flight.
const MAX_LABELS: usize = 64;

/// What a filter says of a flight.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Verdict {
    /// Whether it is kept.
    pub keep: bool,
    /// Why not.
    pub reason: String,
}

/// One row per frame, columns of 64-bit floats without nulls; the schema's metadata name the item.
///
/// # Errors
/// What the Arrow writer refuses; that is a bug.
pub fn encode(flight: &Trajectory, item: &str) -> Result<Vec<u8>> {
    let frames = flight.track.len();
    let mut columns: Vec<(String, Vec<f64>)> = vec![];
    let mut add = |name: &str, of: &dyn Fn(usize) -> f64| {
        columns.push((name.to_owned(), (0..frames).map(of).collect()));
    };
    let (poses, states) = (&flight.poses_in_world, &flight.track.states);
    add("time_s", &|k| k as f64 * flight.track.dt_s);
    add("drone_x", &|k| poses[k].position_in_world.x);
    add("drone_y", &|k| poses[k].position_in_world.y);
    add("drone_z", &|k| poses[k].position_in_world.z);
    add("drone_yaw", &|k| poses[k].yaw_rad);
    add("drone_pitch", &|k| poses[k].pitch_rad);
    add("target_x", &|k| states[k].feet_in_world.x);
    add("target_y", &|k| states[k].feet_in_world.y);
    add("target_z", &|k| states[k].feet_in_world.z);
    add("target_heading", &|k| states[k].heading_rad);
    add("target_speed", &|k| states[k].speed_mps);
    add("visibility", &|k| flight.visibility[k]);
    add("clearance", &|k| flight.clearance_m[k]);
    for term in flight_labels::costs(flight) {
        add(&format!("cost_{}", term.name), &|k| term.per_frame[k]);
    }
    for label in flight_labels::labels(flight) {
        add(&format!("label_{}", label.name), &|k| label.per_frame[k]);
    }
    written(columns, item).map_err(|error| {
        Diagnostic::new("flight-table", Fault::Bug, format!("could not write the flight `{item}` as a table"))
            .because(error)
    })
}

fn written(columns: Vec<(String, Vec<f64>)>, item: &str) -> Result<Vec<u8>, arrow::error::ArrowError> {
    let fields: Vec<Field> = columns.iter().map(|(name, _)| Field::new(name, DataType::Float64, false)).collect();
    let metadata = [("item".to_owned(), item.to_owned())];
    let schema = Arc::new(Schema::new(fields).with_metadata(metadata));
    let arrays = columns.into_iter().map(|(_, values)| Arc::new(Float64Array::from(values)) as Arc<dyn Array>);
    let batch = RecordBatch::try_new(Arc::clone(&schema), arrays.collect())?;
    let mut writer = StreamWriter::try_new(Vec::new(), &schema)?;
    writer.write(&batch)?;
    writer.finish()?;
    writer.into_inner()
}

/// Frames of [`sample`].
pub const SAMPLE_FRAMES: usize = 40;

/// A flight that is none, for trying stages: a straight way past a standing target that is hidden for a while.
pub fn sample() -> Vec<u8> {
    let frame = |k: usize| k as f64;
    let column =
        |name: &str, of: &dyn Fn(f64) -> f64| (name.to_owned(), (0..SAMPLE_FRAMES).map(|k| of(frame(k))).collect());
    let columns: Vec<(String, Vec<f64>)> = vec![
        column("time_s", &|k| 0.5 * k),
        column("drone_x", &|k| 20.0 - k),
        column("drone_y", &|_| 10.0),
        column("drone_z", &|_| 20.0),
        column("drone_yaw", &|_| 0.0),
        column("drone_pitch", &|_| -0.7),
        column("target_x", &|_| 0.0),
        column("target_y", &|_| 0.0),
        column("target_z", &|_| 0.0),
        column("target_heading", &|_| 0.0),
        column("target_speed", &|_| 0.0),
        column("visibility", &|k| if (20.0..25.0).contains(&k) { 0.0 } else { 1.0 }),
        column("clearance", &|_| 5.0),
        column("cost_tracking", &|k| 0.1 * k),
    ];
    written(columns, "sample").unwrap_or_default()
}

/// What a filter answered.
///
/// # Errors
/// What the answer should have been, in words.
pub fn verdict(answer: &[u8]) -> Result<Verdict, String> {
    let batch = only_batch(answer)?;
    if batch.num_rows() != 1 {
        return Err(format!("it returned {} rows; a filter returns one", batch.num_rows()));
    }
    let column = |name: &str, kind: &str| {
        let column = batch.column_by_name(name).filter(|column| column.null_count() == 0);
        column.ok_or_else(|| {
            format!("it returned no column `{name}` of {kind} without nulls; it returned {}", names(&batch))
        })
    };
    let (keep, reason) = (column("keep", "booleans")?, column("reason", "texts")?);
    let keep = keep.as_any().downcast_ref::<BooleanArray>().ok_or("its column `keep` holds no booleans")?;
    let reason = reason.as_any().downcast_ref::<StringArray>().ok_or("its column `reason` holds no texts (Utf8)")?;
    let reason: String = reason.value(0).chars().take(500).collect();
    Ok(Verdict {
        keep: keep.value(0),
        reason: if reason.is_empty() { "no reason is given".to_owned() } else { reason },
    })
}

/// The labels of a flight of `frames`, by name.
///
/// # Errors
/// What the answer should have been, in words.
pub fn labels(answer: &[u8], frames: usize) -> Result<Vec<(String, Vec<f64>)>, String> {
    let batch = only_batch(answer)?;
    if batch.num_rows() != frames {
        return Err(format!("it returned {} rows for {frames} frames", batch.num_rows()));
    }
    if !(1..=MAX_LABELS).contains(&batch.num_columns()) {
        return Err(format!("it returned {} columns; labels are 1 to {MAX_LABELS}", batch.num_columns()));
    }
    let schema = batch.schema();
    let columns = schema.fields().iter().zip(batch.columns());
    columns
        .map(|(field, column)| {
            let name = field.name();
            let is_plain = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_';
            if !(1..=60).contains(&name.len()) || !name.bytes().all(is_plain) {
                let shown: String = name.chars().take(80).collect();
                return Err(format!("it returned a label `{shown}`; names are 1 to 60 of `a-z`, `0-9` and `_`"));
            }
            let values = column.as_any().downcast_ref::<Float64Array>().filter(|values| values.null_count() == 0);
            let values = values.ok_or_else(|| format!("its label `{name}` holds no 64-bit floats without nulls"))?;
            match values.values().iter().position(|value| !value.is_finite()) {
                Some(frame) => {
                    Err(format!("its label `{name}` is {} at frame {frame}; it must be finite", values.value(frame)))
                }
                None => Ok((name.clone(), values.values().to_vec())),
            }
        })
        .collect()
}

fn names(batch: &RecordBatch) -> String {
    let schema = batch.schema();
    let shown = schema.fields().iter().take(10).map(|field| format!("`{}` ({})", field.name(), field.data_type()));
    shown.collect::<Vec<_>>().join(", ")
}

fn only_batch(answer: &[u8]) -> Result<RecordBatch, String> {
    let unreadable = |error: &dyn std::fmt::Display| format!("it returned no Arrow stream: {error}");
    // The reader is made for streams of friends; a hostile one must not end the run.
    let read = || -> Result<Vec<RecordBatch>, String> {
        let reader = StreamReader::try_new(answer, None).map_err(|error| unreadable(&error))?;
        reader.take(2).collect::<Result<_, _>>().map_err(|error| unreadable(&error))
    };
    let batches =
        std::panic::catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|_| Err(unreadable(&"it is damaged")))?;
    match <[RecordBatch; 1]>::try_from(batches) {
        Ok([batch]) => Ok(batch),
        Err(batches) if batches.is_empty() => Err("it returned an Arrow stream without a record batch".to_owned()),
        Err(_) => Err("it returned more than one record batch".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stream(columns: Vec<(&str, Arc<dyn Array>)>) -> Vec<u8> {
        let batch = RecordBatch::try_from_iter(columns).unwrap();
        let mut writer = StreamWriter::try_new(Vec::new(), &batch.schema()).unwrap();
        writer.write(&batch).unwrap();
        writer.finish().unwrap();
        writer.into_inner().unwrap()
    }

    #[test]
    fn answers_are_read_and_wrong_ones_say_what_is_wanted() {
        let keep = Arc::new(BooleanArray::from(vec![false]));
        let reason = Arc::new(StringArray::from(vec!["too low"]));
        let good = stream(vec![("keep", keep.clone()), ("reason", reason)]);
        assert_eq!(verdict(&good), Ok(Verdict { keep: false, reason: "too low".into() }));
        assert!(verdict(&stream(vec![("keep", keep)])).unwrap_err().contains("no column `reason`"));
        let label = stream(vec![("risk", Arc::new(Float64Array::from(vec![0.5, 1.0])))]);
        assert_eq!(labels(&label, 2).unwrap(), [("risk".to_owned(), vec![0.5, 1.0])]);
        assert!(labels(&label, 3).unwrap_err().contains("2 rows for 3 frames"));
        let broken = stream(vec![("risk", Arc::new(Float64Array::from(vec![0.5, f64::NAN])))]);
        assert!(labels(&broken, 2).unwrap_err().contains("NaN at frame 1"));
    }

    #[test]
    fn damaged_streams_are_refused_without_a_panic() {
        let good = stream(vec![("risk", Arc::new(Float64Array::from(vec![0.5, 1.0, 2.0])))]);
        for end in 0..good.len() {
            let _ = labels(&good[..end], 3);
        }
        for (at, _) in good.iter().enumerate() {
            for bit in [0x01, 0x80] {
                let mut damaged = good.clone();
                damaged[at] ^= bit;
                let _ = labels(&damaged, 3);
            }
        }
    }
}
