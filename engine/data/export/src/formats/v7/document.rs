//! `trajectory.json` and `perturbation_report.json` of a trace.

use super::names::{PART_FRAMES, Place};
use super::short_ids::ShortIds;
use crate::source::ExportedFlight;
use cosfly_domain::Camera;
use cosfly_frames::{DVec3, Pose};
use cosfly_read::{FrameRow, PublishedFlight};
use serde_json::{Value, json};

/// Name of the schema.
pub const SCHEMA: &str = "drone_nav_traj_v7";
/// Version of the schema.
pub const SCHEMA_VERSION: &str = "7.0.0";
/// Folder of the frames below that of the trace.
pub const FRAMES_DIR: &str = "frames_playback";

/// The whole `trajectory.json`. World: CARLA's own, left-handed, z up, metres and degrees.
pub fn trajectory(episode: &ExportedFlight<'_>, place: &Place, ids: &ShortIds) -> Value {
    let flight = episode.flight;
    let points: Vec<Value> = (0..episode.frames.len()).map(|index| point(episode, index)).collect();
    let waypoints: Vec<Value> = (0..episode.frames.len()).map(|index| waypoint(episode, index)).collect();
    json!({
        "schema": SCHEMA,
        "schema_version": SCHEMA_VERSION,
        "dataset_format": "v7",
        "source": {
            "path_index": place.path_index,
            "scenario_id": place.path_index,
            "scenario_name": format!("drone_trace_oneshot_path_{}", place.path_index),
            "algorithm": "oneshot",
        },
        "camera": camera(&flight.camera),
        "trace_dir": place.trace(),
        "frames_dir": FRAMES_DIR,
        "augmentation": {
            "enabled": place.aug_index > 0,
            "aug_index": place.aug_index,
            "is_original": place.aug_index == 0,
        },
        "points": points,
        "waypoints": waypoints,
        "cosfly": own_part(episode, place, ids),
    })
}

/// Facts for which the release has no place.
fn own_part(episode: &ExportedFlight<'_>, place: &Place, ids: &ShortIds) -> Value {
    let flight = episode.flight;
    let captions: Vec<Value> = episode
        .captions
        .iter()
        .map(|it| json!({"language": it.language, "style": it.style, "text": it.text}))
        .collect();
    let mut own = json!({
        "trajectory_id": flight.trajectory_id,
        "expert_id": flight.expert_id,
        "pedestrian_id": flight.pedestrian_id,
        "town": flight.town,
        "town_geometry_blake3": flight.town_geometry,
        "split": flight.split,
        "part": {
            "index": place.part,
            "count": place.ids.len(),
            "first_frame": place.part * PART_FRAMES,
        },
        "dt_s": flight.dt_s,
        "weather": {"preset": flight.weather, "numbers": *flight.weather_numbers},
        "target": {"height_m": flight.target_height_m, "radius_m": flight.target_radius_m},
        "captions": captions,
    });
    if !flight.lens.is_none() {
        own["lens"] = json!({
            "model": flight.lens.model.name(),
            "coefficients": flight.lens.coefficients(),
            "depth_is_along_rays": flight.lens.is_wide(&flight.camera),
        });
    }
    let instances: Vec<[u32; 2]> = ids.changed().collect();
    if !instances.is_empty() {
        own["instances"] = json!(instances);
    }
    own
}

/// The camera without the distortion of its lens.
fn camera(camera: &Camera) -> Value {
    let (focal_px, [cx, cy]) = (camera.focal_px(), middle_px(camera));
    json!({
        "width": camera.width,
        "height": camera.height,
        "focal_length_px": focal_px,
        "intrinsic": [[focal_px, 0.0, cx], [0.0, focal_px, cy], [0.0, 0.0, 1.0]],
    })
}

fn middle_px(camera: &Camera) -> [f64; 2] {
    [0.5 * f64::from(camera.width), 0.5 * f64::from(camera.height)]
}

fn point(episode: &ExportedFlight<'_>, index: usize) -> Value {
    let (flight, row) = (episode.flight, &episode.frames[index]);
    let next = episode.frames.get(index + 1).map(|next| next.pose.position_in_world + flight.town_offset_m);
    json!({
        "index": index,
        "timing": timing(episode, index),
        "drone_pose": pose_value(&row.pose, flight.town_offset_m),
        "nav_waypoint": {"t1_world": next.map(place_value)},
        "is_perturbed": row.disturbance.as_ref().is_some_and(|it| it.position || it.rotation),
        "perturbation": row.disturbance.as_ref().map(|it| {
            json!({"drone_position": it.position, "drone_rotation": it.rotation})
        }),
        "target": target(flight, row),
        "cosfly": {
            "camera_pose": pose_value(&row.camera_pose, flight.town_offset_m),
            "visible_by_rays": row.visible_by_rays,
            "visible_by_pixels": row.visible_by_pixels,
            "clearance_m": row.clearance_m,
            "target_feet": place_value(row.target.feet_in_world + flight.town_offset_m),
            "target_heading_deg": row.target.heading_rad.to_degrees(),
            "target_speed_mps": row.target.speed_mps,
            "full_bbox_2d": row.full_box_px.map(box_value),
            "expert_index": row.disturbance.as_ref().map(|it| it.expert_frame),
        },
    })
}

