//! Flights as `cosfly run` makes them: pedestrians walk the town, the planner follows.

use super::views::{Ground, View};
use cosfly_domain::PlanOutcome;
use cosfly_figures::{BodyFigure, BodyShape, gait_phase_rad};
use cosfly_frames::TargetState;
use cosfly_geometry::BoxBvh;
use cosfly_pedestrians::{PedestrianConfig, WalkableGrid, walk};
use cosfly_planner::{MucoConfig, plan};
use cosfly_random::Seed;
use cosfly_town::GroundIndex;

/// Expert flights behind `count` walkers, `frames` frames each, with the defaults of all recipes. Empty in a town
/// without walkable ground.
pub fn flown(ground: &Ground, frames: usize, count: u64) -> Vec<Vec<View>> {
    let town = &ground.town;
    let steps = u32::try_from(frames).unwrap_or(u32::MAX);
    let least = PedestrianConfig::default().frames;
    let config = PedestrianConfig { frames: steps.max(least), ..PedestrianConfig::default() };
    let Ok(grid) = WalkableGrid::build(town, &config) else { return vec![] };
    let exact = BoxBvh::build(town.obstacles.iter().map(|obstacle| obstacle.shape).collect());
    let index = GroundIndex::new(town);
    let height = |x: f64, y: f64| index.ground_height_m(x, y).unwrap_or(0.0);
    // Walks without a feasible flight are skipped.
    let flight = |number: u64| {
        let seed = Seed([3; 32]).child("flights", number);
        let path = walk(&grid, &config, seed).ok()?;
        match plan(&path.track, &exact, &town.planning_boxes, &height, &MucoConfig::default(), seed) {
            PlanOutcome::Planned(flight) => {
                let track = &flight.track;
                let walked_m = walked_m(&track.states);
                let shown = flight.poses_in_world.iter().zip(&track.states).zip(walked_m);
                let view = |((pose, state), walked_m): ((&_, &TargetState), f64)| View {
                    pose: *pose,
                    target: BodyFigure {
                        state: *state,
                        height_m: track.height_m,
                        radius_m: track.radius_m,
                        clothes_seed: seed,
                        gait_phase_rad: gait_phase_rad(walked_m, track.height_m),
                        body: BodyShape::default(),
                    },
                };
                Some(shown.take(frames).map(view).collect())
            }
            PlanOutcome::Rejected { .. } => None,
        }
    };
    (0..4 * count).filter_map(flight).take(count as usize).collect()
}

/// Distance walked up to each state, metres.
fn walked_m(states: &[TargetState]) -> impl Iterator<Item = f64> {
    let mut before = states.first().map(|state| state.feet_in_world);
    states.iter().scan(0.0, move |sum_m, state| {
        *sum_m += before.replace(state.feet_in_world).map_or(0.0, |feet| (state.feet_in_world - feet).length());
        Some(*sum_m)
    })
}
