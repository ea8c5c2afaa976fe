//! Adaptive descent on the nine terms (paper, section 3.3, "Optimization").

use super::gradient::{total_cost, total_gradient};
use crate::config::{DescentConfig, ViewConfig};
use crate::obstacles::local::LocalObstacles;
use crate::terms::{TermContext, WeightedTerm};
use crate::walk::Walk;
use cosfly_frames::{DVec3, TargetTrack};

/// What every part of the solver reads.
pub struct Problem<'a> {
    /// The target.
    pub track: &'a TargetTrack,
    /// Where the drone should be.
    pub view: &'a ViewConfig,
    /// Walking directions.
    pub walk: &'a Walk,
    /// The cost.
    pub terms: &'a [WeightedTerm],
    /// How many of the terms, from the first, are the paper's.
    pub built_in: usize,
}

impl<'a> Problem<'a> {
    /// What terms see with these obstacles.
    pub fn context<'b>(&self, obstacles: &'b LocalObstacles<'b>) -> TermContext<'b>
    where
        'a: 'b,
    {
        TermContext { track: self.track, view: self.view, walk: self.walk, surroundings: obstacles }
    }

    /// Total cost against the planning boxes.
    pub fn cost(&self, obstacles: &LocalObstacles<'_>, waypoints: &[DVec3]) -> f64 {
        total_cost(self.terms, waypoints, &self.context(obstacles))
    }
}

/// Growth of the learning rate after a step that lowered the cost.
const RECOVERY: f64 = 1.05;

/// Moves `waypoints` downhill: a step that raises the cost is taken back and the rate halved, one that lowers
/// it lets the rate recover slowly; no waypoint moves further than the configured displacement at once.
/// Returns the cost after each iteration.
pub fn descend(
    problem: &Problem<'_>,
    obstacles: &mut LocalObstacles<'_>,
    config: &DescentConfig,
    waypoints: &mut Vec<DVec3>,
) -> Vec<f64> {
    obstacles.focus_on(waypoints);
    let mut cost = problem.cost(obstacles, waypoints);
    let mut history = vec![cost];
    let mut rate = config.rate;
    let mut gradient = None;
    for _ in 0..config.iterations {
        if rate < config.min_rate || !cost.is_finite() {
            break;
        }
        let slope = gradient.get_or_insert_with(|| {
            total_gradient(problem.terms, waypoints, &problem.context(obstacles), config.difference_m)
        });
        let candidate: Vec<DVec3> = waypoints
            .iter()
            .zip(slope.iter())
            .map(|(w, g)| *w + (-rate * *g).clamp_length_max(config.max_move_m))
            .collect();
        obstacles.focus_on(&candidate);
        let new_cost = problem.cost(obstacles, &candidate);
        if new_cost < cost {
            *waypoints = candidate;
            cost = new_cost;
            rate = (rate * RECOVERY).min(config.rate);
            gradient = None;
        } else {
            rate *= 0.5;
        }
        history.push(cost);
    }
    history
}
