//! Plans with a baseline.

use super::astar::astar;
use super::baseline::Baseline;
use super::beam::{WIDTH, beam};
use super::flyable::made_flyable;
use super::grid::{VoxelGrid, VoxelOptions};
use super::input::{BaselineInput, BaselinePath};
use super::lattice_path::lattice_path;
use super::near_track::near_track;
use super::sight::StaticSight;
use crate::error::PlanError;
use crate::track_check::check_track;
use cosfly_domain::OrientedBox;
use cosfly_geometry::BoxBvh;

/// Plans one waypoint per frame.
///
/// # Errors
/// Why there is no path.
pub fn plan_baseline(kind: Baseline, input: &BaselineInput<'_>) -> Result<BaselinePath, PlanError> {
    plan_baseline_with(kind, input, VoxelOptions::default())
}

/// [`plan_baseline`] with other voxels.
pub fn plan_baseline_with(
    kind: Baseline,
    input: &BaselineInput<'_>,
    options: VoxelOptions,
) -> Result<BaselinePath, PlanError> {
    let (keep_m, influence_m) = distances_m(input);
    match kind {
        Baseline::AstarFast => plan_astar(input, options, BoxBvh::build),
        Baseline::AstarSmoothed => Ok(made_flyable(input, plan_astar(input, options, BoxBvh::build)?)),
        Baseline::Beam => {
            let grid = checked_grid(input, options)?;
            beam(&grid, &BoxBvh::build(near_boxes(input)), keep_m, influence_m, WIDTH)
        }
        Baseline::Dp => {
            check(input)?;
            lattice_path(input)
        }
    }
}

/// A* whose rays and distances are answered by what `tree` makes of the boxes near the track.
pub fn plan_astar<S: StaticSight>(
    input: &BaselineInput<'_>,
    options: VoxelOptions,
    tree: impl FnOnce(Vec<OrientedBox>) -> S,
) -> Result<BaselinePath, PlanError> {
    let (keep_m, influence_m) = distances_m(input);
    let grid = checked_grid(input, options)?;
    astar(&grid, &tree(near_boxes(input)), keep_m, influence_m)
}

/// The clearance limit and the reach of the safety term.
fn distances_m(input: &BaselineInput<'_>) -> (f64, f64) {
    (input.config.limits.clearance_m, input.config.view.safety_influence_m)
}

fn near_boxes(input: &BaselineInput<'_>) -> Vec<OrientedBox> {
    near_track(input.problem.track, input.planning_boxes, input.config.search.filter_radius_m)
}

fn checked_grid<'a>(input: &BaselineInput<'a>, options: VoxelOptions) -> Result<VoxelGrid<'a>, PlanError> {
    check(input)?;
    Ok(VoxelGrid::new(input.problem, input.ground, input.config, options)?.among(input.movers, input.config))
}

fn check(input: &BaselineInput<'_>) -> Result<(), PlanError> {
    input.config.validate().map_err(|(_, rule)| PlanError::Request(rule))?;
    check_track(input.problem.track, input.config.limits.speed_mps)
}
