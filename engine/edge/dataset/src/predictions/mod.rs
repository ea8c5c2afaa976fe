//! Files of predictions: JSON lines or Parquet, read row by row; what is wrong with a row is kept, never skipped.
//!
//! A row names the flight that the model saw, the first frame of the window, and what the model predicts:
//!
//! | field | meaning |
//! | --- | --- |
//! | `trajectory_id` | the flight |
//! | `frame` | first frame of the window |
//! | `waypoint_deltas` | a list of increments, each an array or an object of dx, dy, dz (m), dpitch, dyaw, droll (degrees); a missing dimension counts as 0 |
//! | `text` or `prediction` | instead of `waypoint_deltas`: what a language model wrote, see [`model_text`] |
//! | `boxes` | optional: left, top, right, bottom edge (pixels) of the target in the frame of each waypoint, or null |

pub mod detections;
mod json_lines;
pub mod model_text;
mod parquet_rows;
mod waypoint;

use cosfly_diagnose::{Diagnostic, Result};
use serde::Serialize;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// A prediction that could be read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prediction {
    /// Line of the file (of Parquet: row), from 1.
    pub line: u64,
    /// The flight.
    pub trajectory_id: String,
    /// First frame of the window.
    pub frame: u64,
    /// Increments, as many as were written.
    pub deltas: Vec<[f64; 6]>,
    /// The target's box in the frames of the waypoints; empty when none was given.
    pub boxes: Vec<Option<[f64; 4]>>,
}

/// A row that cannot be scored.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RowProblem {
    /// Line of the file (of Parquet: row), from 1.
    pub line: u64,
    /// Short kebab-case name of what kind of problem it is.
    pub kind: &'static str,
    /// What is wrong, in words.
    pub reason: String,
}

impl RowProblem {
    /// A problem of line `line`.
    pub fn new(line: u64, kind: &'static str, reason: impl Into<String>) -> Self {
        Self { line, kind, reason: reason.into() }
    }
}

/// What is in a file, in its order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Predictions {
    /// Rows that could be read.
    pub rows: Vec<Prediction>,
    /// Rows that could not.
    pub problems: Vec<RowProblem>,
}

/// Reads a file of predictions: Parquet if it begins like one, otherwise JSON lines.
///
/// # Errors
/// The file cannot be read, or is Parquet without the columns. Bad rows are no error, see [`Predictions::problems`].
pub fn read(path: &Path) -> Result<Predictions> {
    let refused = |error: std::io::Error| Diagnostic::io(format!("read `{}`", path.display()), &error);
    let mut file = File::open(path).map_err(refused)?;
    let mut bytes = vec![];
    file.by_ref().take(4).read_to_end(&mut bytes).map_err(refused)?;
    if bytes == b"PAR1" {
        return parquet_rows::read(path, file);
    }
    file.read_to_end(&mut bytes).map_err(refused)?;
    Ok(json_lines::read(&bytes))
}

/// Puts a row together; `Err` is kind and reason.
fn checked(mut row: Prediction) -> std::result::Result<Prediction, (&'static str, String)> {
    for (number, delta) in row.deltas.iter().enumerate() {
        if !delta.iter().all(|value| value.is_finite()) {
            return Err(("not-finite", format!("waypoint {number} has a number that is not finite")));
        }
    }
    for (number, edges) in row.boxes.iter().flatten().enumerate() {
        if !edges.iter().all(|edge| edge.is_finite()) {
            return Err(("not-finite", format!("box {number} has a number that is not finite")));
        }
    }
    row.trajectory_id.shrink_to_fit();
    Ok(row)
}

#[cfg(test)]
mod tests;
