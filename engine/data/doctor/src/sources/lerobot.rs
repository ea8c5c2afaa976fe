//! LeRobot datasets (v3.0, and v2 where its tables are alike): `meta/info.json`, tables of frames, pictures or videos.
//!
//! * [`features`]: meanings of their numbers.
//! * [`actions`]: meaning of their actions, found by trials.
//! * [`video`]: video files, undecoded.

pub mod actions;
pub mod features;
pub mod video;

use super::stretch;
use crate::files::files_below;
use crate::{ExaminedEpisode, ExaminedLook, ExaminedMoment, Flag};
use actions::Recording;
use cosfly_diagnose::{Fault, Result, Stop, plausible};
use cosfly_frames::{DVec3, Pose};
use cosfly_read::{ForeignRows, foreign_rows, inner_path, parquet_problem};
use features::{Features, pose};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Size of the largest `info.json` that is read, bytes.
const INFO_LIMIT: u64 = 1 << 26;
/// Largest angle in radians; larger values are degrees.
const MOST_RADIANS: f64 = 6.4;
/// Number of flags of one kind that are listed.
const NAMED: usize = 20;

/// Whether `folder` has this layout.
pub fn recognises(folder: &Path) -> bool {
    folder.join("meta/info.json").is_file()
}

/// Episodes, faults of the files, and impossible checks as texts.
pub type Read = (Vec<ExaminedEpisode>, Vec<Flag>, Vec<String>);

/// Reads all episodes, and every file to its end.
///
/// # Errors
/// Refusals of the machine where a folder cannot be listed.
pub fn episodes(folder: &Path, progress: &mut dyn FnMut(u64, u64)) -> Result<Read> {
    read(folder, true, progress)
}

/// Reads the numbers of all episodes; pictures and videos are not looked at.
///
/// # Errors
/// As of [`episodes`].
pub fn motions(folder: &Path) -> Result<Read> {
    read(folder, false, &mut |_, _| {})
}

fn read(folder: &Path, with_pictures: bool, progress: &mut dyn FnMut(u64, u64)) -> Result<Read> {
    let info = match info(folder) {
        Ok(info) => info,
        Err(problem) => {
            return Ok((vec![], vec![Flag::damage("json-damaged", "meta/info.json", problem)], vec![]));
        }
    };
    let features = Features::of(&info["features"]);
    let (mut flags, mut notes) = (vec![], vec![]);
    let mut files: Vec<PathBuf> = vec![];
    for path in tables(folder)? {
        match with_pictures.then(|| parquet_problem(&path, &Stop::default())).flatten() {
            Some(problem) => flags.push(Flag::damage("parquet-damaged", shown(folder, &path), problem)),
            None => files.push(path),
        }
    }
    let (mut frames, mut listed) = (Frames::default(), Listed::default());
    for (done, path) in files.iter().enumerate() {
        progress(done as u64, files.len() as u64);
        let inside = path.strip_prefix(folder).unwrap_or(path);
        let (is_data, is_list) = (inside.starts_with("data"), inside.starts_with("meta/episodes"));
        if !(is_data || is_list) {
            continue;
        }
        match foreign_rows(path, with_pictures) {
            Ok(rows) if is_data => frames.append(rows),
            Ok(rows) => listed.append(&rows),
            Err(refusal) if refusal.fault == Fault::Machine => return Err(refusal),
            Err(refusal) => {
                let problem = [vec![refusal.message], refusal.causes].concat().join(": ");
                flags.push(Flag::damage("parquet-damaged", shown(folder, path), problem));
            }
        }
    }
    let is_whole = flags.is_empty();
    let mut recordings = frames.recordings(&features, &info, &listed, &mut flags);
    if is_whole {
        listed.check(&info, &recordings, frames.rows, &mut flags);
    }
    if with_pictures {
        listed.check_videos(folder, &info, &features, &mut flags);
    }
    notes.extend(gaps(&features));
    actions::interpret(&mut recordings, &features, &mut notes);
    Ok((recordings.into_iter().map(|it| it.episode).collect(), flags, notes))
}

/// Tables in and below the folder, sorted.
///
/// # Errors
/// Refusals of the machine.
pub fn tables(folder: &Path) -> Result<Vec<PathBuf>> {
    let files = files_below(folder)?.into_iter();
    Ok(files.filter(|path| path.extension().is_some_and(|it| it == "parquet")).collect())
}

