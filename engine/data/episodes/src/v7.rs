//! The layout of the published CosFly-Track data: `<Town>/trajectory_<id>/<trace>/trajectory.json` with a folder per frame.

use crate::episode::{OFFSETS, depth_in_box, stretch};
use crate::{ExaminedEpisode, ExaminedLook, ExaminedMoment, Flag};
use cosfly_diagnose::{Diagnostic, Result, plausible};
use cosfly_domain::Camera;
use cosfly_fingerprint::Digest;
use cosfly_frames::{DVec3, Pose};
use cosfly_images::read::{decoded, png_size};
use cosfly_metrics::drawn_ground::DrawnGround;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// Height of a body where it is not stated, metres.
const BODY_M: f64 = 1.8;
/// Size of the largest `trajectory.json` that is read, bytes.
const JSON_LIMIT: u64 = 1 << 30;
/// Depth that stands for the sky, metres.
const SKY_M: f32 = 999.0;

/// The folder of towns in or below `folder`, where it has this layout.
pub fn root(folder: &Path) -> Option<PathBuf> {
    let has_towns = |path: &PathBuf| {
        listed(path).is_ok_and(|entries| entries.iter().any(|town| town.is_dir() && !traces(town).is_empty()))
    };
    [folder.to_owned(), folder.join("data_v7")].into_iter().find(has_towns)
}

fn listed(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut entries =
        fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path())).collect::<std::io::Result<Vec<_>>>()?;
    entries.sort();
    Ok(entries)
}

