//! What the pedestrian simulation gives: a track, and what it walked on.

use cosfly_frames::TargetTrack;
use cosfly_maps::WalkableKind;
use serde::{Deserialize, Serialize};

/// A pedestrian's walk.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PedestrianPath {
    /// Feet, heading and speed per frame.
    pub track: TargetTrack,
    /// Ground under the feet per frame.
    pub ground: Vec<WalkableKind>,
    /// Frames at which the pedestrian stands.
    pub standing: Vec<bool>,
}
