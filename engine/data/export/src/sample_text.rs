//! The facts of a frame as one JSON object, the same in all formats that have it.

use cosfly_frames::Pose;
use cosfly_read::{FrameRow, PublishedFlight};
use serde_json::{Value, json};

/// The facts of a frame: world frame, metres and degrees.
pub fn frame_facts(flight: &PublishedFlight, row: &FrameRow, frame: usize, instruction: &str) -> Value {
    let target = &row.target;
    json!({
        "trajectory_id": flight.trajectory_id,
        "frame": frame,
        "time_s": flight.times().s(frame),
        "split": flight.split,
        "town": flight.town,
        "weather": flight.weather,
        "is_perturbed": flight.expert_id.is_some(),
        "drone_pose": pose_numbers(&row.pose),
        "camera_pose": pose_numbers(&row.camera_pose),
        "camera_focal_px": flight.camera.focal_px(),
        "target_feet_m": row.target.feet_in_world.to_array(),
        "target_heading_deg": target.heading_rad.to_degrees(),
        "target_speed_mps": target.speed_mps,
        "in_view": row.in_view,
        "visible_by_pixels": row.visible_by_pixels,
        "visible_box_px": row.visible_box_px,
        "full_box_px": row.full_box_px,
        "clearance_m": row.clearance_m,
        "instruction": instruction,
    })
}

/// x, y, z in metres; pitch, yaw, roll in degrees.
pub fn pose_numbers(pose: &Pose) -> [f64; 6] {
    let at = pose.position_in_world;
    [at.x, at.y, at.z, pose.pitch_rad.to_degrees(), pose.yaw_rad.to_degrees(), pose.roll_rad.to_degrees()]
}
