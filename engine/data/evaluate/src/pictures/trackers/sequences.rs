//! Sequences of pictures that a tracker saw: those of an export's list, or of all flights.

use crate::pictures::settings::{PictureKind, PictureSettings};
use crate::windows::Flights;
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use serde::Deserialize;
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::Path;

/// A sequence of pictures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrackedSequence {
    /// Name, which is that of the tracker's file.
    pub name: String,
    /// Place of the flight.
    pub flight: usize,
    /// Frame of the first picture.
    pub first: usize,
    /// Frames from one picture to the next.
    pub every: usize,
    /// Number of pictures.
    pub pictures: usize,
}

/// A line of `sequences.jsonl`.
#[derive(Deserialize)]
struct Line {
    sequence: String,
    trajectory_id: String,
    first_frame: usize,
    every: usize,
    pictures: usize,
}

impl TrackedSequence {
    /// Frames of the pictures.
    pub fn frames(&self) -> impl Iterator<Item = usize> {
        (0..self.pictures).map(|picture| self.first + picture * self.every)
    }

    /// Number of the picture of a frame, from 0.
    pub fn picture(&self, frame: usize) -> Option<usize> {
        let after = frame.checked_sub(self.first)?;
        (after % self.every == 0 && after / self.every < self.pictures).then(|| after / self.every)
    }
}

/// The sequences that a tracker may have seen.
///
/// # Errors
/// A list that is damaged or of another dataset, and damage of the dataset.
pub fn sequences(flights: &Flights, settings: &PictureSettings) -> Result<Vec<TrackedSequence>> {
    match &settings.sequences {
        Some(path) if path.is_dir() => listed(&path.join("sequences.jsonl"), flights),
        Some(path) => listed(path, flights),
        None => of_flights(flights, settings),
    }
}

fn listed(path: &Path, flights: &Flights) -> Result<Vec<TrackedSequence>> {
    let hint = "`--sequences` takes the `sequences.jsonl` of an export for trackers of the same dataset";
    let text = std::fs::read_to_string(path)
        .map_err(|error| Diagnostic::unread(format!("`{}`", path.display()), &error).hint(hint))?;
    let refused = |line: usize, what: String| {
        Diagnostic::new("predictions-sequences", Fault::Input, format!("`{}` line {line}: {what}", path.display()))
            .hint(hint)
    };
    let (mut found, mut names): (Vec<TrackedSequence>, BTreeSet<String>) = Default::default();
    for (line, number) in text.lines().zip(1..).filter(|(line, _)| !line.trim().is_empty()) {
        let line: Line =
            serde_json::from_str(line).map_err(|error| refused(number, format!("not a sequence: {error}")))?;
        let Some(flight) = flights.place(&line.trajectory_id) else {
            return Err(refused(number, format!("the dataset has no trajectory `{}`", line.trajectory_id)));
        };
        let steps = line.pictures.checked_sub(1).and_then(|steps| steps.checked_mul(line.every));
        let last = steps.and_then(|steps| steps.checked_add(line.first_frame));
        if line.every == 0 || last.is_none_or(|last| last >= flights.rows[flight].frames) {
            let frames = flights.rows[flight].frames;
            let what = format!("{}, of every {} frames", counted(line.pictures, "picture"), line.every);
            return Err(refused(
                number,
                format!("`{}` has {frames}, and not {what}", line.trajectory_id, frames = counted(frames, "frame")),
            ));
        }
        if !names.insert(line.sequence.clone()) {
            return Err(refused(number, format!("a second sequence `{}`; names must differ", line.sequence)));
        }
        let [first, every, pictures] = [line.first_frame, line.every, line.pictures];
        found.push(TrackedSequence { name: line.sequence, flight, first, every, pictures });
    }
    if found.is_empty() {
        return Err(refused(1, "there is no sequence".into()));
    }
    Ok(found)
}

/// The sequences of an export of the whole dataset, named by flight.
fn of_flights(flights: &Flights, settings: &PictureSettings) -> Result<Vec<TrackedSequence>> {
    let every = settings.every.max(1);
    let all: Vec<usize> = (0..flights.rows.len()).collect();
    let mut found = vec![];
    for part in flights.parts(&all, &|flight| *flight) {
        // Tracks begin with the flight, whatever its frames show.
        let loaded = match settings.kind {
            PictureKind::Tracks => Cow::Borrowed(flights),
            _ => flights.part(part)?,
        };
        for flight in part.iter().copied() {
            let seen = |frame: &usize| settings.kind == PictureKind::Tracks || is_seen(&loaded, flight, *frame);
            let Some(first) = (0..flights.rows[flight].frames).step_by(every).find(seen) else { continue };
            let pictures = (flights.rows[flight].frames - first).div_ceil(every);
            let name = flights.rows[flight].trajectory_id.clone();
            found.push(TrackedSequence { name, flight, first, every, pictures });
        }
    }
    Ok(found)
}

fn is_seen(flights: &Flights, flight: usize, frame: usize) -> bool {
    flights.track(flight).boxes[frame].is_some()
}
