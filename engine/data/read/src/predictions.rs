//! Files of predictions: JSON lines, a JSON array or Parquet, read row by row; problems of rows are recorded, never skipped.
//!
//! A row names the flight that the model saw, the first frame of the window, and what the model predicts:
//!
//! | field | meaning |
//! | --- | --- |
//! | `trajectory_id` | the flight |
//! | `frame` | first frame of the window |
//! | `waypoint_deltas` | a list of increments, each an array or an object of dx, dy, dz (m), dpitch, dyaw, droll (degrees); a missing dimension counts as 0 |
//! | `text` or `prediction` | instead of `waypoint_deltas`: output of a language model, text before `</think>` is dropped |
//! | `boxes` | optional: left, top, right, bottom edge (pixels) of the target in the frame of each waypoint, or null |

pub mod detections;
mod json_array;
mod json_lines;
mod model_text;
mod parquet_rows;
mod rows;
pub mod run_lengths;
mod waypoint;

pub use rows::{Prediction, PredictionRow, Predictions, RowProblem};

use cosfly_diagnose::{Diagnostic, Fault, Result};
use json_array::{ArrayFault, Places};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Reads a file of predictions: Parquet or a JSON array if it begins like one, otherwise JSON lines.
///
/// # Errors
/// The file cannot be read, is Parquet without the columns, or an array that is cut off. Invalid rows are no error, see
/// [`Predictions::problems`].
pub fn read(path: &Path) -> Result<Predictions> {
    let refused = |error: std::io::Error| Diagnostic::unread(format!("`{}`", path.display()), &error);
    let mut file = File::open(path).map_err(refused)?;
    let mut start = vec![];
    file.by_ref().take(4).read_to_end(&mut start).map_err(refused)?;
    if start == b"PAR1" {
        return parquet_rows::read(path, file);
    }
    let mut file = (&start[..]).chain(file);
    if start.trim_ascii_start().starts_with(b"[") {
        let mut text = vec![];
        file.read_to_end(&mut text).map_err(refused)?;
        return json_lines::read_array(&text).map_err(|fault| not_an_array(path, &text, &fault));
    }
    json_lines::read(&mut file).map_err(refused)
}

/// The refusal of an array as a whole.
fn not_an_array(path: &Path, text: &[u8], fault: &ArrayFault) -> Box<Diagnostic> {
    let message = format!("`{}` is not a whole JSON array", path.display());
    let (line, column) = Places::default().of(text, fault.at);
    Diagnostic::new("predictions-damaged", Fault::Input, message)
        .because(format!("line {line}, column {column}: {}", fault.what))
        .hint(
            "write the file anew, as one array; rows of several files or runs are easier to put together as JSON lines",
        )
}

#[cfg(test)]
mod tests;
