//! Tables of foreign layouts, with the names and columns of cosfly's own: the columns whose values the data hold.
//!
//! Feet are half the target's height below its middle (1.8 m high in v7 unless stated). Windows have the default shape.

use crate::LoadedFlight;
use arrow_array::builder::{Float64Builder, ListBuilder, StringBuilder};
use arrow_array::{ArrayRef, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow_schema::{DataType, Field};
use cosfly_episodes::{ExaminedEpisode, ExaminedMoment};
use cosfly_frames::{DVec3, Pose, action};
use cosfly_windows::WindowShape;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Names of all tables.
pub const NAMES: &[&str] = &["trajectories", "frames", "captions", "windows"];
/// Names of the tables of data without poses.
pub const NAMES_WITHOUT_POSES: &[&str] = &["trajectories", "frames", "captions"];

/// A flight that counts for a table, and its frames.
pub type Part<'a> = (&'a LoadedFlight, &'a ExaminedEpisode);

/// Poses of the flight that a model learns, one for each frame; none where it is absent or of another length. `originals` are the
/// experts of v7 by the folders of their pairs.
fn expert(originals: &BTreeMap<&str, &ExaminedEpisode>, episode: &ExaminedEpisode) -> Option<Vec<Pose>> {
    let poses = |of: &ExaminedEpisode| of.moments.iter().map(|moment| moment.drone).collect::<Vec<_>>();
    let found = match &episode.followed {
        Some(poses) => poses.clone(),
        None if !episode.is_perturbed => poses(episode),
        None => poses(originals.get(episode.id.rsplit_once('/')?.0)?),
    };
    (found.len() == episode.moments.len()).then_some(found)
}

/// The table `name` of `parts`, some of `all` episodes; none where the layout has no such table.
pub fn made(name: &str, parts: &[Part<'_>], all: &[ExaminedEpisode], has_poses: bool) -> Option<RecordBatch> {
    let columns = match name {
        "trajectories" => trajectories(parts),
        "frames" => frames(parts, has_poses),
        "captions" => captions(parts),
        "windows" if has_poses => windows(parts, all),
        _ => return None,
    };
    RecordBatch::try_from_iter_with_nullable(columns.into_iter().map(|(name, array)| (name, array, true))).ok()
}

type Columns = Vec<(&'static str, ArrayRef)>;

fn texts<'a>(values: impl Iterator<Item = &'a str>) -> ArrayRef {
    Arc::new(StringArray::from_iter_values(values))
}

fn integers(values: impl Iterator<Item = usize>) -> ArrayRef {
    Arc::new(Int64Array::from_iter_values(values.map(|value| value as i64)))
}

fn reals(values: impl Iterator<Item = Option<f64>>) -> ArrayRef {
    Arc::new(values.collect::<Float64Array>())
}

fn lists<const N: usize>(values: impl Iterator<Item = Option<[f64; N]>>) -> ArrayRef {
    rows(values.map(|row| row.map(|row| row.to_vec())))
}

fn rows(values: impl Iterator<Item = Option<Vec<f64>>>) -> ArrayRef {
    let item = Arc::new(Field::new("item", DataType::Float64, true));
    let mut rows = ListBuilder::new(Float64Builder::new()).with_field(item);
    for row in values {
        rows.append_option(row.map(|row| row.into_iter().map(Some).collect::<Vec<_>>()));
    }
    Arc::new(rows.finish())
}

fn role(part: &Part<'_>) -> usize {
    usize::from(part.1.is_perturbed)
}

fn trajectories(parts: &[Part<'_>]) -> Columns {
    let each = || parts.iter();
    vec![
        ("trajectory_id", texts(each().map(|it| it.0.id.as_str()))),
        ("split", texts(each().map(|it| it.0.split.as_str()))),
        ("role", integers(each().map(role))),
        ("frames", integers(each().map(|it| it.0.frames))),
        ("dt_s", reals(each().map(|it| Some(it.1.dt_s)))),
        ("camera_width_px", integers(each().map(|it| it.0.size[0] as usize))),
        ("camera_height_px", integers(each().map(|it| it.0.size[1] as usize))),
    ]
}

fn captions(parts: &[Part<'_>]) -> Columns {
    let each = || parts.iter().flat_map(|part| part.1.captions.iter().map(move |caption| (part, caption)));
    vec![
        ("trajectory_id", texts(each().map(|(part, _)| part.0.id.as_str()))),
        ("language", texts(each().map(|(_, caption)| caption.0.as_str()))),
        ("text", texts(each().map(|(_, caption)| caption.1.as_str()))),
    ]
}

/// A number of a frame, which has a number and a moment.
type Value<'a> = dyn Fn(&Part<'_>, usize, &ExaminedMoment) -> Option<f64> + 'a;

fn frames(parts: &[Part<'_>], has_poses: bool) -> Columns {
    let each = || parts.iter().flat_map(|part| part.1.moments.iter().enumerate().map(move |it| (part, it)));
    let real = |value: &Value<'_>| reals(each().map(|(part, (frame, moment))| value(part, frame, moment)));
    let mut columns: Columns = vec![
        ("trajectory_id", texts(each().map(|(part, _)| part.0.id.as_str()))),
        ("split", texts(each().map(|(part, _)| part.0.split.as_str()))),
        ("frame", integers(each().map(|(_, (frame, _))| frame))),
        ("time_s", real(&|_, _, it| Some(it.time_s))),
        ("role", integers(each().map(|(part, _)| role(part)))),
    ];
    if has_poses {
        let step = |of: fn(&Pose, &Pose) -> [f64; 6]| {
            lists(each().map(|(part, (frame, moment))| {
                part.1.moments.get(frame + 1).map(|next| of(&moment.drone, &next.drone))
            }))
        };
        columns.extend([
            ("drone_x_m", real(&|_, _, it| Some(it.drone.position_in_world.x))),
            ("drone_y_m", real(&|_, _, it| Some(it.drone.position_in_world.y))),
            ("drone_z_m", real(&|_, _, it| Some(it.drone.position_in_world.z))),
            ("drone_pitch_deg", real(&|_, _, it| Some(it.drone.pitch_rad.to_degrees()))),
            ("drone_yaw_deg", real(&|_, _, it| Some(it.drone.yaw_rad.to_degrees()))),
            ("drone_roll_deg", real(&|_, _, it| Some(it.drone.roll_rad.to_degrees()))),
            ("camera_pitch_deg", real(&|_, _, it| Some(it.camera.pitch_rad.to_degrees()))),
            ("camera_yaw_deg", real(&|_, _, it| Some(it.camera.yaw_rad.to_degrees()))),
            ("camera_roll_deg", real(&|_, _, it| Some(it.camera.roll_rad.to_degrees()))),
            ("action_in_world", step(action::in_world)),
            ("action_in_body", step(action::in_body)),
        ]);
    }
    let feet = |part: &Part<'_>, moment: &ExaminedMoment| {
        moment.target_in_world.map(|middle| middle - DVec3::Z * (0.5 * part.1.target_height_m))
    };
    let stated: [(&'static str, &Value<'_>); 7] = [
        ("target_x_m", &|part, _, it| Some(feet(part, it)?.x)),
        ("target_y_m", &|part, _, it| Some(feet(part, it)?.y)),
        ("target_z_m", &|part, _, it| Some(feet(part, it)?.z)),
        ("target_heading_deg", &|_, _, it| Some(it.heading_and_speed?.0.to_degrees())),
        ("target_speed_mps", &|_, _, it| Some(it.heading_and_speed?.1)),
        ("visible_by_pixels", &|_, _, it| it.visible),
        ("clearance_m", &|_, _, it| it.clearance_m),
    ];
    for (name, value) in stated {
        if each().any(|(part, (frame, moment))| value(part, frame, moment).is_some()) {
            columns.push((name, real(value)));
        }
    }
    if each().any(|(_, (_, moment))| moment.visible_box.is_some()) {
        columns.push(("visible_box_px", lists(each().map(|(_, (_, moment))| moment.visible_box))));
    }
    columns
}

/// A window: the flight, the poses of its expert, and the first frame.
type Window<'a> = (Part<'a>, &'a [Pose], usize);

fn windows(parts: &[Part<'_>], all: &[ExaminedEpisode]) -> Columns {
    let shape = WindowShape::default();
    let originals: BTreeMap<&str, &ExaminedEpisode> =
        all.iter().filter_map(|it| Some((it.id.strip_suffix("/ORI")?, it))).collect();
    let experts: Vec<Option<Vec<Pose>>> = parts.iter().map(|(_, episode)| expert(&originals, episode)).collect();
    let mut all: Vec<Window<'_>> = vec![];
    for (part, expert) in parts.iter().zip(&experts) {
        if let Some(expert) = expert {
            all.extend(shape.starts(part.0.frames).map(|start| (*part, &expert[..], start)));
        }
    }
    let own = |part: &Part<'_>, frame: usize| part.1.moments[frame].drone;
    let now = |start: usize| start + shape.history - 1;
    let steps = |poses: &dyn Fn(&Window<'_>) -> Vec<(Pose, Pose)>, step: fn(&Pose, &Pose) -> [f64; 6]| {
        rows(all.iter().map(|it| Some(poses(it).iter().flat_map(|(from, to)| step(from, to)).collect())))
    };
    let input = |it: &Window<'_>| (it.2..now(it.2)).map(|frame| (own(&it.0, frame), own(&it.0, frame + 1))).collect();
    let correction = |it: &Window<'_>| (it.2..=now(it.2)).map(|frame| (own(&it.0, frame), it.1[frame])).collect();
    let ahead = |it: &Window<'_>| {
        let from = |frame: usize| if frame == now(it.2) { own(&it.0, frame) } else { it.1[frame] };
        (now(it.2)..it.2 + shape.size() - 1).map(|frame| (from(frame), it.1[frame + 1])).collect()
    };
    let current = |it: &Window<'_>| {
        let pose = own(&it.0, now(it.2));
        let angles = [pose.pitch_rad, pose.yaw_rad, pose.roll_rad].map(f64::to_degrees);
        [pose.position_in_world.to_array(), angles].concat()
    };
    let boxes = |it: &Window<'_>| {
        let edges = |frame: usize| it.0.1.moments[frame].visible_box.unwrap_or([0.0; 4]);
        (it.2..=now(it.2)).flat_map(edges).collect()
    };
    let mut names = StringBuilder::new();
    all.iter().for_each(|(part, _, start)| names.append_value(format!("{}/{start}", part.0.id)));
    vec![
        ("window_id", Arc::new(names.finish())),
        ("trajectory_id", texts(all.iter().map(|it| it.0.0.id.as_str()))),
        ("split", texts(all.iter().map(|it| it.0.0.split.as_str()))),
        ("role", integers(all.iter().map(|it| role(&it.0)))),
        ("start_frame", integers(all.iter().map(|it| it.2))),
        ("current_pose_in_world", rows(all.iter().map(|it| Some(current(it))))),
        ("input_steps_in_world", steps(&input, action::in_world)),
        ("input_steps_in_body", steps(&input, action::in_body)),
        ("correction_in_world", steps(&correction, action::in_world)),
        ("correction_in_body", steps(&correction, action::in_body)),
        ("waypoint_deltas_in_world", steps(&ahead, action::in_world)),
        ("waypoint_deltas_in_body", steps(&ahead, action::in_body)),
        ("input_boxes_px", rows(all.iter().map(|it| Some(boxes(it))))),
    ]
}
