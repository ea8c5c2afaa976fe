//! Files of predictions: JSON lines or Parquet, read row by row; problems of rows are recorded, never skipped.
//!
//! A row names the flight that the model saw, the first frame of the window, and what the model predicts:
//!
//! | field | meaning |
//! | --- | --- |
//! | `trajectory_id` | the flight |
//! | `frame` | first frame of the window |
//! | `waypoint_deltas` | a list of increments, each an array or an object of dx, dy, dz (m), dpitch, dyaw, droll (degrees); a missing dimension counts as 0 |
//! | `text` or `prediction` | instead of `waypoint_deltas`: output of a language model, see [`model_text`] |
//! | `boxes` | optional: left, top, right, bottom edge (pixels) of the target in the frame of each waypoint, or null |

pub mod detections;
mod json_lines;
pub mod model_text;
mod parquet_rows;
mod rows;
mod waypoint;

pub use rows::{Prediction, PredictionRow, Predictions, RowProblem};

use cosfly_diagnose::{Diagnostic, Result};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Reads a file of predictions: Parquet if it begins like one, otherwise JSON lines.
///
/// # Errors
/// The file cannot be read, or is Parquet without the columns. Invalid rows are no error, see
/// [`Predictions::problems`].
pub fn read(path: &Path) -> Result<Predictions> {
    let refused = |error: std::io::Error| Diagnostic::io(format!("read `{}`", path.display()), &error);
    let mut file = File::open(path).map_err(refused)?;
    let mut start = vec![];
    file.by_ref().take(4).read_to_end(&mut start).map_err(refused)?;
    if start == b"PAR1" {
        return parquet_rows::read(path, file);
    }
    json_lines::read(&mut (&start[..]).chain(file)).map_err(refused)
}

#[cfg(test)]
mod tests;
