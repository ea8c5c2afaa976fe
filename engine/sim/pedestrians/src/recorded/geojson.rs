//! GeoJSON with times: line strings with one time per vertex (`coordTimes`, `times`, `coordinateProperties.times`), and
//! points with `time` or `timestamp` and an id.

use super::columns::shortened;
use super::unique::Unique;
use super::{RecordedError, RecordedPoint, RecordedTrack, Recording, instant};
use cosfly_diagnose::counted;
use cosfly_frames::DVec2;
use serde_json::Value;
use std::collections::BTreeMap;

/// Numbers above this are milliseconds since 1970, others seconds: as seconds it would be the year 5138.
const MILLISECONDS_FROM: f64 = 1e11;

pub(super) fn read(text: &str) -> Result<Recording, RecordedError> {
    let Unique(root) = serde_json::from_str(text).map_err(|error| {
        RecordedError::new(format!("broken JSON: {error}"))
            .at(error.line() as u32)
            .hint("the file may be cut off, and JSON knows no NaN: export the tracks as GeoJSON again")
    })?;
    check_reference(&root)?;
    let features: &[Value] = match root["type"].as_str() {
        Some("FeatureCollection") => root["features"].as_array().map(Vec::as_slice).unwrap_or_default(),
        Some("Feature") => std::slice::from_ref(&root),
        _ => {
            return Err(RecordedError::new("the JSON is neither a `FeatureCollection` nor a `Feature`")
                .hint("recorded people are read from GPX, GeoJSON, `obsmat` and CSV"));
        }
    };
    let mut recording = Recording { is_geographic: true, ..Recording::default() };
    let (mut untimed, mut other) = (0, 0);
    let mut of_points: BTreeMap<String, Vec<RecordedPoint>> = BTreeMap::new();
    for (number, feature) in features.iter().enumerate() {
        let (geometry, properties) = (&feature["geometry"], &feature["properties"]);
        let id = id_of(feature).unwrap_or_else(|| format!("feature {}", number + 1));
        let wrong = |message: String| {
            RecordedError::new(format!("`{id}`: {message}"))
                .hint("points have `time`; lines have one time per vertex in `coordTimes`, `times` or `coordinateProperties.times`")
        };
        match geometry["type"].as_str() {
            Some("Point") => match ["time", "timestamp", "t"].iter().find_map(|key| properties.get(*key)) {
                Some(time) => {
                    let point = point(&geometry["coordinates"], time).map_err(wrong)?;
                    of_points.entry(id).or_default().push(point);
                }
                None => untimed += 1,
            },
            Some(kind @ ("LineString" | "MultiLineString")) => {
                let Some(times) = times_of(properties) else {
                    untimed += 1;
                    continue;
                };
                let is_one = kind == "LineString";
                let parts: Vec<(&Value, &Value)> = match (is_one, geometry["coordinates"].as_array(), times.as_array())
                {
                    (true, ..) => vec![(&geometry["coordinates"], times)],
                    (false, Some(lines), Some(times)) if lines.len() == times.len() => {
                        lines.iter().zip(times).collect()
                    }
                    _ => return Err(wrong("its lines and its lists of times are not equally many".into())),
                };
                for (part, (line, times)) in parts.into_iter().enumerate() {
                    let id = if part == 0 { id.clone() } else { format!("{id} / {}", part + 1) };
                    recording.tracks.push(RecordedTrack { id, points: line_points(line, times).map_err(wrong)? });
                }
            }
            _ => other += 1,
        }
    }
    recording.tracks.extend(of_points.into_iter().map(|(id, points)| RecordedTrack { id, points }));
    if untimed > 0 {
        recording.warnings.push(format!("{untimed} features without times are left out"));
    }
    if other > 0 {
        recording.warnings.push(format!("{other} features that are neither points nor lines are left out"));
    }
    Ok(recording)
}

/// Refuses a file that states (as an older edition of the format allows) another system than longitude and latitude.
fn check_reference(root: &Value) -> Result<(), RecordedError> {
    let crs = &root["crs"];
    let name = crs["properties"]["name"].as_str().unwrap_or_default();
    let is_degrees = ["CRS84", "4326", "4979"].iter().any(|code| name.ends_with(code));
    if crs.is_null() || is_degrees {
        return Ok(());
    }
    let shown = if name.is_empty() { crs.to_string() } else { name.to_owned() };
    let message = format!("`crs` is `{}`; places must be longitudes and latitudes of WGS84", shortened(&shown));
    Err(RecordedError::new(message).hint("`ogr2ogr -t_srs EPSG:4326 NEW FILE` changes them"))
}

fn id_of(feature: &Value) -> Option<String> {
    let properties = &feature["properties"];
    let known = [&properties["id"], &feature["id"], &properties["name"], &properties["track"]];
    known.into_iter().find_map(|value| match value {
        Value::String(text) => Some(text.clone()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    })
}

fn times_of(properties: &Value) -> Option<&Value> {
    let nested = &properties["coordinateProperties"]["times"];
    let known = [&properties["coordTimes"], &properties["times"], nested];
    known.into_iter().find(|times| times.is_array())
}

fn line_points(line: &Value, times: &Value) -> Result<Vec<RecordedPoint>, String> {
    let (Some(line), Some(times)) = (line.as_array(), times.as_array()) else {
        return Err("its coordinates or its times are no list".into());
    };
    if line.len() != times.len() {
        return Err(format!("it has {} and {} times", counted(line.len(), "point"), times.len()));
    }
    line.iter().zip(times).map(|(place, time)| point(place, time)).collect()
}

fn point(place: &Value, time: &Value) -> Result<RecordedPoint, String> {
    let degrees = |axis: usize, most: f64| place[axis].as_f64().filter(|value| value.abs() <= most);
    let (Some(lon), Some(lat)) = (degrees(0, 180.0), degrees(1, 90.0)) else {
        return Err(format!("`{}` is no longitude and latitude in degrees", shortened(&place.to_string())));
    };
    let time_s = match time {
        Value::Number(number) => {
            number.as_f64().map(|time| if time.abs() > MILLISECONDS_FROM { 1e-3 * time } else { time })
        }
        Value::String(text) => instant::seconds(text),
        _ => None,
    };
    let time_s = time_s.ok_or_else(|| format!("`{}` is no time", shortened(&time.to_string())))?;
    Ok(RecordedPoint { time_s, at: DVec2::new(lon, lat), line: 0 })
}
