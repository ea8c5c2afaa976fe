//! Table `windows` against the flights it was cut from.

use super::files::CheckedFiles;
use super::report::VerifyReport;
use super::rows::{self, Batch};
use super::tables::{SmallTables, split_of};
use crate::read::PublishedDataset;
use crate::splits::promise::Promise;
use crate::{action, tables};
use cosfly_frames::Pose;
use cosfly_metrics::WindowShape;
use std::collections::BTreeMap;
use std::path::Path;

/// How far a 32-bit float may be from the number it stands for, as a share and at least.
const ROUNDING: f64 = 1e-5;

/// An increment: from one pose to another.
type Step = fn(&Pose, &Pose) -> [f64; 6];

/// Checks every window: its flights, its place, its increments.
pub fn check(folder: &Path, files: &CheckedFiles, small: &SmallTables, report: &mut VerifyReport) {
    let (Ok(promise), Ok(published)) = (Promise::of_dataset(folder), PublishedDataset::open(folder)) else { return };
    let mut poses: BTreeMap<String, Vec<Pose>> = BTreeMap::new();
    let ways = published.ways(&mut |id, way, _| {
        poses.insert(id.to_owned(), way.to_vec());
    });
    if ways.is_err() {
        return;
    }
    let mut windows = Windows { shape: promise.windows.shape(), small, poses, counts: BTreeMap::new() };
    let table = tables::of_trajectories().into_iter().find(|table| table.name == "windows").expect("it exists");
    for file in files.sound_below("data/windows/") {
        let mut findings: Vec<(usize, String, &'static str, String)> = vec![];
        let mut first = 0;
        let outcome = rows::batches(&folder.join(file), &table, &mut |batch| {
            for row in 0..batch.rows() {
                if let Err((rule, message)) = windows.check(batch, row, file) {
                    findings.push((first + row, batch.text("window_id", row), rule, message));
                }
            }
            first += batch.rows();
        });
        for (row, id, rule, message) in findings {
            report.find(file, format!("row {row}, `{id}`"), rule, message);
        }
        if let Err(message) = outcome {
            report.find(file, "", "verify-schema", message);
        }
    }
    windows.check_counts(report);
}

struct Windows<'a> {
    shape: WindowShape,
    small: &'a SmallTables,
    poses: BTreeMap<String, Vec<Pose>>,
    counts: BTreeMap<String, usize>,
}

/// A rule and what is wrong.
type Wrong = (&'static str, String);

impl Windows<'_> {
    fn check(&mut self, batch: &Batch, row: usize, file: &str) -> Result<(), Wrong> {
        let [id, expert_id] = ["trajectory_id", "expert_id"].map(|name| batch.text(name, row));
        let (Some(flight), Some(poses)) = (self.small.flights.get(&id), self.poses.get(&id)) else {
            return Err(("verify-reference", format!("there is no flight `{id}`")));
        };
        if split_of(&flight.place.0) != split_of(file) {
            return Err(("split-window", format!("its flight `{id}` is in split `{}`", split_of(&flight.place.0))));
        }
        let expected_expert = if flight.expert_id.is_empty() { &id } else { &flight.expert_id };
        let Some(expert) = self.poses.get(&expert_id).filter(|_| expert_id == *expected_expert) else {
            return Err(("verify-reference", format!("its expert is `{expert_id}`, not `{expected_expert}`")));
        };
        let number = self.counts.entry(id.clone()).or_default();
        let start = *number * self.shape.stride;
        *number += 1;
        let (size, history) = (self.shape.size(), self.shape.history);
        let found = batch.integer("start_frame", row);
        if found != Some(start as i64) || start + size > poses.len() {
            return Err(("verify-window", format!("it starts at {found:?}; the next window starts at {start}")));
        }
        let expert_frames = self.small.pairs.get(&id).map(|pair| &pair.expert_frames);
        let aligned = |frame: usize| {
            let frame = expert_frames.map_or(Some(frame), |frames| usize::try_from(*frames.get(frame)?).ok());
            frame.and_then(|frame| expert.get(frame).copied())
        };
        let Some(truth) = (start..start + size).map(aligned).collect::<Option<Vec<Pose>>>() else {
            return Err(("verify-window", "its expert has no such frames".into()));
        };
        let input = &poses[start..start + history];
        let ahead: Vec<Pose> = [input[history - 1]].into_iter().chain(truth[history..].iter().copied()).collect();
        let along = |way: &[Pose], step: Step| way.windows(2).flat_map(|pair| step(&pair[0], &pair[1])).collect();
        for (axes, step) in [("world", action::in_world as Step), ("body", action::in_body)] {
            let across = input.iter().zip(&truth).flat_map(|(from, to)| step(from, to)).collect();
            for (what, expected) in [
                ("input_steps", along(input, step)),
                ("correction", across),
                ("waypoint_deltas", along(&ahead, step)),
                ("expert_steps", along(&truth, step)),
            ] {
                same(&batch.floats(&format!("{what}_in_{axes}"), row), expected).map_err(|at| {
                    ("verify-window", format!("number {at} of `{what}_in_{axes}` is not of the flights"))
                })?;
            }
        }
        let current = input[history - 1].position_in_world.to_array();
        let stored = batch.reals::<6>("current_pose_in_world", row);
        if stored.is_none_or(|stored| stored[..3] != current) {
            return Err(("verify-window", "`current_pose_in_world` is not the last pose of the input".into()));
        }
        Ok(())
    }

    /// Every flight that has its expert has all its windows.
    fn check_counts(&self, report: &mut VerifyReport) {
        for (id, flight) in &self.small.flights {
            let has_expert = flight.expert_id.is_empty() || self.poses.contains_key(&flight.expert_id);
            let frames = usize::try_from(flight.frames).unwrap_or(0);
            let expected = if has_expert { self.shape.count(frames) } else { 0 };
            let found = self.counts.get(id).copied().unwrap_or(0);
            if found != expected {
                let place = format!("row {}, `{id}`", flight.place.1);
                let message = format!("table `windows` has {found} windows of it; there are {expected}");
                report.find(&flight.place.0, place, "verify-count", message);
            }
        }
    }
}

/// Whether `found` is `expected` but for rounding; the first number that is not.
fn same(found: &[f32], expected: Vec<f64>) -> Result<(), usize> {
    let differs = |(a, b): (&f32, &f64)| (f64::from(*a) - b).abs() > ROUNDING * b.abs().max(1.0);
    match found.iter().zip(&expected).position(differs) {
        Some(at) => Err(at),
        None if found.len() != expected.len() => Err(found.len().min(expected.len())),
        None => Ok(()),
    }
}