fn shown(folder: &Path, path: &Path) -> String {
    path.strip_prefix(folder).unwrap_or(path).display().to_string()
}

/// The contents of `meta/info.json`.
///
/// # Errors
/// The reason, in words.
pub fn info(folder: &Path) -> Result<Value, String> {
    let path = folder.join("meta/info.json");
    let size = std::fs::metadata(&path).map_err(|error| error.to_string())?.len();
    if size > INFO_LIMIT {
        return Err(format!("it has {size} bytes"));
    }
    let bytes = std::fs::read(path).map_err(|error| format!("it cannot be read: {error}"))?;
    let info: Value = serde_json::from_slice(&bytes).map_err(|error| format!("not JSON: {error}"))?;
    if info["features"].is_object() { Ok(info) } else { Err("it has no `features`".into()) }
}

/// Checks that are impossible because a feature is absent.
fn gaps(features: &Features) -> Vec<String> {
    let mut notes = vec![];
    if features.position.is_none() {
        notes.push("poses, speeds and actions: no feature names x, y and z of the drone".to_owned());
    } else if features.angles.is_none() {
        notes.push("angles: no feature names yaw or a quaternion".to_owned());
    }
    if features.target.is_none() {
        notes.push("the sign of yaw and leaks of walks: no feature is the target's place".to_owned());
    }
    if !features.videos.is_empty() {
        notes.push(format!(
            "repeated pictures in {}: video is not decoded (its files and their lengths are checked)",
            features.videos.join(", ")
        ));
    } else if features.pictures.is_empty() {
        notes.push("pictures: there are none".to_owned());
    }
    notes.push("depth, clearance and the share that is visible: LeRobot has no features for them".to_owned());
    notes
}

/// All rows of all tables of frames, in the order of the files.
#[derive(Default)]
struct Frames {
    numbers: BTreeMap<String, Vec<Vec<f64>>>,
    pictures: BTreeMap<String, Vec<String>>,
    rows: usize,
}

