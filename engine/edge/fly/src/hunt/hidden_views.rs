//! [`hidden_views`]: how much of the air around a target has no sight of it.
//!
//! Scouts tell where one way of flying loses the target. A policy that plans loses it where there are few other ways.

use cosfly_env::Episode;
use cosfly_frames::{DVec3, real};
use std::f64::consts::TAU;

/// Bearings of the views.
const BEARINGS: u32 = 12;
/// Heights of the views, shares of the start's height above the target.
const HEIGHTS: [f64; 3] = [0.4, 1.0, 1.6];
/// Time between views, seconds.
const EVERY_S: f64 = 1.0;

/// Share of the target that is hidden, 0..=1: mean over the seconds of the episode and views from all sides, at the start's distance.
pub(super) fn hidden_views(episode: &Episode) -> f64 {
    let from_target = episode.start.position_in_world - episode.target_at(0.0).feet_in_world;
    let distance_m = from_target.truncate().length();
    let seconds = (episode.target.duration_s() / EVERY_S + 1e-9) as u32;
    let mut seen = 0.0;
    for time_s in (0..=seconds).map(|second| f64::from(second) * EVERY_S) {
        let target = episode.target_at(time_s);
        for (height, bearing) in HEIGHTS.into_iter().flat_map(|height| (0..BEARINGS).map(move |at| (height, at))) {
            let (sin, cos) = real::sin_cos(TAU * f64::from(bearing) / f64::from(BEARINGS));
            let away = DVec3::new(distance_m * cos, distance_m * sin, from_target.z * height);
            seen += episode.visible(time_s, target.feet_in_world + away, &target);
        }
    }
    1.0 - seen / (f64::from(seconds + 1) * HEIGHTS.len() as f64 * f64::from(BEARINGS))
}
