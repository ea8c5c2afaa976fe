//! A* made flyable: its staircase smoothed to the limits by the same judge, in the same corridor, as our flights.

use super::input::{BaselineInput, BaselinePath};
use crate::muco::judge::Judge;
use crate::muco::smoother::Objective;
use cosfly_surroundings::exact::ExactMap;
use cosfly_surroundings::local::LocalObstacles;

/// Near the voxels' middles, but loosely.
const OBJECTIVE: Objective = Objective { rounds: 4, iterations: 160, nearness: 0.05, acceleration: 0.5, jerk: 2.0 };

/// Smooths a found path to the limits of `config`.
pub fn made_flyable(input: &BaselineInput<'_>, found: BaselinePath) -> BaselinePath {
    let (track, config) = (input.problem.track, input.config);
    let (radius_m, influence_m) = (config.search.filter_radius_m, config.view.safety_influence_m);
    let mut obstacles = LocalObstacles::filter(track, input.planning_boxes, input.ground, radius_m, influence_m)
        .with_movers(input.movers);
    obstacles.focus_on(&found.waypoints);
    let ground = |x: f64, y: f64| input.ground.z_m(x, y);
    let mut judge = Judge::new(input.problem, ExactMap::among(input.exact, input.movers), &ground, config, &[]);
    let (waypoints, _) = judge.make_flyable(&obstacles, &found.waypoints, &found.waypoints, OBJECTIVE);
    BaselinePath { waypoints, ..found }
}
