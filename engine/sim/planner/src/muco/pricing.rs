//! Costs of the lattice's nodes: the terms of the recipe, priced for one place at a time.

use super::lattice::Lattice;
use super::viterbi::NodeCosts;
use crate::config::muco::MucoConfig;
use crate::problem::Problem;
use crate::terms::place::PlaceCosts;
use crate::terms::viewpoint;
use cosfly_frames::{DVec3, real};
use cosfly_surroundings::local::LocalObstacles;

/// Cost of a viewpoint outside the sector behind the walker.
const OUTSIDE_SECTOR: f64 = 30.0;
/// Visibility weighs this much more than in the sum of the terms, because a node is all or nothing.
const VISIBILITY_FACTOR: f64 = 4.0;
/// Terms that the search prices in its own way, node by node or move by move.
const PRICED: [&str; 9] =
    ["tracking", "smoothness", "jerk", "safety", "visibility", "viewpoint", "pitch", "altitude", "length"];

/// Costs of all nodes in the layers of `frames`, without obstacles and without a given start.
pub(super) fn node_costs(
    problem: &Problem<'_>,
    obstacles: &LocalObstacles<'_>,
    lattice: &Lattice,
    frames: &[usize],
    config: &MucoConfig,
) -> NodeCosts {
    let weights = config.resolved_weights();
    let places = PlaceCosts { weights, view: problem.view };
    let ring = |ring: usize| {
        let (up, across) = lattice.ring_m(ring);
        (places.sight(DVec3::new(across, 0.0, up)) + places.altitude(up, up)) as f32
    };
    let sector = real::cos(config.view.rear_sector_deg.to_radians());
    let azimuth = |frame: usize, direction: &DVec3| {
        let cosine = direction.truncate().dot(problem.walk.direction[frame]);
        let outside = -cosine < sector - 1e-9 && problem.walk.directness[frame] > 0.0;
        let front = weights.viewpoint * viewpoint::front_cost(cosine) * problem.walk.directness[frame];
        (front + if outside { OUTSIDE_SECTOR } else { 0.0 }) as f32
    };
    NodeCosts {
        hidden: [0.7 / 8.0, 0.3 / 64.0].map(|share| (VISIBILITY_FACTOR * weights.visibility * share) as f32),
        close: (4.0 * weights.safety) as f32,
        ring: (0..lattice.rings()).map(ring).collect(),
        azimuth: frames.iter().map(|&f| lattice.directions.iter().map(|d| azimuth(f, d)).collect()).collect(),
        first: Vec::new(),
        extra: extra_costs(problem, obstacles, lattice, frames),
    }
}

/// All other terms join the search as the cost of hovering at each node throughout.
fn extra_costs(
    problem: &Problem<'_>,
    obstacles: &LocalObstacles<'_>,
    lattice: &Lattice,
    frames: &[usize],
) -> Vec<Vec<f32>> {
    let priced = |index: usize, name: &str| index < problem.built_in && PRICED.contains(&name);
    let terms = problem.terms.iter().enumerate().filter(|(index, term)| !priced(*index, term.term.name()));
    let extra: Vec<_> = terms.map(|(_, term)| term).filter(|term| term.weight > 0.0).collect();
    if extra.is_empty() {
        return Vec::new();
    }
    let mut costs = vec![vec![0.0_f32; lattice.nodes()]; frames.len()];
    let context = problem.context(obstacles);
    let mut per_frame = vec![0.0; problem.track.len()];
    for node in 0..lattice.nodes() {
        let offset = lattice.offset(node);
        let hover: Vec<DVec3> = problem.track.states.iter().map(|state| state.feet_in_world + offset).collect();
        for weighted in &extra {
            weighted.term.cost(&hover, &context, &mut per_frame);
            for (layer, &frame) in costs.iter_mut().zip(frames) {
                let cost = (weighted.weight * per_frame[frame]) as f32;
                layer[node] += if cost.is_finite() { cost } else { 0.0 };
            }
        }
    }
    costs
}

/// Costs of the first layer's nodes when the drone is at `start` then: by the way there, as in a move to the side, and
/// forbidden where that way is not free.
pub(super) fn start_costs(
    lattice: &Lattice,
    obstacles: &LocalObstacles<'_>,
    frame: usize,
    feet: DVec3,
    start: DVec3,
    (per_square_m, keep_m): (f64, f64),
) -> Vec<f32> {
    let cost = |node: usize| {
        let place = feet + lattice.offset(node);
        if obstacles.segment_clearance_m(frame, start, place, keep_m) < keep_m {
            return f32::INFINITY;
        }
        (per_square_m * place.distance_squared(start)) as f32
    };
    (0..lattice.nodes()).map(cost).collect()
}
