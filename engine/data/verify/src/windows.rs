//! Table `windows` against the flights it was cut from: places, increments, boxes, kinds.

use super::flight_list::FlightList;
use super::flights::Flights;
use super::report::VerifyReport;
use super::rows::{self, split_of};
use cosfly_diagnose::counted;
use cosfly_frames::Pose;
use cosfly_frames::action;
use cosfly_read::{FlightTrack, Rows};
use cosfly_schema::TownLayout;
use cosfly_schema::tables::{self, Column, DatasetItem, SceneMembership};
use cosfly_splits::policy::SplitPolicy;
use cosfly_windows::{Difficulty, WindowFeatures, WindowFrames, WindowShape};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// How far a 32-bit float may be from the number it stands for, as a share and at least.
const ROUNDING: f64 = 1e-5;
/// Numbers that were computed from others in 64-bit floats may differ by this much.
const TOLERANCE: f64 = 1e-6;

/// An increment: from one pose to another.
type Step = fn(&Pose, &Pose) -> [f64; 6];

/// Checks every window of the wanted flights: its flights, its place, its increments and boxes, what kind of window it is.
pub fn check(flights: &Flights<'_>, report: &mut VerifyReport) {
    let Ok(policy) = SplitPolicy::of_dataset(flights.folder) else { return };
    let load = |wanted: &BTreeSet<usize>| flights.tracks(wanted);
    let list = &flights.tables.flights;
    let mut windows = Windows { flights, shape: policy.windows.shape(), seen: seen(list), counts: vec![0; list.len()] };
    for file in flights.files.sound_below("data/windows/") {
        windows.check_file(file, &load, report);
    }
    windows.check_counts(report);
}

/// Whether split `train` has flights in the town of a flight, for every flight.
fn seen(flights: &FlightList) -> Vec<bool> {
    let mut layouts: BTreeMap<&str, (&TownLayout, bool)> = BTreeMap::new();
    for flight in flights.iter() {
        let known = layouts.entry(&flight.town_layout.digest).or_insert((&flight.town_layout, false));
        known.1 |= split_of(&flight.place.0) == "train";
    }
    let train: Vec<&TownLayout> =
        layouts.values().filter(|(_, is_train)| *is_train).map(|(layout, _)| *layout).collect();
    let is_seen = |layout: &TownLayout| train.iter().any(|it| it.is_same_place(layout));
    let seen: BTreeMap<&str, bool> = layouts.iter().map(|(digest, (layout, _))| (*digest, is_seen(layout))).collect();
    flights.iter().map(|flight| seen[flight.town_layout.digest.as_str()]).collect()
}

/// Windows held against their trajectories.
struct Windows<'a> {
    flights: &'a Flights<'a>,
    shape: WindowShape,
    /// Flights in towns that split `train` has flights in, too.
    seen: Vec<bool>,
    /// Windows of each flight so far.
    counts: Vec<u32>,
}

/// Reads the tracks of some flights.
type Load<'a> = &'a dyn Fn(&BTreeSet<usize>) -> BTreeMap<usize, FlightTrack>;

