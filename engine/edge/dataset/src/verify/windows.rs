//! Table `windows` against the flights it was cut from: places, increments, boxes, kinds.

use super::files::CheckedFiles;
use super::report::VerifyReport;
use super::rows::{self, Batch};
use super::tables::{SmallTables, split_of};
use crate::read::{FlightTrack, PublishedDataset};
use crate::splits::promise::Promise;
use crate::{action, tables};
use cosfly_frames::Pose;
use cosfly_metrics::difficulty::WindowFrames;
use cosfly_metrics::{Difficulty, WindowFeatures, WindowShape};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// How far a 32-bit float may be from the number it stands for, as a share and at least.
const ROUNDING: f64 = 1e-5;
/// Numbers that were computed from others in 64-bit floats may differ by this much.
const TOLERANCE: f64 = 1e-6;

/// An increment: from one pose to another.
type Step = fn(&Pose, &Pose) -> [f64; 6];

/// Checks every window: its flights, its place, its increments and boxes, what kind of window it is.
pub fn check(folder: &Path, files: &CheckedFiles, small: &SmallTables, report: &mut VerifyReport) {
    let Some(flights) = Flights::of(folder) else { return };
    flights.check(folder, files, small, report);
}

/// What windows are held against: the tables `trajectories` and `frames`.
pub struct Flights {
    shape: WindowShape,
    /// Frames by flight.
    tracks: BTreeMap<String, FlightTrack>,
    /// Flights in towns that split `train` has flights in, too.
    seen: BTreeSet<String>,
}

impl Flights {
    /// All flights; nothing when their tables cannot be read, which was found before.
    pub fn of(folder: &Path) -> Option<Self> {
        let promise = Promise::of_dataset(folder).ok()?;
        let published = PublishedDataset::open(folder).ok()?;
        let tracks = published.tracks().ok()?;
        let flights = published.flights();
        let is_seen = |at: &usize| {
            let mut train = flights.iter().filter(|it| it.split == "train");
            train.any(|it| it.town_layout.is_same_place(&flights[*at].town_layout))
        };
        let id = |at: usize| flights[at].trajectory_id.clone();
        Some(Self {
            shape: promise.windows.shape(),
            seen: (0..flights.len()).filter(is_seen).map(id).collect(),
            tracks: tracks.into_iter().enumerate().map(|(at, track)| (id(at), track)).collect(),
        })
    }

    fn check(self, folder: &Path, files: &CheckedFiles, small: &SmallTables, report: &mut VerifyReport) {
        let mut windows = Windows { flights: self, small, counts: BTreeMap::new() };
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
}

struct Windows<'a> {
    flights: Flights,
    small: &'a SmallTables,
    counts: BTreeMap<String, usize>,
}

/// A rule and what is wrong.
type Wrong = (&'static str, String);

/// A window's two flights, and its frames in them.
struct Cut<'a> {
    shape: WindowShape,
    dt_s: f64,
    own: &'a FlightTrack,
    expert: &'a FlightTrack,
    start: usize,
    /// The expert's frame of each frame.
    expert_frames: Vec<usize>,
}

