//! Flights as tables for plugin stages, and the stages' answers: Arrow streams of one record batch.
//!
//! * [`FlightColumns`]: columns of a flight, as a stream of those that a plugin declares to read.
//! * [`read_answer`], [`verdict`], [`labels`]: readers of answers, checked against what the plugin declares to return.

mod answer;
mod column;
mod offered;
#[cfg(test)]
mod tests;

pub use answer::{FilterVerdict, MOST_FILE_BYTES, MOST_FILES, MOST_ROWS, labels, read_answer, verdict};
pub use column::{ColumnKind, DeclaredColumn, Values};
pub use offered::{ColumnError, FlightColumns, SAMPLE_FRAMES, check_names};
