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

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::OrientedBox;
    use cosfly_env::{FlightSite, Start};
    use cosfly_frames::{Seed, TargetState, TargetTrack};
    use std::sync::Arc;

    /// A target that stands for 2 s, 20 m from a drone at a height of 20 m, among boxes.
    fn among(boxes: Vec<OrientedBox>) -> f64 {
        let state = TargetState { feet_in_world: 20.0 * DVec3::X, heading_rad: 0.0, speed_mps: 0.0 };
        hidden_views(&Episode {
            name: String::new(),
            stratum: String::new(),
            place: Arc::new(FlightSite::on_flat_ground(boxes)),
            target: Arc::new(TargetTrack { dt_s: 0.5, height_m: 1.7, radius_m: 0.25, states: vec![state; 5] }),
            followed: None,
            looks: Seed([0; 32]),
            weather: None,
            others: Arc::default(),
            start: Start { position_in_world: 20.0 * DVec3::Z, velocity_in_world: DVec3::ZERO },
            seed: Seed([0; 32]),
        })
    }

    #[test]
    fn a_wall_hides_a_target_from_one_side_and_a_roof_from_all() {
        assert_eq!(among(vec![]), 0.0);
        // Five bearings of twelve lie behind the wall, to the left.
        let wall = OrientedBox::from_corners(DVec3::new(-500.0, -3.0, 0.0), DVec3::new(500.0, -2.0, 60.0));
        assert!((among(vec![wall]) - 5.0 / 12.0).abs() < 1e-9, "{}", among(vec![wall]));
        let roof = OrientedBox::from_corners(DVec3::new(-500.0, -500.0, 3.0), DVec3::new(500.0, 500.0, 4.0));
        assert!((among(vec![roof]) - 1.0).abs() < 1e-9);
    }
}