impl Windows<'_> {
    fn check(&mut self, batch: &Batch, row: usize, file: &str) -> Result<(), Wrong> {
        let [id, expert_id] = ["trajectory_id", "expert_id"].map(|name| batch.text(name, row));
        let (Some(flight), Some(own)) = (self.small.flights.get(&id), self.flights.tracks.get(&id)) else {
            return Err(("verify-reference", format!("there is no flight `{id}`")));
        };
        if split_of(&flight.place.0) != split_of(file) {
            return Err(("split-window", format!("its flight `{id}` is in split `{}`", split_of(&flight.place.0))));
        }
        let expected_expert = if flight.expert_id.is_empty() { &id } else { &flight.expert_id };
        let Some(expert) = self.flights.tracks.get(&expert_id).filter(|_| expert_id == *expected_expert) else {
            return Err(("verify-reference", format!("its expert is `{expert_id}`, not `{expected_expert}`")));
        };
        let shape = self.flights.shape;
        let number = self.counts.entry(id.clone()).or_default();
        let start = *number * shape.stride;
        *number += 1;
        let found = batch.integer("start_frame", row);
        if found != Some(start as i64) || start + shape.size() > own.poses.len() {
            return Err(("verify-window", format!("it starts at {found:?}; the next window starts at {start}")));
        }
        let expert_frames = (start..start + shape.size()).map(|frame| own.expert_frame[frame] as usize).collect();
        let cut = Cut { shape, dt_s: flight.dt_s, own, expert, start, expert_frames };
        if cut.expert_frames.iter().any(|frame| *frame >= expert.poses.len()) {
            return Err(("verify-window", "its expert has no such frames".into()));
        }
        cut.check_steps(batch, row)?;
        cut.check_boxes(batch, row)?;
        cut.check_kinds(batch, row)?;
        let scene = i64::from(!self.flights.seen.contains(&id));
        if batch.integer("scene", row) != Some(scene) {
            return Err(("verify-window", format!("`scene` must be `{}`", tables::SCENES[scene as usize])));
        }
        Ok(())
    }

    /// Every flight that has its expert has all its windows.
    fn check_counts(&self, report: &mut VerifyReport) {
        for (id, flight) in &self.small.flights {
            let has_expert = flight.expert_id.is_empty() || self.flights.tracks.contains_key(&flight.expert_id);
            let frames = usize::try_from(flight.frames).unwrap_or(0);
            let expected = if has_expert { self.flights.shape.count(frames) } else { 0 };
            let found = self.counts.get(id).copied().unwrap_or(0);
            if found != expected {
                let place = format!("row {}, `{id}`", flight.place.1);
                let message = format!("table `windows` has {found} windows of it; there are {expected}");
                report.find(&flight.place.0, place, "verify-count", message);
            }
        }
    }
}