fn name(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

/// Folders with a `trajectory.json` below a town.
fn traces(town: &Path) -> Vec<PathBuf> {
    let pairs = listed(town).unwrap_or_default().into_iter().filter(|pair| name(pair).starts_with("trajectory_"));
    let traces = pairs.flat_map(|pair| listed(&pair).unwrap_or_default());
    traces.filter(|trace| trace.join("trajectory.json").is_file()).collect()
}

/// Reads all traces below `root`; returns the episodes and the faults of their files.
///
/// # Errors
/// Refusals of the machine where a folder cannot be listed.
pub fn episodes(
    root: &Path,
    visit: &mut dyn FnMut(ExaminedEpisode),
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Vec<Flag>> {
    read(root, true, visit, progress)
}

/// Reads the documents of all traces; pictures are not looked at.
///
/// # Errors
/// Those of [`episodes`].
pub fn motions(root: &Path) -> Result<(Vec<ExaminedEpisode>, Vec<Flag>)> {
    let mut episodes = vec![];
    let flags = read(root, false, &mut |episode| episodes.push(episode), &mut |_, _| {})?;
    Ok((episodes, flags))
}

fn read(
    root: &Path,
    with_pictures: bool,
    visit: &mut dyn FnMut(ExaminedEpisode),
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Vec<Flag>> {
    let towns = listed(root).map_err(|error| Diagnostic::io(format!("read `{}`", root.display()), &error))?;
    let traces: Vec<PathBuf> = towns.iter().filter(|it| it.is_dir()).flat_map(|town| traces(town)).collect();
    let mut flags = vec![];
    for (done, trace) in traces.iter().enumerate() {
        progress(done as u64, traces.len() as u64);
        let id = trace.strip_prefix(root).unwrap_or(trace).display().to_string();
        match document(trace).and_then(|document| episode(&id, &document)) {
            Ok(mut episode) => {
                if with_pictures {
                    looks(trace, &mut episode, &mut flags);
                }
                visit(episode);
            }
            Err(problem) => flags.push(Flag::damage("json-damaged", format!("{id}/trajectory.json"), problem)),
        }
    }
    Ok(flags)
}

fn document(trace: &Path) -> Result<Value, String> {
    let path = trace.join("trajectory.json");
    let size = fs::metadata(&path).map_err(|error| error.to_string())?.len();
    if size > JSON_LIMIT {
        return Err(format!("it has {size} bytes"));
    }
    let bytes = fs::read(path).map_err(|error| format!("it cannot be read: {error}"))?;
    serde_json::from_slice(&bytes).map_err(|error| format!("not JSON: {error}"))
}

fn episode(id: &str, document: &Value) -> Result<ExaminedEpisode, String> {
    let points = document["points"].as_array().filter(|points| !points.is_empty()).ok_or("it has no points")?;
    let own = &document["cosfly"];
    let target_height_m = number(&own["target"]["height_m"]).unwrap_or(BODY_M);
    let moments = points
        .iter()
        .enumerate()
        .map(|(index, point)| {
            moment(point).ok_or_else(|| format!("point {index} has a pose or a time that is no number up to 1e9"))
        })
        .collect::<Result<Vec<ExaminedMoment>, String>>()?;
    let mut steps: Vec<f64> = moments.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).collect();
    steps.sort_by(f64::total_cmp);
    let (town, source) = (id.split('/').next().unwrap_or_default(), &document["source"]);
    let captions = own["captions"].as_array().into_iter().flatten();
    let text = |it: &Value, key: &str| it[key].as_str().unwrap_or_default().to_owned();
    Ok(ExaminedEpisode {
        id: id.to_owned(),
        split: own["split"].as_str().map(str::to_owned),
        group: format!("{}/{}/{}", source["path_index"], source["scenario_id"], source["scenario_name"]),
        town: town.to_owned(),
        place: town.trim_end_matches("_Opt").to_owned(),
        is_perturbed: !id.ends_with("/ORI"),
        camera: camera(&document["camera"]).filter(|_| own["lens"].is_null()),
        depth_is_along_rays: own["lens"]["depth_is_along_rays"].as_bool().unwrap_or_default(),
        target_height_m,
        dt_s: steps.get(steps.len() / 2).copied().unwrap_or(0.5),
        captions: captions.map(|it| (text(it, "language"), text(it, "text"))).collect(),
        moments,
        ..ExaminedEpisode::default()
    })
}

fn camera(camera: &Value) -> Option<Camera> {
    let side = |key: &str| camera[key].as_u64().and_then(|side| u32::try_from(side).ok()).filter(|side| *side > 0);
    let (width, height) = (side("width")?, side("height")?);
    let focal_px = camera["intrinsic"][0][0].as_f64().or(camera["focal_length_px"].as_f64())?;
    let half = 0.5 * f64::from(width) / focal_px;
    (half.is_finite() && half > 0.0).then(|| Camera {
        width,
        height,
        horizontal_fov_rad: 2.0 * cosfly_frames::real::atan2(half, 1.0),
    })
}

/// A number that a measurement can have.
fn number(value: &Value) -> Option<f64> {
    value.as_f64().filter(|number| plausible(*number).is_ok())
}

fn place(value: &Value) -> Option<DVec3> {
    Some(DVec3::new(number(&value["x"])?, number(&value["y"])?, number(&value["z"])?))
}

fn pose(value: &Value) -> Option<Pose> {
    let angle = |key: &str| number(&value[key]).unwrap_or_default().to_radians();
    number(&value["yaw"])?;
    Some(Pose {
        position_in_world: place(value)?,
        pitch_rad: angle("pitch"),
        yaw_rad: angle("yaw"),
        roll_rad: angle("roll"),
    })
}

fn moment(point: &Value) -> Option<ExaminedMoment> {
    let (target, own) = (&point["target"], &point["cosfly"]);
    let drone = pose(&point["drone_pose"])?;
    let edges = |value: &Value| {
        let edge = |key: &str| number(&value[key]);
        Some([edge("xmin")?, edge("ymin")?, edge("xmax")?, edge("ymax")?])
    };
    let visible_box = edges(&target["bbox_2d"]);
    let shown = edges(&own["full_bbox_2d"]).or(visible_box);
    let uv = number(&target["image_uv"][0]).zip(number(&target["image_uv"][1]));
    let flag = |value: &Value| value.as_bool().map(|seen| f64::from(u8::from(seen)));
    Some(ExaminedMoment {
        time_s: number(&point["timing"]["trace_timestamp"])?,
        drone,
        camera: pose(&own["camera_pose"]).unwrap_or(drone),
        next_in_world: place(&point["nav_waypoint"]["t1_world"]),
        turn_deg: None,
        target_in_world: place(&target["world_location"]),
        heading_and_speed: number(&own["target_heading_deg"])
            .map(f64::to_radians)
            .zip(number(&own["target_speed_mps"])),
        in_image: match (shown, uv) {
            (Some([left, top, right, bottom]), _) => Some((0.5 * (left + right), 0.5 * (top + bottom), bottom - top)),
            (None, Some((u, v))) => Some((u, v, 0.0)),
            _ => None,
        },
        visible_box,
        visible: number(&own["visible_by_pixels"]).or(flag(&target["visible"])),
        clearance_m: number(&own["clearance_m"]),
    })
}

/// Pictures of a stretch of frames.
fn looks(trace: &Path, episode: &mut ExaminedEpisode, flags: &mut Vec<Flag>) {
    for frame in stretch(episode.moments.len()) {
        let folder = frame_folder(trace, frame);
        let Ok(colour) = fs::read(folder.join("rgb.png")) else {
            flags.push(Flag::damage("picture-missing", &episode.id, format!("frame {frame} has no `rgb.png`")));
            return;
        };
        let mut look = ExaminedLook { frame, digest: Digest::of(&colour).to_string(), ..ExaminedLook::default() };
        match fs::read(folder.join("depth.npy")).map_err(|error| error.to_string()).and_then(|it| depth_of_npy(&it)) {
            Ok((depth, width)) => {
                let at = |offset: &i64| {
                    let moment = episode.moments.get(frame.checked_add_signed(*offset as isize)?)?;
                    depth_in_box(&depth, width, moment.visible_box?)
                };
                look.depth_m = OFFSETS.iter().map(at).collect();
                look.rise_m = rise_m(episode, frame, &depth, &folder);
            }
            Err(problem) => {
                flags.push(Flag::damage(
                    "depth-damaged",
                    &episode.id,
                    format!("frame {frame}, `depth.npy`: {problem}"),
                ));
            }
        }
        episode.looks.push(look);
    }
}

/// Height of the drawn ground around the target's feet over them, where the frame has labels.
fn rise_m(episode: &ExaminedEpisode, frame: usize, depth_m: &[f32], folder: &Path) -> Option<f64> {
    let (camera, moment) = (episode.camera.as_ref()?, episode.moments.get(frame)?);
    let file = fs::read(folder.join("instance.png")).ok()?;
    let size = [camera.width, camera.height].map(|side| side as usize);
    if png_size(&file).ok()? != size || depth_m.len() != size[0] * size[1] {
        return None;
    }
    let labels = decoded(&file, "png").ok()?;
    let ground = DrawnGround {
        camera,
        pose: &moment.camera,
        depth_m: &|at| depth_m.get(at).map(|depth| f64::from(*depth)),
        label: &|at| labels.rgb.get(3 * at).copied(),
    };
    let feet = moment.target_in_world? - DVec3::Z * (0.5 * episode.target_height_m);
    ground.rise_m(feet, episode.target_height_m)
}

/// Folder of a frame of a trace.
pub fn frame_folder(trace: &Path, frame: usize) -> PathBuf {
    trace.join(format!("frames_playback/frame_{frame:05}"))
}

/// Rows of 32-bit floats and their width; the sky is infinite.
///
/// # Errors
/// The reason, in words.
pub fn depth_of_npy(bytes: &[u8]) -> Result<(Vec<f32>, usize), String> {
    let head =
        bytes.get(..10).filter(|head| head.starts_with(b"\x93NUMPY\x01")).ok_or("it is not NumPy's version 1")?;
    let length = usize::from(u16::from_le_bytes([head[8], head[9]]));
    let header = bytes.get(10..10 + length).ok_or("it ends in its head")?;
    let header = std::str::from_utf8(header).map_err(|_| "its head is not text")?;
    if !header.contains("'<f4'") || header.contains("'fortran_order': True") {
        return Err(format!("it holds no rows of 32-bit floats: {}", header.trim()));
    }
    let shape = header.split('(').nth(1).and_then(|rest| rest.split(')').next()).ok_or("its head has no shape")?;
    let sides: Vec<usize> = shape.split(',').filter_map(|side| side.trim().parse().ok()).collect();
    let [height, width] = sides[..] else { return Err(format!("its shape is ({shape}), not rows and columns")) };
    let (numbers, _) = bytes[10 + length..].as_chunks::<4>();
    if height.checked_mul(width) != Some(numbers.len()) {
        return Err(format!("it has {} numbers; its shape is ({shape})", numbers.len()));
    }
    let depth = numbers.iter().map(|number| f32::from_le_bytes(*number));
    Ok((depth.map(|depth| if (SKY_M..=1000.0).contains(&depth) { f32::INFINITY } else { depth }).collect(), width))
}
