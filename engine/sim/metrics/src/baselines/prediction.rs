//! Input of baselines, and their predictions.

use cosfly_frames::{DVec3, Pose};
use serde::Serialize;

/// Input frames of a window; the last one is the current frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct InputFrames<'a> {
    /// Poses of the drone, world frame.
    pub poses: &'a [Pose],
    /// Positions of the target's feet, world frame, metres.
    pub feet: &'a [DVec3],
    /// Edges around the target's visible pixels, pixels: left, top, right, bottom.
    pub boxes: &'a [Option<[f32; 4]>],
    /// Width and height of the images, pixels.
    pub image_px: [f32; 2],
    /// Number of waypoints to predict.
    pub horizon: usize,
}

impl InputFrames<'_> {
    /// Pose of the drone in the current frame.
    pub fn current(&self) -> Pose {
        self.poses.last().copied().unwrap_or(Pose::looking_at(DVec3::ZERO, DVec3::X))
    }
}

/// A prediction in the world frame.
#[derive(Clone, Debug, PartialEq)]
pub struct WorldPrediction {
    /// Estimated pose of the drone in the current frame.
    pub current: Pose,
    /// Predicted poses of the next frames.
    pub waypoints: Vec<Pose>,
}

/// Pose where true and predicted increments start. The paper does not specify it; scores differ widely.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Anchor {
    /// The current pose of the input: the first increment brings a disturbed drone back.
    Input,
    /// The expert's pose in the same frame: increments are the expert's own.
    Expert,
}

impl WorldPrediction {
    /// Waypoints when the prediction's increments start at `anchor` instead of the estimated current pose.
    pub fn started_at(mut self, anchor: &Pose) -> Vec<Pose> {
        let shift = anchor.position_in_world - self.current.position_in_world;
        for pose in &mut self.waypoints {
            pose.position_in_world += shift;
            pose.pitch_rad += anchor.pitch_rad - self.current.pitch_rad;
            pose.yaw_rad += anchor.yaw_rad - self.current.yaw_rad;
            pose.roll_rad += anchor.roll_rad - self.current.roll_rad;
        }
        self.waypoints
    }
}
