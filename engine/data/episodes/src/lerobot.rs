//! LeRobot datasets (v3.0, and v2 where its tables are alike): `meta/info.json`, tables of frames, pictures or videos.
//!
//! * [`info`] reads `meta/info.json`.
//! * [`features`]: meanings of their numbers.
//! * [`listed`]: the rows of `meta/episodes`.
//! * [`frames`]: the tables of frames.
//! * [`actions`]: meaning of their actions, found by trials.
//! * [`depth`]: depth at the target, where a feature is depth in metres.
//! * [`video`]: video files, undecoded.

pub mod actions;
mod depth;
pub mod features;
mod frames;
mod info;
mod listed;
pub mod video;

use crate::files::files_below;
use crate::whole_files::parquet_problem;
use crate::{ExaminedEpisode, Flag};
use cosfly_diagnose::{Fault, Result, Stop};
use cosfly_read::foreign_rows;
use cosfly_schema::Split;
use features::Features;
use frames::Frames;
use listed::Listed;
use std::path::{Path, PathBuf};

pub use info::info;

/// The datasets in `folder`: itself, or those of its splits, as `cosfly export` writes them; none of another layout.
pub fn roots(folder: &Path) -> Vec<PathBuf> {
    if recognises(folder) {
        return vec![folder.to_owned()];
    }
    let mut found: Vec<PathBuf> = Split::ALL.iter().map(|split| folder.join(split.name())).collect();
    found.retain(|path| recognises(path));
    found
}

/// Whether `folder` is such a dataset.
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

/// Like [`episodes`], of the datasets of the splits `roots` in a folder: ids and places begin with the name of the split.
///
/// # Errors
/// Those of [`episodes`].
pub fn episodes_of_splits(roots: &[PathBuf], progress: &mut dyn FnMut(u64, u64)) -> Result<Read> {
    let (mut episodes, mut flags, mut notes) = (vec![], vec![], vec![]);
    for root in roots {
        let split = root.file_name().unwrap_or_default().to_string_lossy();
        let (found, own_flags, own_notes) = read(root, true, progress)?;
        episodes.extend(found.into_iter().map(|episode| ExaminedEpisode {
            id: format!("{split}/{}", episode.id),
            group: format!("{split}/{}", episode.group),
            split: Some(split.clone().into_owned()),
            ..episode
        }));
        flags.extend(own_flags.into_iter().map(|flag| Flag { place: format!("{split}/{}", flag.place), ..flag }));
        notes.extend(own_notes);
    }
    notes.sort();
    notes.dedup();
    Ok((episodes, flags, notes))
}

/// Reads the numbers of all episodes; pictures and videos are not looked at.
///
/// # Errors
/// Those of [`episodes`].
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
            Ok(rows) if is_data => frames.append(path, rows),
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
    if let Some(feature) = features.depth.as_deref().filter(|_| with_pictures) {
        let has_places = features.position.is_some() && features.target.is_some();
        depth::look((folder, feature), &frames, has_places, &mut recordings, &mut flags);
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
    let has_places = features.position.is_some() && features.target.is_some() && features.edges.is_some();
    notes.push(match (&features.depth, features.other_depth.first()) {
        (Some(_), _) if has_places => {
            "depth: its files and unit are checked; its values and frames are not, since no feature is the place of the camera"
                .to_owned()
        }
        (Some(_), _) => "depth: its files are checked; its unit needs features of the drone's place, the target's and its box"
            .to_owned(),
        (None, Some(name)) => format!("depth: `{name}` is not said to be pictures in metres, so it is not read"),
        (None, None) => "depth: no feature is marked as it (`is_depth_map`)".to_owned(),
    });
    notes.push("clearance and the share that is visible: LeRobot has no features for them".to_owned());
    notes.push("instructions: tasks are not compared with the flights".to_owned());
    notes
}
