//! Predictions as JSON lines, read on all cores.

use super::json_array::{ArrayFault, bare_word, each_element};
use super::model_text;
use super::rows::{Block, Predictions, Refusal, RowProblem};
use super::waypoint::Waypoint;
use rayon::prelude::*;
use serde::Deserialize;
use std::borrow::Cow;
use std::io::Read;

/// Bytes of the file that are in memory at once, while lines are shorter.
const SEGMENT: usize = 1 << 24;
/// Approximate number of bytes that one task reads.
const PART: usize = 1 << 20;
/// Longest line that is read, bytes.
const LONGEST_LINE: usize = 1 << 24;

#[derive(Deserialize)]
struct Line<'a> {
    #[serde(borrow)]
    trajectory_id: Option<Cow<'a, str>>,
    frame: Option<f64>,
    waypoint_deltas: Option<Vec<Waypoint>>,
    #[serde(borrow)]
    text: Option<ModelOutput<'a>>,
    #[serde(borrow)]
    prediction: Option<ModelOutput<'a>>,
    boxes: Option<Vec<Option<[f64; 4]>>>,
}

/// Output of a model: text, or the object itself.
#[derive(Deserialize)]
#[serde(untagged)]
enum ModelOutput<'a> {
    Object { waypoint_deltas: Vec<Waypoint> },
    Text(#[serde(borrow)] Cow<'a, str>),
}

/// Reads all lines, a segment of the file at a time; empty lines are skipped.
pub fn read(file: &mut dyn Read) -> std::io::Result<Predictions> {
    let (mut all, mut text, mut lines) = (Predictions::default(), vec![], 0);
    loop {
        let read = (&mut *file).take(SEGMENT as u64).read_to_end(&mut text)?;
        let is_last = read < SEGMENT;
        let end = match text.iter().rposition(|byte| *byte == b'\n') {
            _ if is_last => text.len(),
            Some(newline) => newline + 1,
            None => continue,
        };
        let parts: Vec<Part> = parts(&text[..end]).par_iter().map(|part| part_of(part)).collect();
        for mut part in parts {
            part.block.begin_after(lines);
            part.problems.iter_mut().for_each(|problem| problem.line += lines);
            lines += part.lines;
            all.append(part.block);
            all.problems.append(&mut part.problems);
        }
        if is_last {
            return Ok(all);
        }
        text.drain(..end);
    }
}

/// Ranges of whole lines of about [`PART`] bytes each.
fn parts(text: &[u8]) -> Vec<&[u8]> {
    let (mut parts, mut rest) = (vec![], text);
    while !rest.is_empty() {
        let newline = rest.iter().skip(PART).position(|byte| *byte == b'\n');
        let (part, after) = rest.split_at(newline.map_or(rest.len(), |place| PART + place + 1));
        parts.push(part);
        rest = after;
    }
    parts
}

/// Rows of some lines, numbered from 1.
struct Part {
    block: Block,
    problems: Vec<RowProblem>,
    lines: u64,
}

fn part_of(text: &[u8]) -> Part {
    let mut part = Part { block: Block::default(), problems: vec![], lines: 0 };
    for line in text.split_inclusive(|byte| *byte == b'\n') {
        part.lines += 1;
        let line = line.trim_ascii();
        if !line.is_empty()
            && let Err((kind, reason)) = take_row(line, part.lines, &mut part.block)
        {
            part.problems.push(RowProblem::new(part.lines, kind, reason));
        }
    }
    part.block.shrink();
    part
}

/// Reads the rows of a JSON array.
pub fn read_array(text: &[u8]) -> Result<Predictions, ArrayFault> {
    let (mut block, mut problems) = (Block::default(), vec![]);
    each_element(text, &mut |row, range| {
        if let Err((kind, reason)) = take_row(text[range].trim_ascii(), row, &mut block) {
            problems.push(RowProblem::new(row, kind, reason));
        }
    })?;
    block.shrink();
    let mut all = Predictions::of(&[], problems);
    all.append(block);
    Ok(all)
}

fn take_row(text: &[u8], line: u64, block: &mut Block) -> Result<(), Refusal> {
    if text.len() > LONGEST_LINE {
        return Err(("too-long", format!("the line has {} bytes; at most {LONGEST_LINE} are read", text.len())));
    }
    let parsed: Line<'_> = serde_json::from_slice(text).map_err(|error| refusal(text, &error))?;
    let missing = |field: &str| ("field-missing", format!("the row has no `{field}`"));
    let trajectory_id = parsed.trajectory_id.ok_or_else(|| missing("trajectory_id"))?;
    let frame = parsed.frame.ok_or_else(|| missing("frame"))?;
    if !(frame >= 0.0 && frame.fract() == 0.0 && frame <= f64::from(u32::MAX)) {
        return Err(("frame", format!("`frame` is {frame}; it must be a whole number from 0")));
    }
    let deltas: Vec<[f64; 6]> = match (parsed.waypoint_deltas, parsed.text.or(parsed.prediction)) {
        (Some(waypoints), _) | (None, Some(ModelOutput::Object { waypoint_deltas: waypoints })) => {
            waypoints.into_iter().map(|waypoint| waypoint.0).collect()
        }
        (None, Some(ModelOutput::Text(text))) => model_text::deltas_in(&text).map_err(|why| ("model-text", why))?,
        (None, None) => return Err(missing("waypoint_deltas`, `text` or `prediction")),
    };
    let boxes = parsed.boxes.unwrap_or_default();
    block.take(line, &trajectory_id, frame as u64, &deltas, &boxes)
}

/// Kind and reason of an invalid line.
pub(super) fn refusal(text: &[u8], error: &serde_json::Error) -> Refusal {
    let words = error.to_string();
    // Every line is a separate document.
    let words = words.replace(" at line 1 column ", " at column ");
    if error.is_syntax()
        && let Some((at, name)) = bare_word(text)
    {
        return ("not-finite", format!("{name} is not finite, which JSON cannot hold: at column {}", at + 1));
    }
    if words.starts_with("number out of range") {
        return ("not-finite", format!("a number is not finite, which JSON cannot hold: {words}"));
    }
    match error.classify() {
        serde_json::error::Category::Data => ("field-type", words),
        _ => ("json", format!("not JSON: {words}")),
    }
}
