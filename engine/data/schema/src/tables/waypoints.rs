//! Table `waypoints`: poses and actions only, for training without images.

use super::column::columns;
use super::{DatasetItem, Table};
use cosfly_frames::{Pose, action};

/// Definition of the table.
pub fn table() -> Table<DatasetItem> {
    let doc = "Poses and actions alone, one row per step: small, for training and statistics without images.";
    let rows = |item: &DatasetItem| item.record.len();
    Table { per_frame: true, ..Table::new("waypoints", doc, &["trajectory_id", "step"], rows, Waypoints::COLUMNS) }
}

/// Columns of table `waypoints`.
pub struct Waypoints;

columns! { Waypoints::COLUMNS of DatasetItem;
    /// Trajectory that the step belongs to.
    trajectory_id: String = |item, _| item.record.trajectory_id.clone();
    /// Split: `train`, `val` or `test`; that of the file.
    split: String = |item, _| item.membership.split.name().to_owned();
    /// Number of the step, from 0; the frame of the same number.
    step: u32 = |_, i| i as u32;
    /// Pose of the drone, world frame (CARLA's): x, y, z (m), pitch, yaw, roll (degrees).
    pose_in_world: [f64; 6] = |item, i| pose_numbers(&item.record.trajectory.poses_in_world[i]);
    /// Ground point between the target's feet, world frame: x, y, z (m).
    target_feet_in_world: [f64; 3] = |item, i| item.record.trajectory.track.states[i].feet_in_world.to_array();
    /// Step to the next pose along the world's axes: dx, dy, dz (m), dpitch, dyaw, droll (degrees); null on the last step.
    action_in_world: Option<[f64; 6]> = |item, i| action_from(item, i, action::in_world);
    /// The next pose in the body frame of this one (x ahead, y right, z up): dx, dy, dz (m), dpitch, dyaw, droll (degrees);
    /// null on the last step.
    action_in_body: Option<[f64; 6]> = |item, i| action_from(item, i, action::in_body);
    /// Step of the expert that this step belongs to; the step's own number for experts.
    expert_step: u32 = |item, i| {
        let frames = item.record.trajectory.perturbation.as_ref().map(|it| &it.frames);
        frames.map_or(i as u32, |frames| frames[i].expert_frame)
    };
}

/// Pose as x, y, z in metres, pitch, yaw, roll in degrees.
pub fn pose_numbers(pose: &Pose) -> [f64; 6] {
    let position = pose.position_in_world;
    let [pitch, yaw, roll] = [pose.pitch_rad, pose.yaw_rad, pose.roll_rad].map(f64::to_degrees);
    [position.x, position.y, position.z, pitch, yaw, roll]
}

/// Action from step `i` to the next one; `None` on the last step.
pub fn action_from(item: &DatasetItem, i: usize, action: fn(&Pose, &Pose) -> [f64; 6]) -> Option<[f64; 6]> {
    let poses = &item.record.trajectory.poses_in_world;
    poses.get(i + 1).map(|next| action(&poses[i], next))
}
