//! Predictions as JSON lines, read on all cores.

use super::waypoint::Waypoint;
use super::{Prediction, Predictions, RowProblem, checked, model_text};
use rayon::prelude::*;
use serde::Deserialize;
use std::borrow::Cow;

/// Lines that one task reads.
const LINES_AT_ONCE: usize = 4096;
/// Length of a line, bytes; longer ones are refused unread.
const LONGEST_LINE: usize = 1 << 24;

#[derive(Deserialize)]
struct Line<'a> {
    #[serde(borrow)]
    trajectory_id: Option<Cow<'a, str>>,
    frame: Option<f64>,
    waypoint_deltas: Option<Vec<Waypoint>>,
    #[serde(borrow)]
    text: Option<Said<'a>>,
    #[serde(borrow)]
    prediction: Option<Said<'a>>,
    boxes: Option<Vec<Option<[f64; 4]>>>,
}

/// What a model wrote, or the object itself.
#[derive(Deserialize)]
#[serde(untagged)]
enum Said<'a> {
    Object { waypoint_deltas: Vec<Waypoint> },
    Text(#[serde(borrow)] Cow<'a, str>),
}

/// Reads all lines; empty ones are passed over.
pub fn read(bytes: &[u8]) -> Predictions {
    let lines: Vec<&[u8]> = bytes.split(|byte| *byte == b'\n').collect();
    let chunks: Vec<Predictions> = lines
        .par_chunks(LINES_AT_ONCE)
        .enumerate()
        .map(|(chunk, lines)| {
            let mut found = Predictions::default();
            for (line, number) in lines.iter().zip(chunk * LINES_AT_ONCE + 1..) {
                let text = line.trim_ascii();
                if text.is_empty() {
                    continue;
                }
                match row_of(text, number as u64) {
                    Ok(row) => found.rows.push(row),
                    Err((kind, reason)) => found.problems.push(RowProblem::new(number as u64, kind, reason)),
                }
            }
            found
        })
        .collect();
    let mut all = Predictions::default();
    for chunk in chunks {
        all.rows.extend(chunk.rows);
        all.problems.extend(chunk.problems);
    }
    all
}

fn row_of(text: &[u8], line: u64) -> Result<Prediction, (&'static str, String)> {
    if text.len() > LONGEST_LINE {
        return Err(("too-long", format!("the line has {} bytes; at most {LONGEST_LINE} are read", text.len())));
    }
    let parsed: Line<'_> = serde_json::from_slice(text).map_err(|error| refusal(text, &error))?;
    let missing = |field: &str| ("field-missing", format!("the row has no `{field}`"));
    let trajectory_id = parsed.trajectory_id.ok_or_else(|| missing("trajectory_id"))?.into_owned();
    let frame = parsed.frame.ok_or_else(|| missing("frame"))?;
    if !(frame >= 0.0 && frame.fract() == 0.0 && frame <= f64::from(u32::MAX)) {
        return Err(("frame", format!("`frame` is {frame}; it must be a whole number from 0")));
    }
    let deltas = match (parsed.waypoint_deltas, parsed.text.or(parsed.prediction)) {
        (Some(waypoints), _) | (None, Some(Said::Object { waypoint_deltas: waypoints })) => {
            waypoints.into_iter().map(|waypoint| waypoint.0).collect()
        }
        (None, Some(Said::Text(text))) => model_text::deltas_in(&text).map_err(|why| ("model-text", why))?,
        (None, None) => return Err(missing("waypoint_deltas`, `text` or `prediction")),
    };
    let boxes = parsed.boxes.unwrap_or_default();
    checked(Prediction { line, trajectory_id, frame: frame as u64, deltas, boxes })
}

/// Why a line is no row.
fn refusal(text: &[u8], error: &serde_json::Error) -> (&'static str, String) {
    let has = |word: &[u8]| text.windows(word.len()).any(|part| part == word);
    let words = error.to_string();
    // Every line is a document of its own.
    let words = words.replace(" at line 1 column ", " at column ");
    if error.is_syntax() && (has(b"NaN") || has(b"Infinity")) || words.starts_with("number out of range") {
        return ("not-finite", format!("a number is not finite, which JSON cannot hold: {words}"));
    }
    match error.classify() {
        serde_json::error::Category::Data => ("field-type", words),
        _ => ("json", format!("not JSON: {words}")),
    }
}
