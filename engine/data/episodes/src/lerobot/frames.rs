//! [`Frames`]: the tables of frames, and the recordings that they hold.

use super::actions::RecordedActions;
use super::features::{self, Features, pose};
use super::info::split;
use super::listed::Listed;
use crate::episode::stretch;
use crate::{ExaminedEpisode, ExaminedLook, ExaminedMoment, Flag};
use cosfly_diagnose::plausible;
use cosfly_frames::{DVec3, Pose};
use cosfly_read::ForeignRows;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Largest angle in radians; larger values are degrees.
const MOST_RADIANS: f64 = 6.4;

/// All rows of all tables of frames, in the order of the files.
#[derive(Default)]
pub struct Frames {
    numbers: BTreeMap<String, Vec<Vec<f64>>>,
    pictures: BTreeMap<String, Vec<String>>,
    /// Files, each with the number of its first row.
    pub tables: Vec<(usize, PathBuf)>,
    /// Number of rows.
    pub rows: usize,
}

impl Frames {
    /// Adds the rows of the table at `path`.
    pub fn append(&mut self, path: &Path, rows: ForeignRows) {
        self.tables.push((self.rows, path.to_owned()));
        for (name, values) in rows.numbers {
            let column = self.numbers.entry(name).or_default();
            column.resize(self.rows, vec![]);
            column.extend(values);
        }
        for (name, values) in rows.pictures {
            let column = self.pictures.entry(name).or_default();
            column.resize(self.rows, String::new());
            column.extend(values);
        }
        self.rows += rows.rows;
    }

    fn row(&self, name: &str, row: usize) -> &[f64] {
        self.numbers.get(name).and_then(|column| column.get(row)).map_or(&[], Vec::as_slice)
    }

    fn number(&self, name: &str, row: usize) -> Option<f64> {
        self.row(name, row).first().copied().filter(|number| plausible(*number).is_ok())
    }

    /// Rows of each episode, by its number.
    pub fn of_episodes(&self) -> BTreeMap<i64, Vec<usize>> {
        let mut episodes: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
        for row in 0..self.rows {
            let number = self.number("episode_index", row).unwrap_or(0.0) as i64;
            episodes.entry(number).or_default().push(row);
        }
        episodes
    }

    /// The recordings, in the order of their numbers; faults of their rows go to `flags`.
    pub fn recordings(
        &self,
        features: &Features,
        info: &Value,
        listed: &Listed,
        flags: &mut Vec<Flag>,
    ) -> Vec<RecordedActions> {
        let in_degrees = self.are_degrees(features);
        let episodes = self.of_episodes().into_iter();
        episodes
            .map(|(number, rows)| self.recording(number, &rows, features, in_degrees, info, listed, flags))
            .collect()
    }

