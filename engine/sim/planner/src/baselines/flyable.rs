//! A* made flyable: its staircase smoothed to the limits by the same programme, in the same corridor, as our flights.

use super::{BaselineInput, BaselinePath};
use crate::muco::corridor::CorridorInput;
use crate::muco::smoother::{Objective, smooth};
use crate::obstacles::local::LocalObstacles;

/// Near the voxels' middles, but loosely.
const OBJECTIVE: Objective = Objective { rounds: 4, iterations: 160, nearness: 0.05, acceleration: 0.5, jerk: 2.0 };
/// Distance kept beyond the limit while smoothing, metres.
const KEEP_OUT_EXTRA_M: f64 = 0.1;

/// Smooths a found path to the limits of `config`.
pub fn made_flyable(input: &BaselineInput<'_>, found: BaselinePath) -> BaselinePath {
    let (track, config) = (input.problem.track, input.config);
    let (radius_m, influence_m) = (config.search.filter_radius_m, config.view.safety_influence_m);
    let mut obstacles = LocalObstacles::filter(track, input.planning_boxes, input.ground, radius_m, influence_m);
    obstacles.focus_on(&found.waypoints);
    let learned = vec![Vec::new(); found.waypoints.len()];
    let corridor = CorridorInput {
        track,
        obstacles: &obstacles,
        keep_out_m: config.limits.clearance_m + KEEP_OUT_EXTRA_M,
        min_altitude_m: config.view.min_altitude_m,
        wished: &found.waypoints,
        learned: &learned,
        head: &[],
    };
    let smoothed = smooth(&corridor, &found.waypoints, &config.stated_limits(), OBJECTIVE);
    BaselinePath { waypoints: smoothed.waypoints, ..found }
}
