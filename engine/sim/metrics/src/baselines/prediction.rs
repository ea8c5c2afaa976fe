//! A window as baselines see it, and their predictions.

use cosfly_frames::{DVec3, Pose};
use serde::Serialize;

/// The input frames of a window; the last one is the current one.
#[derive(Clone, Copy, Debug, Default)]
pub struct View<'a> {
    /// Poses of the drone.
    pub poses: &'a [Pose],
    /// The target's feet in the same frames.
    pub feet: &'a [DVec3],
    /// Edges around the target's visible pixels in their images, pixels: left, top, right, bottom.
    pub boxes: &'a [Option<[f32; 4]>],
    /// Width and height of the images, pixels.
    pub image_px: [f32; 2],
    /// Waypoints to predict.
    pub horizon: usize,
}

impl View<'_> {
    /// The drone's pose in the current frame.
    pub fn current(&self) -> Pose {
        self.poses.last().copied().unwrap_or(Pose::looking_at(DVec3::ZERO, DVec3::X))
    }
}

/// A prediction in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// Estimated pose of the drone in the current frame.
    pub current: Pose,
    /// Predicted poses of the next frames.
    pub waypoints: Vec<Pose>,
}

/// The pose that true and predicted increments start from. The paper does not say; scores differ widely.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Anchor {
    /// The current pose of the input: where the drone is. The first increment brings a disturbed drone back.
    Input,
    /// The expert's pose in the same frame: increments are the expert's own.
    Expert,
}

impl Prediction {
    /// The waypoints when the prediction's increments start at `anchor` instead of the pose thought to be current.
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
