//! Table `frames`: one row per image, with pose, target, visibility, boxes, action and a small preview.

use super::column::columns;
use super::value::{Edges, ImageFile, class_value};
use super::waypoints::action_from;
use super::{DatasetItem, Need, Table};
use crate::Role;
use crate::log::messages::edges_px;
use crate::published_costs::costs;
use cosfly_domain::{FramePerturbation, PixelBox, TargetView};
use cosfly_frames::{Pose, TargetState, action};

/// Definition of the table. Previews make its rows large, so that row groups are small.
pub fn table() -> Table<DatasetItem> {
    let doc = "One row per image: camera pose, target state, visibility, boxes, action, disturbance, small preview.";
    let (per_frame, rows_per_group, needs) = (true, 200, &[Need::Previews][..]);
    let table =
        Table::new("frames", doc, &["trajectory_id", "frame"], |item: &DatasetItem| item.record.len(), Frames::COLUMNS);
    Table { per_frame, rows_per_group, needs, ..table }
}

/// Columns of table `frames`.
pub struct Frames;

columns! { Frames::COLUMNS of DatasetItem;
    /// Trajectory that the frame belongs to.
    trajectory_id: String = |item, _| item.record.trajectory_id.clone();
    /// Split: `train`, `val` or `test`; that of the file.
    split: String = |item, _| item.membership.split.name().to_owned();
    /// Number of the frame, from 0.
    frame: u32 = |_, i| i as u32;
    /// Time of the frame since the flight began: `frame * dt_s`, later by the `offset_s` of its camera; the same as in the log.
    time_s: f64 = |item, i| item.record.times().s(i);
    /// Expert or perturbed trajectory.
    role: Role = |item, _| item.record.role;

    /// Position of the drone, world frame (CARLA's, left-handed): x, east.
    drone_x_m: f64 = |item, i| pose(item, i).position_in_world.x;
    /// Position of the drone, world frame: y, south.
    drone_y_m: f64 = |item, i| pose(item, i).position_in_world.y;
    /// Position of the drone, world frame: z, up.
    drone_z_m: f64 = |item, i| pose(item, i).position_in_world.z;
    /// Pitch of the drone; positive: nose up.
    drone_pitch_deg: f64 = |item, i| pose(item, i).pitch_rad.to_degrees();
    /// Yaw of the drone; positive: x towards y.
    drone_yaw_deg: f64 = |item, i| pose(item, i).yaw_rad.to_degrees();
    /// Roll of the drone; positive: right side down.
    drone_roll_deg: f64 = |item, i| pose(item, i).roll_rad.to_degrees();
    /// Pitch of the camera that took the images: the drone's, turned by the mount in `trajectories`.
    camera_pitch_deg: f64 = |item, i| item.record.camera_pose(i).pitch_rad.to_degrees();
    /// Yaw of the camera, signed like `drone_yaw_deg`.
    camera_yaw_deg: f64 = |item, i| item.record.camera_pose(i).yaw_rad.to_degrees();
    /// Roll of the camera, signed like `drone_roll_deg`.
    camera_roll_deg: f64 = |item, i| item.record.camera_pose(i).roll_rad.to_degrees();
    /// Position of the camera, world frame: x, y, z; null where it is the drone's.
    camera_in_world_m: Option<[f64; 3]> = |item, i| {
        let camera = item.record.camera_pose(i).position_in_world.to_array();
        (!item.record.mount.is_in_origin()).then_some(camera)
    };

    /// Ground point between the target's feet, world frame: x.
    target_x_m: f64 = |item, i| state(item, i).feet_in_world.x;
    /// Ground point between the target's feet, world frame: y.
    target_y_m: f64 = |item, i| state(item, i).feet_in_world.y;
    /// Ground point between the target's feet, world frame: z.
    target_z_m: f64 = |item, i| state(item, i).feet_in_world.z;
    /// Walking direction of the target, signed like a yaw; kept while the target stands.
    target_heading_deg: f64 = |item, i| state(item, i).heading_rad.to_degrees();
    /// Speed of the target along the ground; 0 while the target stands.
    target_speed_mps: f64 = |item, i| state(item, i).speed_mps;
    /// Distance from the camera to the target's feet.
    distance_m: f64 = |item, i| item.record.distance_m(i);
    /// Distance from the drone to the nearest obstacle, at most 50.
    clearance_m: f64 = |item, i| item.record.trajectory.clearance_m[i];

    /// Whether the target's body covers at least one pixel centre of the image, occluded or not.
    in_view: bool = |item, i| view(item, i).in_view;
    /// Share of the target's body points that unoccluded rays from the drone's position reach, 0..1.
    visible_by_rays: f64 = |item, i| view(item, i).visible_by_rays;
    /// Visible pixels of the target / pixels without obstacles, inside the image, 0..1; 0 out of view.
    visible_by_pixels: f64 = |item, i| view(item, i).visible_by_pixels;
    /// Share of about 400 rays, cast without the renderer to the part of the body inside the image, that reach it; null
    /// out of view.
    visible_by_dense_rays: Option<f64> = |item, i| item.record.visible_by_dense_rays[i];
    /// Number of visible pixels of the target.
    visible_pixels: u32 = |item, i| view(item, i).pixels;
    /// Left, top, right, bottom edge around the visible pixels of the target; null when none is visible.
    visible_box_px: Option<Edges> = |item, i| view(item, i).visible_box.as_ref().map(edges);
    /// Left, top, right, bottom edge around the target's pixels without obstacles; null out of view.
    full_box_px: Option<Edges> = |item, i| view(item, i).full_box.as_ref().map(edges);
    /// Instance id of the obstacle or body that hides most of the target, see tables `objects` and `bodies`; 0: no
    /// occluder, or only ground.
    occluder_instance: u32 = |item, i| view(item, i).occluder_instance;

    /// Number of other visible bodies of the target's kind in the same clothes: colours of top and trousers in words, backpack.
    look_alikes: u32 = |item, i| item.record.look_alikes(i) as u32;

    /// Step to the next frame along the world's axes: dx, dy, dz (m), dpitch, dyaw, droll (degrees); null on the last frame.
    action_in_world: Option<[f64; 6]> = |item, i| action_from(item, i, action::in_world);
    /// The next pose in the body frame of this one (x ahead, y right, z up): dx, dy, dz (m), dpitch, dyaw, droll (degrees);
    /// null on the last frame.
    action_in_body: Option<[f64; 6]> = |item, i| action_from(item, i, action::in_body);
    /// Unweighted cost of each planner term, in the order of `trajectories.term_names`; empty for perturbed trajectories.
    term_costs: Vec<f64> = |item, i| {
        costs(&item.record.trajectory).map(|term| term.per_frame[i]).collect()
    };
    /// Labels that plugins gave to the frame, in the order of `trajectories.label_names`; empty without such plugins.
    labels: Vec<f64> = |item, i| {
        item.record.trajectory.labels.iter().map(|label| label.per_frame[i]).collect()
    };

    /// Frame of the expert that this frame belongs to; null for experts.
    expert_frame: Option<u32> = |item, i| event(item, i).map(|event| event.expert_frame);
    /// Whether the position was disturbed at this frame; null for experts.
    position_event: Option<bool> = |item, i| event(item, i).map(|event| event.position);
    /// Whether the rotation was disturbed at this frame; null for experts.
    rotation_event: Option<bool> = |item, i| event(item, i).map(|event| event.rotation);
    /// Displacement of the drone, world frame; null for experts.
    drone_offset_in_world_m: Option<[f64; 3]> = |item, i| {
        event(item, i).map(|event| event.drone_offset_in_world.to_array())
    };
    /// Displacement of the aim point of the camera, world frame; null for experts.
    aim_offset_in_world_m: Option<[f64; 3]> = |item, i| {
        event(item, i).map(|event| event.aim_offset_in_world.to_array())
    };
    /// Rotation added to the pitch; null for experts.
    pitch_offset_deg: Option<f64> = |item, i| event(item, i).map(|event| event.pitch_offset_rad.to_degrees());
    /// Rotation added to the yaw; null for experts.
    yaw_offset_deg: Option<f64> = |item, i| event(item, i).map(|event| event.yaw_offset_rad.to_degrees());
    /// The colour image, 320 pixels wide, JPEG; null where the recipe switches previews off.
    preview: Option<ImageFile> = |item, i| item.previews.jpegs.get(i).cloned().map(ImageFile);
}

/// Class labels of roles.
pub const ROLES: [&str; 2] = ["expert", "perturbed"];

class_value!(Role, Role::ALL, ROLES);

fn pose(item: &DatasetItem, i: usize) -> &Pose {
    &item.record.trajectory.poses_in_world[i]
}

fn state(item: &DatasetItem, i: usize) -> &TargetState {
    &item.record.trajectory.track.states[i]
}

fn view(item: &DatasetItem, i: usize) -> &TargetView {
    &item.record.views[i]
}

fn event(item: &DatasetItem, i: usize) -> Option<&FramePerturbation> {
    item.record.trajectory.perturbation.as_ref().map(|it| &it.frames[i])
}

fn edges(pixel_box: &PixelBox) -> Edges {
    edges_px(pixel_box).map(|edge| edge as f32)
}
