//! Frames of a walk on marked crossings.

use crate::sight::Landmarks;
use cosfly_frames::{DVec3, TargetState};
use std::ops::Range;

/// Runs of frames in which the target is on a marked crossing.
pub(super) fn crossings(states: &[TargetState], landmarks: &Landmarks) -> Vec<Range<usize>> {
    let feet: Vec<DVec3> = states.iter().map(|state| state.feet_in_world).collect();
    let near = landmarks.crossings_near(&feet, 0.0);
    let is_on: Vec<bool> = feet.iter().map(|point| near.iter().any(|crossing| crossing.holds(*point))).collect();
    let frames: Vec<usize> = (0..feet.len()).collect();
    let runs = frames.chunk_by(|a, b| is_on[*a] == is_on[*b]).filter(|run| is_on[run[0]]);
    runs.map(|run| run[0]..run[0] + run.len()).collect()
}
