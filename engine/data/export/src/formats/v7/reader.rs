//! A strict reader of the layout: checks all rules of the release that are known, and names each breach.

use super::document::{FRAMES_DIR, SCHEMA, SCHEMA_VERSION};
use super::names::is_town;
use crate::pixels::decode_png;
use cosfly_diagnose::{Diagnostic, Result};
use rayon::prelude::*;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// Largest distance of a waypoint from the next pose, metres.
const WAYPOINT_TOLERANCE_M: f64 = 1e-5;

/// Result of reading a `data_v7` folder.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// Number of pairs.
    pub pairs: usize,
    /// Number of frames of all traces.
    pub frames: usize,
    /// Breaches of rules, with their places.
    pub problems: Vec<String>,
}

/// Reads everything below `root`, whose folders are towns.
///
/// # Errors
/// Refusals of the machine where a folder cannot be listed; everything else is a problem of the reading.
pub fn read(root: &Path) -> Result<Reading> {
    let mut reading = Reading::default();
    for town in entries(root)? {
        if !is_town(&name_of(&town)) {
            reading.problems.push(format!("`{}` is not a town of the release", name_of(&town)));
        }
        for pair in entries(&town)? {
            if !name_of(&pair).starts_with("trajectory_") {
                reading.problems.push(format!("{}: not a trajectory folder", pair.display()));
                continue;
            }
            reading.pairs += 1;
            read_pair(&pair, &mut reading)?;
        }
    }
    Ok(reading)
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>> {
    let listed =
        fs::read_dir(folder).and_then(|entries| entries.map(|entry| entry.map(|entry| entry.path())).collect());
    let mut entries: Vec<PathBuf> =
        listed.map_err(|error| Diagnostic::io(format!("read `{}`", folder.display()), &error))?;
    entries.sort();
    Ok(entries)
}

fn name_of(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

fn read_pair(pair: &Path, reading: &mut Reading) -> Result<()> {
    let mut first: Option<(Vec<Value>, usize)> = None;
    let mut traces = entries(pair)?;
    traces.sort_by_key(|trace| name_of(trace) != "ORI");
    for required in ["ORI", "aug_001"] {
        if !pair.join(required).join("trajectory.json").is_file() {
            reading.problems.push(format!("{}: `{required}` has no `trajectory.json`", pair.display()));
        }
    }
    for trace in traces {
        let place = trace.display().to_string();
        let document = fs::read(trace.join("trajectory.json")).map_err(|error| error.to_string());
        let document = document.and_then(|bytes| serde_json::from_slice(&bytes).map_err(|error| error.to_string()));
        let document: Value = match document {
            Ok(document) => document,
            Err(error) => {
                reading.problems.push(format!("{place}/trajectory.json: {error}"));
                continue;
            }
        };
        let mut problems = check_document(&document, &name_of(&trace));
        let count = document["points"].as_array().map_or(0, Vec::len);
        reading.frames += count;
        let source = ["path_index", "scenario_id", "scenario_name"].map(|key| document["source"][key].clone()).to_vec();
        match &first {
            None => first = Some((source, count)),
            Some(first) if *first != (source, count) => {
                problems.push("source or number of points is not that of `ORI`".into());
            }
            Some(_) => {}
        }
        let size = [&document["camera"]["width"], &document["camera"]["height"]].map(Value::as_u64);
        let pictures: Vec<Option<String>> =
            (0..count).into_par_iter().map(|index| check_picture(&trace, index, size).err()).collect();
        problems.extend(pictures.into_iter().flatten());
        reading.problems.extend(problems.into_iter().map(|problem| format!("{place}: {problem}")));
    }
    Ok(())
}

fn check_picture(trace: &Path, index: usize, size: [Option<u64>; 2]) -> Result<(), String> {
    let path = trace.join(FRAMES_DIR).join(format!("frame_{index:05}")).join("rgb.png");
    let file = fs::read(path).map_err(|error| format!("frame {index}: rgb.png: {error}"))?;
    let (_, found) = decode_png(&file).map_err(|error| format!("frame {index}: rgb.png: {error}"))?;
    let is_right = found.map(|side| Some(u64::from(side))) == size;
    if is_right { Ok(()) } else { Err(format!("frame {index}: rgb.png has {found:?} pixels, not those of `camera`")) }
}

/// Breaches of rules in a `trajectory.json` in the folder `trace`.
pub fn check_document(document: &Value, trace: &str) -> Vec<String> {
    let mut problems = vec![];
    for (key, wanted) in [("schema", SCHEMA), ("schema_version", SCHEMA_VERSION), ("trace_dir", trace)] {
        if document[key] != *wanted {
            problems.push(format!("`{key}` is {}, not \"{wanted}\"", document[key]));
        }
    }
    let intrinsic = &document["camera"]["intrinsic"];
    let is_matrix = intrinsic.as_array().is_some_and(|rows| rows.len() == 3 && rows.iter().all(|row| numbers(row, 3)));
    if !(intrinsic.is_null() || is_matrix) {
        problems.push("`camera.intrinsic` is not a 3 x 3 matrix".into());
    }
    let points = document["points"].as_array().map_or(&[][..], |points| &points[..]);
    if points.is_empty() {
        problems.push("`points` is empty".into());
    }
    let again = document["waypoints"].as_array().map_or(&[][..], |waypoints| &waypoints[..]);
    let same = |(point, waypoint): (&Value, &Value)| {
        ["index", "timing", "drone_pose"].iter().all(|key| point[key] == waypoint[key])
    };
    if again.len() != points.len() || !points.iter().zip(again).all(same) {
        problems.push("`waypoints` are not index, timing and pose of `points`".into());
    }
    for (index, point) in points.iter().enumerate() {
        let before = index.checked_sub(1).map(|before| &points[before]);
        if let Err(problem) = check_point(point, index, before, points.get(index + 1)) {
            problems.push(format!("point {index}: {problem}"));
        }
    }
    problems
}

/// Whether `value` has exactly `count` numbers.
fn numbers(value: &Value, count: usize) -> bool {
    value.as_array().is_some_and(|values| values.len() == count && values.iter().all(Value::is_number))
}

fn check_point(point: &Value, index: usize, before: Option<&Value>, next: Option<&Value>) -> Result<(), String> {
    if point["index"].as_u64() != Some(index as u64) {
        return Err(format!("`index` is {}", point["index"]));
    }
    let time = |point: &Value| point["timing"]["trace_timestamp"].as_f64();
    let time_s = time(point).ok_or("`trace_timestamp` is not a number")?;
    if before.is_none() && time_s != 0.0 {
        return Err("`trace_timestamp` does not begin at 0".into());
    }
    if before.and_then(time).is_some_and(|before_s| before_s >= time_s) {
        return Err("`trace_timestamp` does not increase".into());
    }
    if point["timing"]["timestamp"] != point["timing"]["trace_timestamp"] {
        return Err("`timestamp` is not `trace_timestamp`".into());
    }
    for key in ["x", "y", "z", "yaw"] {
        point["drone_pose"][key].as_f64().ok_or_else(|| format!("`drone_pose.{key}` is not a number"))?;
    }
    let waypoint = &point["nav_waypoint"]["t1_world"];
    match next {
        None if !waypoint.is_null() => return Err("the last `t1_world` is not null".into()),
        None => {}
        Some(next) => {
            for axis in ["x", "y", "z"] {
                let gap = waypoint[axis].as_f64().zip(next["drone_pose"][axis].as_f64()).map(|(a, b)| (a - b).abs());
                if gap.is_none_or(|gap| gap > WAYPOINT_TOLERANCE_M) {
                    return Err("`t1_world` is not the next pose".into());
                }
            }
        }
    }
    let target = &point["target"];
    let uv = &target["image_uv"];
    if !(uv.is_null() || numbers(uv, 2)) {
        return Err("`image_uv` has not two numbers".into());
    }
    let edges = &target["bbox_2d"];
    if !(edges.is_null() || ["xmin", "ymin", "xmax", "ymax"].iter().all(|key| edges[key].is_number())) {
        return Err("`bbox_2d` lacks an edge".into());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn document() -> Value {
        let point = |index: usize| {
            let next = if index < 2 { json!({"x": index + 1, "y": 0, "z": 9.5}) } else { Value::Null };
            json!({
                "index": index,
                "timing": {"trace_timestamp": 0.5 * index as f64, "timestamp": 0.5 * index as f64},
                "drone_pose": {"x": index, "y": 0, "z": 9.5, "yaw": 3.0},
                "nav_waypoint": {"t1_world": next},
                "target": {"image_uv": [1, 2], "bbox_2d": null},
            })
        };
        json!({
            "schema": SCHEMA, "schema_version": SCHEMA_VERSION, "trace_dir": "ORI",
            "camera": {"width": 4, "height": 3, "intrinsic": [[1, 0, 2], [0, 1, 1.5], [0, 0, 1]]},
            "points": [point(0), point(1), point(2)],
            "waypoints": [point(0), point(1), point(2)],
        })
    }

    #[test]
    fn every_breach_of_a_rule_is_named() {
        assert_eq!(check_document(&document(), "ORI"), Vec::<String>::new());
        let breaches: [(&str, Value, &str); 13] = [
            ("/schema_version", json!("7.0.1"), "schema_version"),
            ("/trace_dir", json!("aug_001"), "trace_dir"),
            ("/points", json!([]), "empty"),
            ("/waypoints/1/drone_pose/x", json!(9), "`waypoints`"),
            ("/points/1/timing/timestamp", json!(9), "`timestamp`"),
            ("/camera/intrinsic", json!([[1, 0], [0, 1]]), "3 x 3"),
            ("/points/1/index", json!(7), "index"),
            ("/points/1/timing/trace_timestamp", json!(0.0), "increase"),
            ("/points/0/timing/trace_timestamp", json!(0.25), "begin at 0"),
            ("/points/1/drone_pose/yaw", Value::Null, "yaw"),
            ("/points/0/nav_waypoint/t1_world/x", json!(1.001), "next pose"),
            ("/points/2/nav_waypoint/t1_world", json!({"x": 0, "y": 0, "z": 0}), "not null"),
            ("/points/0/target/bbox_2d", json!({"xmin": 0}), "bbox_2d"),
        ];
        for (pointer, value, word) in breaches {
            let mut broken = document();
            *broken.pointer_mut(pointer).unwrap() = value;
            let problems = check_document(&broken, "ORI");
            assert!(problems.iter().any(|problem| problem.contains(word)), "{pointer}: {problems:?}");
        }
    }
}
