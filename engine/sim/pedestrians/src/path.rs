//! [`PedestrianPath`]: track of a pedestrian and the ground under it.

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
    /// Whether the pedestrian stands, per frame.
    pub standing: Vec<bool>,
}
