//! Table `waypoints`: poses and actions only, for training without images.

use super::{Cell, Column, DatasetItem, Kind, Table};
use crate::action;

/// The table.
pub fn table() -> Table<DatasetItem> {
    Table {
        name: "waypoints",
        doc: "Poses and actions alone, one row per step: small, for training and statistics without images.",
        key: &["trajectory_id", "step"],
        rows: |item| item.record.len(),
        per_frame: true,
        rows_per_group: 50_000,
        reads_previews: false,
        reads_expert: false,
        columns: vec![
            Column::new("trajectory_id", Kind::Text, "the flight", |item, _| (&item.record.trajectory_id).into()),
            Column::new("step", Kind::Integer, "step, from 0; the frame of the same number", |_, i| i.into()),
            Column::new(
                "pose_in_world",
                Kind::Reals(6),
                "x, y, z (m), pitch, yaw, roll (degrees), CARLA's frame",
                pose,
            ),
            Column::new("target_feet_in_world", Kind::Reals(3), "x, y, z (m) of the target's feet", |item, i| {
                item.record.trajectory.track.states[i].feet_in_world.into()
            }),
            Column::optional(
                "action_in_world",
                Kind::Reals(6),
                "dx, dy, dz (m), dpitch, dyaw, droll (degrees) to the next step along the world's axes; null on the last",
                |item, i| step(item, i, action::in_world),
            ),
            Column::optional(
                "action_in_body",
                Kind::Reals(6),
                "the next pose in the body frame of this one (x ahead, y right, z up), m and degrees; null on the last",
                |item, i| step(item, i, action::in_body),
            ),
            Column::new("expert_step", Kind::Integer, "step of the expert that this step belongs to", |item, i| {
                let frames = item.record.trajectory.perturbation.as_ref().map(|it| &it.frames);
                frames.map_or(i as u64, |frames| u64::from(frames[i].expert_frame)).into()
            }),
        ],
    }
}

fn pose(item: &DatasetItem, i: usize) -> Cell {
    pose_cell(&item.record.trajectory.poses_in_world[i])
}

/// x, y, z in metres, pitch, yaw, roll in degrees.
pub fn pose_cell(pose: &cosfly_frames::Pose) -> Cell {
    let position = pose.position_in_world;
    let [pitch, yaw, roll] = [pose.pitch_rad, pose.yaw_rad, pose.roll_rad].map(f64::to_degrees);
    [position.x, position.y, position.z, pitch, yaw, roll].into()
}

/// The action from step `i` to the next one; null on the last.
pub fn step(item: &DatasetItem, i: usize, action: fn(&cosfly_frames::Pose, &cosfly_frames::Pose) -> [f64; 6]) -> Cell {
    let poses = &item.record.trajectory.poses_in_world;
    poses.get(i + 1).map(|next| action(&poses[i], next)).into()
}