impl Frames {
    fn append(&mut self, rows: ForeignRows) {
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
    fn of_episodes(&self) -> BTreeMap<i64, Vec<usize>> {
        let mut episodes: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
        for row in 0..self.rows {
            let number = self.number("episode_index", row).unwrap_or(0.0) as i64;
            episodes.entry(number).or_default().push(row);
        }
        episodes
    }

    fn recordings(&self, features: &Features, info: &Value, listed: &Listed, flags: &mut Vec<Flag>) -> Vec<Recording> {
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
    ) -> Recording {
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
        Recording {
            actions: part(&features.action),
            turns: part(&features.turn),
            expert: listed.experts.get(&number).cloned(),
            episode: ExaminedEpisode {
                split: split(info, number),
                group: id.clone(),
                is_perturbed: listed.experts.contains_key(&number),
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

fn split(info: &Value, number: i64) -> Option<String> {
    let splits = info["splits"].as_object()?;
    let holds = |range: &Value| {
        let (from, to) = range.as_str()?.split_once(':')?;
        Some(number >= from.trim().parse().ok()? && number < to.trim().parse().ok()?)
    };
    splits.iter().find(|(_, range)| holds(range) == Some(true)).map(|(name, _)| name.clone())
}

/// The rows of `meta/episodes`.
#[derive(Default)]
struct Listed {
    rows: Vec<(i64, BTreeMap<String, f64>)>,
    names: BTreeMap<i64, String>,
    experts: BTreeMap<i64, String>,
}

impl Listed {
    fn append(&mut self, rows: &ForeignRows) {
        for row in 0..rows.rows {
            let number = |name: &String| Some((name.clone(), rows.numbers[name].get(row)?.first().copied()?));
            let numbers: BTreeMap<String, f64> = rows.numbers.keys().filter_map(number).collect();
            let Some(episode) = numbers.get("episode_index").map(|it| *it as i64) else { continue };
            let text = |name: &str| rows.texts.get(name)?.get(row).filter(|text| !text.is_empty()).cloned();
            self.names.extend(text("trajectory_id").map(|name| (episode, name)));
            self.experts.extend(text("expert_id").map(|name| (episode, name)));
            self.rows.push((episode, numbers));
        }
    }

    fn name(&self, episode: i64) -> String {
        self.names.get(&episode).cloned().unwrap_or_else(|| format!("episode {episode}"))
    }

    /// Whether the counts agree with the frames.
    fn check(&self, info: &Value, recordings: &[Recording], rows: usize, flags: &mut Vec<Flag>) {
        let mut flag = |place: &str, message: String| flags.push(Flag::damage("index-mismatch", place, message));
        for (key, found) in [("total_frames", rows), ("total_episodes", recordings.len())] {
            if let Some(stated) = info[key].as_u64().filter(|stated| *stated != found as u64) {
                flag("meta/info.json", format!("`{key}` is {stated}; the tables have {found}"));
            }
        }
        let lengths: BTreeMap<&str, usize> =
            recordings.iter().map(|it| (it.episode.id.as_str(), it.actions.len())).collect();
        for (episode, numbers) in &self.rows {
            let name = self.name(*episode);
            let found = lengths.get(name.as_str()).copied().unwrap_or(0);
            if let Some(stated) = numbers.get("length").filter(|stated| **stated != found as f64) {
                flag(&name, format!("its `length` is {stated}; the tables have {found} frames of it"));
            }
        }
    }

    /// Checks that all videos exist, are whole and long enough.
    fn check_videos(&self, folder: &Path, info: &Value, features: &Features, flags: &mut Vec<Flag>) {
        let Some(pattern) = info["video_path"].as_str() else { return };
        let fps = info["fps"].as_f64().filter(|fps| *fps > 0.0).unwrap_or(1.0);
        let mut lengths: BTreeMap<String, Option<f64>> = BTreeMap::new();
        let mut problems = vec![];
        for (episode, numbers) in &self.rows {
            for key in &features.videos {
                let Some(path) = video_path(pattern, key, *episode, numbers, info) else { continue };
                let Some(file) = inner_path(folder, &path) else {
                    let outside = "it leads out of the dataset and is not opened".to_owned();
                    if lengths.insert(path.clone(), None).is_none() {
                        problems.push((path, outside));
                    }
                    continue;
                };
                let length = lengths.entry(path.clone()).or_insert_with(|| {
                    let found = if file.is_file() { video::seconds(&file) } else { Err("it is not there".into()) };
                    found.map_err(|problem| problems.push((path.clone(), problem))).ok()
                });
                let stated = numbers.get(&format!("videos/{key}/to_timestamp"));
                let stated = stated.copied().or(numbers.get("length").map(|frames| frames / fps));
                if let (Some(length), Some(stated)) = (*length, stated)
                    && stated > length + 1.5 / fps
                {
                    let message = format!("its video `{path}` has {length:.2} s; {stated:.2} are stated");
                    flags.push(Flag::damage("video-length", self.name(*episode), message));
                }
            }
        }
        for (place, problem) in problems.into_iter().take(NAMED) {
            let name = if problem == "it is not there" { "video-missing" } else { "video-damaged" };
            flags.push(Flag::damage(name, place, problem));
        }
    }
}

/// A path of Python's format, such as `videos/{video_key}/chunk-{chunk_index:03d}/file-{file_index:03d}.mp4`; `None` when it
/// needs an unknown number.
fn video_path(pattern: &str, key: &str, episode: i64, numbers: &BTreeMap<String, f64>, info: &Value) -> Option<String> {
    let mut text = String::new();
    let mut rest = pattern;
    while let Some((before, after)) = rest.split_once('{') {
        let (field, behind) = after.split_once('}')?;
        text.push_str(before);
        let (name, width) = field.split_once(':').unwrap_or((field, ""));
        let width: usize = width.trim_end_matches('d').trim_start_matches('0').parse().unwrap_or(1);
        if name == "video_key" {
            text.push_str(key);
        } else {
            let chunks = info["chunks_size"].as_i64().filter(|size| *size > 0).unwrap_or(1000);
            let number = match name {
                "episode_index" => episode,
                "episode_chunk" => episode / chunks,
                _ => *numbers.get(&format!("videos/{key}/{name}"))? as i64,
            };
            text.push_str(&format!("{number:0width$}", width = width.min(20)));
        }
        rest = behind;
    }
    text.push_str(rest);
    Some(text)
}