    #[expect(clippy::too_many_arguments, reason = "one call; all of it is what a recording is made from")]
    fn recording(
        &self,
        number: i64,
        rows: &[usize],
        features: &Features,
        in_degrees: bool,
        info: &Value,
        listed: &Listed,
        flags: &mut Vec<Flag>,
    ) -> RecordedActions {
        let id = listed.name(number);
        let fps = info["fps"].as_f64().filter(|fps| *fps > 0.0).unwrap_or(1.0);
        let mut moments = vec![];
        let mut changes = 0.0;
        for (frame, row) in rows.iter().copied().enumerate() {
            let same = |at: usize| {
                self.numbers.iter().all(|(name, it)| COUNTS.contains(&name.as_str()) || it.get(at) == it.get(row))
            };
            changes += if frame > 0 && same(rows[frame - 1]) { 0.0 } else { 1.0 };
            match self.moment(row, frame, fps, features, in_degrees, changes) {
                Some(moment) => moments.push(moment),
                None => {
                    let message = format!("frame {frame} has a pose or a time that is not a number");
                    flags.push(Flag::damage("not-finite", &id, message));
                    break;
                }
            }
        }
        if let Some(frame) = (0..rows.len())
            .find(|frame| self.number("frame_index", rows[*frame]).is_some_and(|stated| stated as i64 != *frame as i64))
        {
            let stated = self.number("frame_index", rows[frame]).unwrap_or_default();
            let message =
                format!("row {frame} of the episode is called frame {stated}: rows are missing or out of order");
            flags.push(Flag::damage("index-mismatch", &id, message));
        }
        let digest = |frame: usize| {
            let name = features.pictures.first()?;
            self.pictures.get(name)?.get(*rows.get(frame)?).cloned()
        };
        let looks = stretch(moments.len())
            .filter_map(|frame| Some(ExaminedLook { frame, digest: digest(frame)?, ..ExaminedLook::default() }));
        let part = |parts: &Option<features::Parts<3>>| -> Vec<Option<[f64; 3]>> {
            let of = |row: &usize| parts.as_ref().and_then(|parts| parts.of(self.row(&parts.feature, *row)));
            rows.iter().map(of).collect()
        };
        RecordedActions {
            actions: part(&features.action),
            turns: part(&features.turn),
            expert: listed.experts.get(&number).cloned(),
            episode: ExaminedEpisode {
                split: split(info, number),
                group: id.clone(),
                is_perturbed: listed.experts.contains_key(&number),
                is_mount_unknown: true,
                target_height_m: 0.0,
                dt_s: 1.0 / fps,
                looks: looks.collect(),
                moments,
                id,
                ..ExaminedEpisode::default()
            },
        }
    }

    fn moment(
        &self,
        row: usize,
        frame: usize,
        fps: f64,
        features: &Features,
        in_degrees: bool,
        changes: f64,
    ) -> Option<ExaminedMoment> {
        let drone = match &features.position {
            Some(parts) => {
                let place = DVec3::from_array(parts.of(self.row(&parts.feature, row))?);
                let angles = features.angles.as_ref();
                let feature = match angles {
                    Some(features::Angles::Euler(parts)) => &parts.feature,
                    Some(features::Angles::Yaw(parts)) => &parts.feature,
                    Some(features::Angles::Quaternion(parts)) => &parts.feature,
                    None => "",
                };
                pose(place, angles, self.row(feature, row), in_degrees)?
            }
            None => NOWHERE,
        };
        // Without a pose, the camera counts changes of the numbers, so that repeated pictures show.
        let camera =
            if features.position.is_some() { drone } else { Pose { position_in_world: DVec3::X * changes, ..NOWHERE } };
        let of = |parts: &Option<features::Parts<3>>| {
            let parts = parts.as_ref()?;
            Some(DVec3::from_array(parts.of(self.row(&parts.feature, row))?))
        };
        let edges = features.edges.as_ref().and_then(|parts| parts.of(self.row(&parts.feature, row)));
        let time = self.row("timestamp", row).first().copied();
        Some(ExaminedMoment {
            time_s: time.unwrap_or(frame as f64 / fps),
            drone,
            camera,
            next_in_world: None,
            turn_deg: None,
            target_in_world: of(&features.target),
            heading_and_speed: None,
            in_image: None,
            visible_box: edges
                .filter(|[left, top, right, bottom]| right > left && bottom > top && *left >= 0.0 && *top >= 0.0),
            visible: None,
            clearance_m: None,
        })
    }

    fn are_degrees(&self, features: &Features) -> bool {
        let (feature, at): (&str, &[usize]) = match &features.angles {
            Some(features::Angles::Euler(parts)) => (&parts.feature, &parts.at),
            Some(features::Angles::Yaw(parts)) => (&parts.feature, &parts.at),
            _ => return false,
        };
        let rows = self.numbers.get(feature).into_iter().flatten();
        rows.flat_map(|row| at.iter().filter_map(|at| row.get(*at))).any(|angle| angle.abs() > MOST_RADIANS)
    }
}

/// The pose where none is stated.
const NOWHERE: Pose = Pose { position_in_world: DVec3::ZERO, pitch_rad: 0.0, yaw_rad: 0.0, roll_rad: 0.0 };

/// Columns of indices; all others are values of the frame.
const COUNTS: [&str; 4] = ["timestamp", "frame_index", "index", "next.done"];
