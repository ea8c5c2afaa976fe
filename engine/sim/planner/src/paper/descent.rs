//! Adaptive descent on the nine terms (paper, section 3.3, "Optimization").

use crate::config::DescentConfig;
use crate::gradient::total_gradient;
use crate::obstacles::local::LocalObstacles;
use crate::problem::Problem;
use cosfly_frames::DVec3;

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
