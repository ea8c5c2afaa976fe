//! [`Listed`]: the rows of `meta/episodes`, and the videos that they name.

use super::actions::RecordedActions;
use super::features::Features;
use super::video;
use crate::Flag;
use cosfly_diagnose::counted;
use cosfly_read::{ForeignRows, inner_path};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// Number of flags of one kind that are listed.
const NAMED: usize = 20;

/// The rows of `meta/episodes`.
#[derive(Default)]
pub struct Listed {
    rows: Vec<(i64, BTreeMap<String, f64>)>,
    names: BTreeMap<i64, String>,
    /// Ids of the experts of perturbed episodes, by number.
    pub experts: BTreeMap<i64, String>,
}

impl Listed {
    /// Adds the rows of a table.
    pub fn append(&mut self, rows: &ForeignRows) {
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

    /// Name of an episode.
    pub fn name(&self, episode: i64) -> String {
        self.names.get(&episode).cloned().unwrap_or_else(|| format!("episode {episode}"))
    }

    /// Whether the counts agree with the frames.
    pub fn check(&self, info: &Value, recordings: &[RecordedActions], rows: usize, flags: &mut Vec<Flag>) {
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
                flag(
                    &name,
                    format!("its `length` is {stated}; the tables have {found} of it", found = counted(found, "frame")),
                );
            }
        }
    }

    /// Checks that all videos exist, are whole and long enough.
    pub fn check_videos(&self, folder: &Path, info: &Value, features: &Features, flags: &mut Vec<Flag>) {
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
