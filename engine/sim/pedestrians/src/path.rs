//! [`PedestrianPath`]: track of a pedestrian and the ground under it.

use crate::Ground;
use cosfly_domain::WalkableKind;
use cosfly_frames::TargetTrack;
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

/// The path of somebody on a track: the kind of the ground, read from the walkable ground (beside it, the kind before counts, at
/// first road), and standing where the speed is 0.
pub fn path_of(ground: Option<&Ground>, track: TargetTrack) -> PedestrianPath {
    let mut kinds: Vec<WalkableKind> = Vec::with_capacity(track.len());
    for state in &track.states {
        let under = ground.and_then(|ground| ground.at(state.feet_in_world.truncate(), state.feet_in_world.z));
        let kind = under.map(|(kind, _)| kind).or(kinds.last().copied());
        kinds.push(kind.unwrap_or(WalkableKind::Road));
    }
    let standing = track.states.iter().map(|state| state.speed_mps == 0.0).collect();
    PedestrianPath { track, ground: kinds, standing }
}
