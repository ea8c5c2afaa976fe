//! The way through the polar lattice with nothing after it: what the global search alone is worth.

use super::input::{BaselineInput, BaselinePath};
use crate::error::PlanError;
use crate::muco::attempts::full_effort;
use crate::muco::search::search;
use cosfly_surroundings::local::LocalObstacles;

/// The cheapest way through the lattice of the recipe.
pub fn lattice_path(input: &BaselineInput<'_>) -> Result<BaselinePath, PlanError> {
    let (track, config) = (input.problem.track, input.config);
    let influence_m = config.view.safety_influence_m;
    let radius_m = config.search.filter_radius_m;
    let obstacles = LocalObstacles::filter(track, input.planning_boxes, input.ground, radius_m, influence_m)
        .with_movers(input.movers);
    let waypoints =
        search(input.problem, &obstacles, config, full_effort(config), &[], &mut Default::default())?.waypoints;
    let cost = input.problem.cost(&obstacles, &waypoints);
    Ok(BaselinePath { waypoints, nodes_expanded: 0, cost })
}
