//! Which prediction belongs to which window; rows that belong to none, with the reason.

use crate::settings::{InputRole, Settings};
use crate::windows::{Flights, WindowSet};
use cosfly_diagnose::counted;
use cosfly_read::predictions::{PredictionRow, Predictions, RowProblem};

/// No prediction.
const NONE: u32 = u32::MAX;

/// Predictions by window.
#[derive(Debug, Default)]
pub struct Joined {
    /// Row of each window.
    row_of_window: Vec<u32>,
    /// Windows with a prediction.
    pub predicted: usize,
    /// Rows of flights in splits that are not scored.
    pub elsewhere: u64,
    /// Rows that cannot be scored.
    pub problems: Vec<RowProblem>,
}

impl Joined {
    /// Looks up the window of every row. The first of several predictions for a window counts.
    pub fn new(given: &Predictions, flights: &Flights, windows: &WindowSet, settings: &Settings) -> Self {
        let mut joined = Self { row_of_window: vec![NONE; windows.len], ..Self::default() };
        // Neighbours are mostly of one flight.
        let mut last: Option<(&str, Option<usize>)> = None;
        for (number, row) in given.rows().enumerate() {
            let flight = match last {
                Some((id, flight)) if id == row.trajectory_id => flight,
                _ => flights.place(row.trajectory_id),
            };
            last = Some((row.trajectory_id, flight));
            match window_of(&row, flight, flights, windows, settings) {
                Ok(None) => joined.elsewhere += 1,
                Ok(Some(window)) => match joined.row_of_window[window] {
                    NONE => (joined.row_of_window[window], joined.predicted) = (number as u32, joined.predicted + 1),
                    first => {
                        let (id, frame, line) = (row.trajectory_id, row.frame, given.row(first as usize).line);
                        let reason = format!("a second prediction for frame {frame} of `{id}`; line {line} counts");
                        joined.problems.push(RowProblem::new(row.line, "duplicate", reason));
                    }
                },
                Err((kind, reason)) => joined.problems.push(RowProblem::new(row.line, kind, reason)),
            }
        }
        joined
    }

    /// The row of window number `window`.
    pub fn row(&self, window: usize) -> Option<usize> {
        self.row_of_window.get(window).filter(|row| **row != NONE).map(|row| *row as usize)
    }
}

/// The window of a row; `None` for one in a split that is not scored.
fn window_of(
    row: &PredictionRow<'_>,
    flight: Option<usize>,
    flights: &Flights,
    windows: &WindowSet,
    settings: &Settings,
) -> Result<Option<usize>, (&'static str, String)> {
    let id = row.trajectory_id;
    let Some(flight) = flight else {
        return Err(("unknown-trajectory", format!("the dataset has no trajectory `{id}`")));
    };
    if flights.role(flight) != settings.input {
        let (is, others) = match settings.input {
            InputRole::Perturbed => ("an expert's", "perturbed"),
            InputRole::Expert => ("a perturbed flight's", "the experts'"),
        };
        return Err(("not-an-input", format!("`{id}` is {is}; windows are cut from {others} flights (see `--input`)")));
    }
    let horizon = windows.shape.horizon;
    if row.deltas.len() != horizon {
        return Err(("length", format!("{}; {horizon} were expected", counted(row.deltas.len(), "waypoint"))));
    }
    if !row.boxes.is_empty() && row.boxes.len() != horizon {
        return Err(("length", format!("{}; {horizon} were expected", counted(row.boxes.len(), "box"))));
    }
    let frames = flights.rows[flight].frames;
    let start = usize::try_from(row.frame).unwrap_or(usize::MAX);
    if windows.shape.number(start, frames).is_none() {
        let last = windows.shape.count(frames).checked_sub(1).map(|last| last * windows.shape.stride);
        let reason = match last {
            None => format!("`{id}` has {frames}, too few for a window", frames = counted(frames, "frame")),
            Some(last) => format!(
                "no window of `{id}` starts at frame {}: they start every {} frames from 0 to {last}",
                row.frame, windows.shape.stride
            ),
        };
        return Err(("no-window", reason));
    }
    Ok(windows.number(flight, start, frames))
}
