//! What a model must beat: predictions that need no pictures.
//!
//! A prediction is an estimate of the current pose and the waypoints after it. The estimate matters for increments
//! (see `Anchor`): a line through a noisy history does not pass through its last pose.

pub mod extrapolate;
pub mod features;
pub mod nearest;
pub mod network;
pub mod ridge;
mod solve;

pub use extrapolate::Extrapolation;
pub use nearest::NearestNeighbour;
pub use network::Network;
pub use ridge::Ridge;

use cosfly_frames::{DVec3, Pose};

/// What a baseline sees of a window: the input frames, the last one is the current one.
#[derive(Clone, Copy, Debug, Default)]
pub struct View<'a> {
    /// Poses of the drone.
    pub poses: &'a [Pose],
    /// The target's feet in the same frames.
    pub feet: &'a [DVec3],
    /// Edges around its visible pixels in their images: left, top, right, bottom.
    pub boxes: &'a [Option<[f32; 4]>],
    /// Width and height of the images.
    pub image_px: [f32; 2],
    /// Waypoints to predict.
    pub horizon: usize,
}

impl View<'_> {
    /// The pose that the drone has now.
    pub fn current(&self) -> Pose {
        self.poses.last().copied().unwrap_or(Pose::looking_at(DVec3::ZERO, DVec3::X))
    }
}

/// A prediction in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// Where the drone is thought to be now.
    pub current: Pose,
    /// Where it should be in the next frames.
    pub waypoints: Vec<Pose>,
}

/// The pose that true and predicted increments start from. The paper does not say; scores differ widely.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
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
