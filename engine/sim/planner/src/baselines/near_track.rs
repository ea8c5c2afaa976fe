//! The boxes near a track, so that a tree holds no others.

use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec2, TargetTrack};

/// The boxes within `radius_m` (from above) of the track (paper, section 3.3: per-path obstacle filtering).
pub fn near_track(track: &TargetTrack, boxes: &[OrientedBox], radius_m: f64) -> Vec<OrientedBox> {
    // Runs of frames, so that a box far from the whole run is settled at once.
    let runs: Vec<(DVec2, DVec2, &[_])> = track
        .states
        .chunks(16)
        .map(|run| {
            let feet = || run.iter().map(|state| state.feet_in_world.truncate());
            let low = feet().fold(DVec2::INFINITY, DVec2::min);
            (low, feet().fold(DVec2::NEG_INFINITY, DVec2::max), run)
        })
        .collect();
    let gap = |low: DVec2, high: DVec2, other_low: DVec2, other_high: DVec2| {
        (low - other_high).max(other_low - high).max(DVec2::ZERO).length_squared()
    };
    let near = |shape: &&OrientedBox| {
        let (min, max) = shape.bounds_in_world();
        let (min, max) = (min.truncate(), max.truncate());
        runs.iter().any(|&(low, high, run)| {
            gap(min, max, low, high) <= radius_m * radius_m
                && run.iter().any(|state| {
                    let feet = state.feet_in_world.truncate();
                    gap(min, max, feet, feet) <= radius_m * radius_m
                })
        })
    };
    boxes.iter().filter(near).copied().collect()
}