impl Windows<'_> {
    /// Checks the windows of one file, row group by row group.
    fn check_file(&mut self, file: &str, load: Load<'_>, report: &mut VerifyReport) {
        let mut findings: Vec<(usize, String, &'static str, String)> = vec![];
        let mut first = 0;
        let outcome = rows::read(&self.flights.folder.join(file), &rows::table("windows"), &mut |rows| {
            self.flights.files.stop.check("verify")?;
            let (ids, window_ids) =
                (rows.values(tables::Windows::trajectory_id)?, rows.values(tables::Windows::window_id)?);
            let list = &self.flights.tables.flights;
            let mut windows: Vec<(usize, u32, WindowRow)> = vec![];
            for row in 0..rows.len() {
                let number = list.number(ids.text(row));
                if number.is_some_and(|number| !self.flights.wanted.has(number)) {
                    continue;
                }
                let mut count = 0;
                if let Some(number) = number {
                    count = self.counts[number];
                    self.counts[number] += 1;
                }
                windows.push((row, count, WindowRow::read(rows, row)?));
            }
            let numbers = windows.iter().flat_map(|(_, _, it)| [&it.trajectory_id, &it.expert_id]);
            let tracks = load(&numbers.filter_map(|id| list.number(id)).collect());
            let wrong: Vec<(usize, Wrong)> = windows
                .par_iter()
                .filter_map(|(row, count, window)| Some((*row, self.mismatch(window, *count, &tracks, file)?)))
                .collect();
            findings.extend(
                wrong
                    .into_iter()
                    .map(|(row, (rule, message))| (first + row, window_ids.text(row).to_owned(), rule, message)),
            );
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
}

/// Steps along the world's axes, then in body frames: of the input, to the expert, ahead, of the expert.
const STEPS: [[Column<DatasetItem, Vec<f32>>; 4]; 2] = [
    [
        tables::Windows::input_steps_in_world,
        tables::Windows::correction_in_world,
        tables::Windows::waypoint_deltas_in_world,
        tables::Windows::expert_steps_in_world,
    ],
    [
        tables::Windows::input_steps_in_body,
        tables::Windows::correction_in_body,
        tables::Windows::waypoint_deltas_in_body,
        tables::Windows::expert_steps_in_body,
    ],
];
const BOXES: [Column<DatasetItem, Vec<f32>>; 2] = [tables::Windows::input_boxes_px, tables::Windows::expert_boxes_px];

/// A row of table `windows`.
struct WindowRow {
    trajectory_id: String,
    expert_id: String,
    start_frame: u32,
    scene: SceneMembership,
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
            trajectory_id: rows.get(tables::Windows::trajectory_id, row)?,
            expert_id: rows.get(tables::Windows::expert_id, row)?,
            start_frame: rows.get(tables::Windows::start_frame, row)?,
            scene: rows.get(tables::Windows::scene, row)?,
            difficulty: rows.get(tables::Windows::difficulty, row)?,
            features: StoredFeatures {
                turn_deg: rows.get(tables::Windows::turn_deg, row)?,
                height_change_m: rows.get(tables::Windows::height_change_m, row)?,
                occluded_share: rows.get(tables::Windows::occluded_share, row)?,
                speed_mps: rows.get(tables::Windows::speed_mps, row)?,
            },
            target_is_static: rows.get(tables::Windows::target_is_static, row)?,
            target_is_occluded: rows.get(tables::Windows::target_is_occluded, row)?,
            current_pose: rows.get(tables::Windows::current_pose_in_world, row)?,
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

impl Windows<'_> {
    /// Problem of a window, `count` others of whose flight come before.
    fn mismatch(
        &self,
        window: &WindowRow,
        count: u32,
        tracks: &BTreeMap<usize, FlightTrack>,
        file: &str,
    ) -> Option<Wrong> {
        self.compare(window, count as usize, tracks, file).err()
    }

    fn compare(
        &self,
        window: &WindowRow,
        count: usize,
        tracks: &BTreeMap<usize, FlightTrack>,
        file: &str,
    ) -> Result<(), Wrong> {
        let (id, expert_id) = (&window.trajectory_id, &window.expert_id);
        let list = &self.flights.tables.flights;
        let number = list.number(id).unwrap_or(usize::MAX);
        let (Some(flight), Some(own)) = (list.get(id), tracks.get(&number)) else {
            return Err(("verify-reference", format!("there is no flight `{id}`")));
        };
        if split_of(&flight.place.0) != split_of(file) {
            return Err(("split-window", format!("its flight `{id}` is in split `{}`", split_of(&flight.place.0))));
        }
        let expected_expert = flight.expert_id.as_ref().unwrap_or(id);
        let expert = list.number(expert_id).and_then(|number| tracks.get(&number));
        let Some(expert) = expert.filter(|_| expert_id == expected_expert) else {
            return Err(("verify-reference", format!("its expert is `{expert_id}`, not `{expected_expert}`")));
        };
        let shape = self.shape;
        let start = count * shape.stride;
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
        let scene = if self.seen[number] { SceneMembership::Seen } else { SceneMembership::Unseen };
        if window.scene != scene {
            return Err(("verify-window", format!("`scene` must be `{scene:?}`").to_lowercase()));
        }
        Ok(())
    }

    /// Every flight that has its expert has all its windows.
    fn check_counts(&self, report: &mut VerifyReport) {
        let list = &self.flights.tables.flights;
        for (number, flight) in list.iter().enumerate().filter(|(number, _)| self.flights.wanted.has(*number)) {
            let has_frames = |id: &String| list.number(id).is_some_and(|number| self.flights.has_frames(number));
            let expected =
                if flight.expert_id.as_ref().is_none_or(has_frames) { self.shape.count(flight.frames) } else { 0 };
            let found = self.counts[number] as usize;
            if found != expected {
                let place = format!("row {}, `{}`", flight.place.1, flight.trajectory_id);
                let message = format!(
                    "table `windows` has {found} of it; there are {expected}",
                    found = counted(found, "window")
                );
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
                    format!("`{name}` has {} for {}", counted(stored.len(), "number"), counted(frames.len(), "frame")),
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
            (tables::Windows::turn_deg.name, stored.turn_deg, features.turn_deg),
            (tables::Windows::height_change_m.name, stored.height_change_m, features.height_change_m),
            (tables::Windows::occluded_share.name, stored.occluded_share, features.occluded_share),
            (tables::Windows::speed_mps.name, stored.speed_mps, features.speed_mps),
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
            (tables::Windows::difficulty.name, window.difficulty == stored.difficulty()),
            (tables::Windows::target_is_static.name, window.target_is_static == features.target_is_static()),
            (tables::Windows::target_is_occluded.name, window.target_is_occluded == is_occluded),
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
    use super::super::options::Wanted;
    use super::super::{files, tables};
    use super::*;
    use cosfly_frames::DVec3;
    use cosfly_sample as sample;
    use cosfly_schema::config::WindowConfig;
    use cosfly_schema::{DatasetConfig, EncodingConfig};

    /// Spoils the tracks of flights and whether their towns are seen.
    type Spoil<'a> = &'a dyn Fn(&str, &mut FlightTrack);

    /// Findings when the windows of the sample dataset are compared with spoiled frames.
    fn found(spoil: Spoil<'_>, is_seen: bool) -> Vec<String> {
        let folder = tempfile::tempdir().unwrap();
        let windows = WindowConfig { size: 4, history: 2, stride: 1 };
        let config = DatasetConfig { windows, ..DatasetConfig::default() };
        sample::write_to_folder(folder.path(), &config, EncodingConfig::default()).unwrap();
        let mut report = VerifyReport::default();
        let files = files::check(folder.path(), &Default::default(), &mut report).unwrap();
        let small = tables::read(folder.path(), &files, &mut report);
        let wanted = Wanted::of(&small.flights, None);
        let flights = Flights::new(folder.path(), &files, &small, &wanted, None, &mut report);
        let load = |wanted: &BTreeSet<usize>| {
            let mut tracks = flights.tracks(wanted);
            tracks.iter_mut().for_each(|(number, track)| spoil(&small.flights.at(*number).trajectory_id, track));
            tracks
        };
        let count = small.flights.len();
        let shape = config.windows.shape();
        let mut windows = Windows { flights: &flights, shape, seen: vec![is_seen; count], counts: vec![0; count] };
        for file in files.sound_below("data/windows/") {
            windows.check_file(file, &load, &mut report);
        }
        windows.check_counts(&mut report);
        report.findings.iter().map(|it| it.message.clone()).collect()
    }

    #[test]
    fn windows_that_are_not_of_their_frames_are_found() {
        assert_eq!(found(&|_, _| {}, true), <[String; 0]>::default());
        type OfTrack = fn(&mut FlightTrack);
        let spoils: [(&str, OfTrack); 5] = [
            ("of `input_boxes_px` is", |it| it.boxes.rotate_left(1)),
            ("`input_steps_in_world` is not", |it| it.poses[2].position_in_world += DVec3::X),
            ("`input_steps_in_world` is not", |it| it.poses[1].yaw_rad += 0.01),
            ("`target_is_occluded` does not", |it| {
                it.visible.iter_mut().for_each(|share| *share = 1.0 - share.round())
            }),
            ("`turn_deg` is", |it| it.heading_rad[1] += 0.3),
        ];
        for (expected, spoil) in spoils {
            let of_twin = |id: &str, track: &mut FlightTrack| {
                if id == "perturbed-p00000" {
                    spoil(track);
                }
            };
            let messages = found(&of_twin, true);
            assert!(messages.iter().any(|it| it.contains(expected)), "{expected}: {messages:?}");
        }
        let of_expert = |id: &str, track: &mut FlightTrack| {
            if id == "expert-p00000" {
                track.boxes[1] = None;
            }
        };
        let messages = found(&of_expert, true);
        assert!(messages.iter().any(|it| it.contains("box 1 of `expert_boxes_px` is")), "{messages:?}");
        assert!(found(&|_, _| {}, false)[0].contains("`scene` must be `unseen`"));
    }
}