impl Cut<'_> {
    fn frames(&self) -> std::ops::Range<usize> {
        self.start..self.start + self.shape.size()
    }

    fn input(&self) -> std::ops::Range<usize> {
        self.start..self.start + self.shape.history
    }

    /// The increments and the current pose.
    fn check_steps(&self, batch: &Batch, row: usize) -> Result<(), Wrong> {
        let input = &self.own.poses[self.input()];
        let truth: Vec<Pose> = self.expert_frames.iter().map(|frame| self.expert.poses[*frame]).collect();
        let current = input[input.len() - 1];
        let ahead: Vec<Pose> = [current].into_iter().chain(truth[input.len()..].iter().copied()).collect();
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
        let angles = [current.pitch_rad, current.yaw_rad, current.roll_rad].map(f64::to_degrees);
        let expected = current.position_in_world.to_array().into_iter().chain(angles);
        let stored = batch.reals::<6>("current_pose_in_world", row);
        if !stored.is_some_and(|it| it.iter().zip(expected).all(|(found, pose)| (found - pose).abs() <= TOLERANCE)) {
            return Err(("verify-window", "`current_pose_in_world` is not the last pose of the input".into()));
        }
        Ok(())
    }

    /// The boxes are those of table `frames`, bit for bit.
    fn check_boxes(&self, batch: &Batch, row: usize) -> Result<(), Wrong> {
        let own = self.input().map(|frame| (self.own, frame)).collect();
        let expert = self.expert_frames.iter().map(|frame| (self.expert, *frame)).collect();
        let boxes: [(&str, Vec<(&FlightTrack, usize)>); 2] = [("input_boxes_px", own), ("expert_boxes_px", expert)];
        for (name, frames) in boxes {
            let stored = batch.floats(name, row);
            if stored.len() != 4 * frames.len() {
                return Err((
                    "verify-window",
                    format!("`{name}` has {} numbers for {} frames", stored.len(), frames.len()),
                ));
            }
            for (at, (found, (track, frame))) in stored.chunks_exact(4).zip(frames).enumerate() {
                let expected = track.boxes[frame].unwrap_or_default();
                if found != expected {
                    let message = format!("box {at} of `{name}` is {found:?}; table `frames` has {expected:?}");
                    return Err(("verify-window", message));
                }
            }
        }
        Ok(())
    }

    /// The features, the difficulty that follows from them, and the two flags.
    fn check_kinds(&self, batch: &Batch, row: usize) -> Result<(), Wrong> {
        let expert: Vec<Pose> = self.expert_frames.iter().map(|frame| self.expert.poses[*frame]).collect();
        let visible: Vec<f64> = self.expert_frames.iter().map(|frame| self.expert.visible[*frame]).collect();
        let features = WindowFeatures::of(&WindowFrames {
            expert: &expert,
            feet: &self.own.feet[self.frames()],
            heading_rad: &self.own.heading_rad[self.frames()],
            visible: &visible,
            dt_s: self.dt_s,
        });
        let real = |name: &str| batch.real(name, row).unwrap_or(f64::NAN);
        let [turn_deg, height_change_m, occluded_share, speed_mps] =
            ["turn_deg", "height_change_m", "occluded_share", "speed_mps"].map(real);
        for (name, found, expected) in [
            ("turn_deg", turn_deg, features.turn_deg),
            ("height_change_m", height_change_m, features.height_change_m),
            ("occluded_share", occluded_share, features.occluded_share),
            ("speed_mps", speed_mps, features.speed_mps),
        ] {
            if (found - expected).is_nan() || (found - expected).abs() > TOLERANCE {
                return Err(("verify-window", format!("`{name}` is {found}; the frames give {expected}")));
            }
        }
        // From the stored numbers: a rounding error must not decide.
        let stored = WindowFeatures { turn_deg, height_change_m, occluded_share, speed_mps, ..features };
        let difficulty = match stored.difficulty() {
            Difficulty::Easy => 0,
            Difficulty::Medium => 1,
            Difficulty::Hard => 2,
        };
        let is_occluded = self.input().any(|frame| self.own.visible[frame] < 0.5);
        for (name, is_so) in [
            ("difficulty", batch.integer("difficulty", row) == Some(difficulty)),
            ("target_is_static", batch.flag("target_is_static", row) == Some(features.target_is_static())),
            ("target_is_occluded", batch.flag("target_is_occluded", row) == Some(is_occluded)),
        ] {
            if !is_so {
                return Err(("verify-window", format!("`{name}` does not follow from the frames")));
            }
        }
        Ok(())
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

#[cfg(test)]
mod tests {
    use super::super::{files, tables};
    use super::*;
    use crate::config::WindowConfig;
    use crate::sample;
    use crate::{DatasetConfig, EncodingConfig};
    use cosfly_frames::DVec3;

    /// What is found when the windows of the sample dataset are held against spoiled frames.
    fn found(spoil: impl Fn(&mut Flights)) -> Vec<String> {
        let folder = tempfile::tempdir().unwrap();
        let windows = WindowConfig { size: 4, history: 2, stride: 1 };
        let config = DatasetConfig { windows, ..DatasetConfig::default() };
        sample::write_to_folder(folder.path(), &config, EncodingConfig::default()).unwrap();
        let mut report = VerifyReport::default();
        let files = files::check(folder.path(), &mut report).unwrap();
        let small = tables::read(folder.path(), &files, &mut report);
        let mut flights = Flights::of(folder.path()).unwrap();
        spoil(&mut flights);
        flights.check(folder.path(), &files, &small, &mut report);
        report.findings.iter().map(|it| it.message.clone()).collect()
    }

    #[test]
    fn windows_that_are_not_of_their_frames_are_found() {
        assert_eq!(found(|_| {}), <[String; 0]>::default());
        let own = |it: &mut Flights, spoil: &dyn Fn(&mut FlightTrack)| {
            spoil(it.tracks.get_mut("perturbed-p00000").expect("the sample has it"));
        };
        type Spoil = Box<dyn Fn(&mut FlightTrack)>;
        let spoils: [(&str, Spoil); 5] = [
            ("of `input_boxes_px` is", Box::new(|it| it.boxes.rotate_left(1))),
            ("`input_steps_in_world` is not", Box::new(|it| it.poses[2].position_in_world += DVec3::X)),
            ("`input_steps_in_world` is not", Box::new(|it| it.poses[1].yaw_rad += 0.01)),
            (
                "`target_is_occluded` does not",
                Box::new(|it| it.visible.iter_mut().for_each(|share| *share = 1.0 - share.round())),
            ),
            ("`turn_deg` is", Box::new(|it| it.heading_rad[1] += 0.3)),
        ];
        for (expected, spoil) in spoils {
            let messages = found(|it| own(it, &spoil));
            assert!(messages.iter().any(|it| it.contains(expected)), "{expected}: {messages:?}");
        }
        let of_expert = found(|it| it.tracks.get_mut("expert-p00000").expect("the sample has it").boxes[1] = None);
        assert!(of_expert.iter().any(|it| it.contains("box 1 of `expert_boxes_px` is")), "{of_expert:?}");
        assert!(found(|it| it.seen.clear())[0].contains("`scene` must be `unseen`"));
    }
}
