//! Table `windows` against the flights it was cut from: places, increments, boxes, kinds.

use super::files::CheckedFiles;
use super::report::VerifyReport;
use super::rows;
use super::rows::split_of;
use super::tables::SmallTables;
use cosfly_frames::Pose;
use cosfly_frames::action;
use cosfly_metrics::difficulty::WindowFrames;
use cosfly_metrics::{Difficulty, WindowFeatures, WindowShape};
use cosfly_read::{FlightTrack, PublishedDataset, Rows};
use cosfly_schema::tables::{Column, DatasetItem, Scene, Windows};
use cosfly_splits::policy::SplitPolicy;
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

/// Rows that windows are compared with, of tables `trajectories` and `frames`.
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
        let policy = SplitPolicy::of_dataset(folder).ok()?;
        let published = PublishedDataset::open(folder).ok()?;
        let tracks = published.tracks().ok()?;
        let flights = published.flights();
        let is_seen = |at: &usize| {
            let mut train = flights.iter().filter(|it| it.split == "train");
            train.any(|it| it.town_layout.is_same_place(&flights[*at].town_layout))
        };
        let id = |at: usize| flights[at].trajectory_id.clone();
        Some(Self {
            shape: policy.windows.shape(),
            seen: (0..flights.len()).filter(is_seen).map(id).collect(),
            tracks: tracks.into_iter().enumerate().map(|(at, track)| (id(at), track)).collect(),
        })
    }

    fn check(self, folder: &Path, files: &CheckedFiles, small: &SmallTables, report: &mut VerifyReport) {
        let mut windows = Held { flights: self, small, counts: BTreeMap::new() };
        for file in files.sound_below("data/windows/") {
            let mut findings: Vec<(usize, String, &'static str, String)> = vec![];
            let mut first = 0;
            let outcome = rows::read(&folder.join(file), &rows::table("windows"), &mut |rows| {
                for row in 0..rows.len() {
                    if let Err((rule, message)) = windows.check(&WindowRow::read(rows, row)?, file) {
                        findings.push((first + row, rows.get(Windows::window_id, row)?, rule, message));
                    }
                }
                first += rows.len();
                Ok(())
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

/// Windows held against their trajectories.
struct Held<'a> {
    flights: Flights,
    small: &'a SmallTables,
    counts: BTreeMap<String, usize>,
}

/// Steps along the world's axes, then in body frames: of the input, to the expert, ahead, of the expert.
const STEPS: [[Column<DatasetItem, Vec<f32>>; 4]; 2] = [
    [
        Windows::input_steps_in_world,
        Windows::correction_in_world,
        Windows::waypoint_deltas_in_world,
        Windows::expert_steps_in_world,
    ],
    [
        Windows::input_steps_in_body,
        Windows::correction_in_body,
        Windows::waypoint_deltas_in_body,
        Windows::expert_steps_in_body,
    ],
];
const BOXES: [Column<DatasetItem, Vec<f32>>; 2] = [Windows::input_boxes_px, Windows::expert_boxes_px];

/// A row of table `windows`.
struct WindowRow {
    trajectory_id: String,
    expert_id: String,
    start_frame: u32,
    scene: Scene,
    difficulty: Difficulty,
    features: StoredFeatures,
    target_is_static: bool,
    target_is_occluded: bool,
    current_pose: [f64; 6],
    /// Values of [`STEPS`] and [`BOXES`] by name.
    lists: BTreeMap<&'static str, Vec<f32>>,
}

#[derive(Clone, Copy)]
struct StoredFeatures {
    turn_deg: f64,
    height_change_m: f64,
    occluded_share: f64,
    speed_mps: f64,
}

impl WindowRow {
    fn read(rows: &Rows<'_>, row: usize) -> cosfly_diagnose::Result<Self> {
        let mut lists = BTreeMap::new();
        for column in STEPS.into_iter().flatten().chain(BOXES) {
            lists.insert(column.name, rows.get(column, row)?);
        }
        Ok(Self {
            trajectory_id: rows.get(Windows::trajectory_id, row)?,
            expert_id: rows.get(Windows::expert_id, row)?,
            start_frame: rows.get(Windows::start_frame, row)?,
            scene: rows.get(Windows::scene, row)?,
            difficulty: rows.get(Windows::difficulty, row)?,
            features: StoredFeatures {
                turn_deg: rows.get(Windows::turn_deg, row)?,
                height_change_m: rows.get(Windows::height_change_m, row)?,
                occluded_share: rows.get(Windows::occluded_share, row)?,
                speed_mps: rows.get(Windows::speed_mps, row)?,
            },
            target_is_static: rows.get(Windows::target_is_static, row)?,
            target_is_occluded: rows.get(Windows::target_is_occluded, row)?,
            current_pose: rows.get(Windows::current_pose_in_world, row)?,
            lists,
        })
    }
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

impl Held<'_> {
    fn check(&mut self, window: &WindowRow, file: &str) -> Result<(), Wrong> {
        let (id, expert_id) = (&window.trajectory_id, &window.expert_id);
        let (Some(flight), Some(own)) = (self.small.flights.get(id), self.flights.tracks.get(id)) else {
            return Err(("verify-reference", format!("there is no flight `{id}`")));
        };
        if split_of(&flight.place.0) != split_of(file) {
            return Err(("split-window", format!("its flight `{id}` is in split `{}`", split_of(&flight.place.0))));
        }
        let expected_expert = flight.expert_id.as_ref().unwrap_or(id);
        let Some(expert) = self.flights.tracks.get(expert_id).filter(|_| expert_id == expected_expert) else {
            return Err(("verify-reference", format!("its expert is `{expert_id}`, not `{expected_expert}`")));
        };
        let shape = self.flights.shape;
        let number = self.counts.entry(id.clone()).or_default();
        let start = *number * shape.stride;
        *number += 1;
        let found = window.start_frame;
        if found as usize != start || start + shape.size() > own.poses.len() {
            return Err(("verify-window", format!("it starts at frame {found}; the next window starts at {start}")));
        }
        let expert_frames = (start..start + shape.size()).map(|frame| own.expert_frame[frame] as usize).collect();
        let cut = Cut { shape, dt_s: flight.dt_s, own, expert, start, expert_frames };
        if cut.expert_frames.iter().any(|frame| *frame >= expert.poses.len()) {
            return Err(("verify-window", "its expert has no such frames".into()));
        }
        cut.check_steps(window)?;
        cut.check_boxes(window)?;
        cut.check_kinds(window)?;
        let scene = if self.flights.seen.contains(id) { Scene::Seen } else { Scene::Unseen };
        if window.scene != scene {
            return Err(("verify-window", format!("`scene` must be `{scene:?}`").to_lowercase()));
        }
        Ok(())
    }

    /// Every flight that has its expert has all its windows.
    fn check_counts(&self, report: &mut VerifyReport) {
        for (id, flight) in &self.small.flights {
            let has_expert = flight.expert_id.as_ref().is_none_or(|expert| self.flights.tracks.contains_key(expert));
            let expected = if has_expert { self.flights.shape.count(flight.frames) } else { 0 };
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
    fn check_steps(&self, window: &WindowRow) -> Result<(), Wrong> {
        let input = &self.own.poses[self.input()];
        let truth: Vec<Pose> = self.expert_frames.iter().map(|frame| self.expert.poses[*frame]).collect();
        let current = input[input.len() - 1];
        let ahead: Vec<Pose> = [current].into_iter().chain(truth[input.len()..].iter().copied()).collect();
        let along = |way: &[Pose], step: Step| way.windows(2).flat_map(|pair| step(&pair[0], &pair[1])).collect();
        for ([input_steps, corrections, deltas, expert_steps], step) in
            STEPS.into_iter().zip([action::in_world as Step, action::in_body])
        {
            let across = input.iter().zip(&truth).flat_map(|(from, to)| step(from, to)).collect();
            for (column, expected) in [
                (input_steps, along(input, step)),
                (corrections, across),
                (deltas, along(&ahead, step)),
                (expert_steps, along(&truth, step)),
            ] {
                same(&window.lists[column.name], expected).map_err(|at| {
                    ("verify-window", format!("number {at} of `{}` is not of the trajectories", column.name))
                })?;
            }
        }
        let angles = [current.pitch_rad, current.yaw_rad, current.roll_rad].map(f64::to_degrees);
        let expected = current.position_in_world.to_array().into_iter().chain(angles);
        if !window.current_pose.iter().zip(expected).all(|(found, pose)| (found - pose).abs() <= TOLERANCE) {
            return Err(("verify-window", "`current_pose_in_world` is not the last pose of the input".into()));
        }
        Ok(())
    }

    /// The boxes are those of table `frames`, bit for bit.
    fn check_boxes(&self, window: &WindowRow) -> Result<(), Wrong> {
        let own = self.input().map(|frame| (self.own, frame)).collect();
        let expert = self.expert_frames.iter().map(|frame| (self.expert, *frame)).collect();
        let boxes: [Vec<(&FlightTrack, usize)>; 2] = [own, expert];
        for (column, frames) in BOXES.into_iter().zip(boxes) {
            let (name, stored) = (column.name, &window.lists[column.name]);
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
    fn check_kinds(&self, window: &WindowRow) -> Result<(), Wrong> {
        let expert: Vec<Pose> = self.expert_frames.iter().map(|frame| self.expert.poses[*frame]).collect();
        let visible: Vec<f64> = self.expert_frames.iter().map(|frame| self.expert.visible[*frame]).collect();
        let features = WindowFeatures::of(&WindowFrames {
            expert: &expert,
            feet: &self.own.feet[self.frames()],
            heading_rad: &self.own.heading_rad[self.frames()],
            visible: &visible,
            dt_s: self.dt_s,
        });
        let stored = window.features;
        for (name, found, expected) in [
            (Windows::turn_deg.name, stored.turn_deg, features.turn_deg),
            (Windows::height_change_m.name, stored.height_change_m, features.height_change_m),
            (Windows::occluded_share.name, stored.occluded_share, features.occluded_share),
            (Windows::speed_mps.name, stored.speed_mps, features.speed_mps),
        ] {
            if (found - expected).is_nan() || (found - expected).abs() > TOLERANCE {
                return Err(("verify-window", format!("`{name}` is {found}; the frames give {expected}")));
            }
        }
        // From the stored numbers: a rounding error must not decide.
        let [turn_deg, height_change_m, occluded_share, speed_mps] =
            [stored.turn_deg, stored.height_change_m, stored.occluded_share, stored.speed_mps];
        let stored = WindowFeatures { turn_deg, height_change_m, occluded_share, speed_mps, ..features };
        let is_occluded = self.input().any(|frame| self.own.visible[frame] < 0.5);
        for (name, is_so) in [
            (Windows::difficulty.name, window.difficulty == stored.difficulty()),
            (Windows::target_is_static.name, window.target_is_static == features.target_is_static()),
            (Windows::target_is_occluded.name, window.target_is_occluded == is_occluded),
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
    use cosfly_frames::DVec3;
    use cosfly_sample as sample;
    use cosfly_schema::config::WindowConfig;
    use cosfly_schema::{DatasetConfig, EncodingConfig};

    /// Findings when the windows of the sample dataset are compared with spoiled frames.
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