/// Time and pose of a point again: some readers look for `waypoints` instead of `points`.
fn waypoint(episode: &ExportedFlight<'_>, index: usize) -> Value {
    json!({
        "index": index,
        "timing": timing(episode, index),
        "drone_pose": pose_value(&episode.frames[index].pose, episode.flight.town_offset_m),
    })
}

/// Seconds since the first frame, by all names that readers know.
fn timing(episode: &ExportedFlight<'_>, index: usize) -> Value {
    let time_s = index as f64 * episode.flight.dt_s;
    json!({"timestamp": time_s, "trace_timestamp": time_s, "sim_timestamp": time_s})
}

fn target(flight: &PublishedFlight, row: &FrameRow) -> Value {
    let middle = row.target.feet_in_world + DVec3::new(0.0, 0.0, 0.5 * flight.target_height_m);
    let seen = row.camera_pose.body_from_world_point(middle);
    json!({
        "enabled": true,
        "visible": row.visible_pixels > 0,
        "in_view": row.in_view,
        "depth": if flight.lens.is_wide(&flight.camera) { seen.length() } else { seen.x },
        "world_location": place_value(middle + flight.town_offset_m),
        "image_uv": image_uv(flight, seen),
        "bbox_2d": row.visible_box_px.map(box_value),
    })
}

/// Place in the image of a point of the camera's body frame (x ahead, y right, z up), pixels; none outside of the image.
fn image_uv(flight: &PublishedFlight, point: DVec3) -> Option<[f64; 2]> {
    let camera = &flight.camera;
    let (u, v) = if flight.lens.is_wide(camera) {
        let (u, v, _) = flight.lens.project(camera, point)?;
        (u, v)
    } else {
        let (right, down) = (point.y / point.x, -point.z / point.x);
        let ([cx, cy], focal) = (middle_px(camera), camera.focal_px());
        (point.x > 0.0).then(|| flight.lens.bend(camera, (cx + focal * right, cy + focal * down)))?
    };
    let uv = [u, v];
    let is_inside =
        (0.0..=f64::from(camera.width)).contains(&uv[0]) && (0.0..=f64::from(camera.height)).contains(&uv[1]);
    is_inside.then_some(uv)
}

/// A pose in CARLA's order.
fn pose_value(pose: &Pose, offset: DVec3) -> Value {
    let at = pose.position_in_world + offset;
    json!({
        "x": at.x, "y": at.y, "z": at.z,
        "pitch": pose.pitch_rad.to_degrees(), "yaw": pose.yaw_rad.to_degrees(), "roll": pose.roll_rad.to_degrees(),
    })
}

fn place_value(at: DVec3) -> Value {
    json!({"x": at.x, "y": at.y, "z": at.z})
}

fn box_value([left, top, right, bottom]: [f32; 4]) -> Value {
    json!({"xmin": left, "ymin": top, "xmax": right, "ymax": bottom})
}

/// The whole `perturbation_report.json`: our own design, since the release's is not documented.
pub fn perturbation_report(episode: &ExportedFlight<'_>, place: &Place) -> Value {
    let events = |count: fn(&cosfly_read::Disturbance) -> bool| {
        episode.frames.iter().filter_map(|row| row.disturbance.as_ref()).filter(|it| count(it)).count()
    };
    let frames: Vec<Value> = episode
        .frames
        .iter()
        .enumerate()
        .filter_map(|(index, row)| row.disturbance.as_ref().map(|it| (index, it)))
        .map(|(index, it)| {
            json!({
                "index": index,
                "expert_index": it.expert_frame,
                "drone_position": it.position,
                "drone_rotation": it.rotation,
                "drone_offset": place_value(it.drone_offset_in_world),
                "aim_offset": place_value(it.aim_offset_in_world),
                "pitch_offset_deg": it.pitch_offset_deg,
                "yaw_offset_deg": it.yaw_offset_deg,
            })
        })
        .collect();
    json!({
        "design": "cosfly's own; the release's keys are not public",
        "trace_dir": place.trace(),
        "enabled": place.aug_index > 0,
        "aug_index": place.aug_index,
        "num_points": episode.frames.len(),
        "num_position_perturbed": events(|it| it.position),
        "num_rotation_perturbed": events(|it| it.rotation),
        "num_perturbed": events(|it| it.position || it.rotation),
        "frames": frames,
    })
}
