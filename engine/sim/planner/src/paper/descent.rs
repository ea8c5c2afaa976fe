//! Gradient descent with an adaptive rate and clipped displacements (paper, section 3.3, "Optimization").

use super::differences::{Threads, context, gradient};
use super::focus::FocusedSurroundings;
use crate::config::descent::DescentConfig;
use crate::gradient::total_cost;
use crate::problem::Problem;
use cosfly_frames::DVec3;
use cosfly_surroundings::Surroundings;

/// Growth of the learning rate after a step that lowered the cost ("slowly recovering").
const RECOVERY: f64 = 1.05;

/// Result of a descent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Descent {
    /// Total cost at the start and after each iteration; it never rises.
    pub costs: Vec<f64>,
    /// Gradients that were computed; a step taken back leaves the waypoints, and so their gradient, as they were.
    pub gradients: u32,
    /// Steps that raised the cost.
    pub steps_taken_back: u32,
}

/// Moves `waypoints` downhill: a step that raises the cost is taken back and the rate halved, one that lowers it lets
/// the rate recover up to its start; no waypoint moves further than the configured displacement in one iteration.
/// Ends when the rate has fallen below its least value, or after the configured number of iterations.
pub fn descend(
    problem: &Problem<'_>,
    surroundings: &mut dyn FocusedSurroundings,
    config: &DescentConfig,
    threads: Threads,
    waypoints: &mut Vec<DVec3>,
) -> Descent {
    surroundings.focus_on(waypoints);
    let mut cost = total_cost(problem.terms, waypoints, &context(problem, surroundings.answers()));
    let mut descent = Descent { costs: vec![cost], ..Descent::default() };
    let mut rate = config.rate;
    let mut slope: Option<Vec<DVec3>> = None;
    for _ in 0..config.iterations {
        if rate < config.min_rate || !cost.is_finite() {
            break;
        }
        let slope_here = slope.get_or_insert_with(|| {
            descent.gradients += 1;
            gradient(problem, surroundings.answers(), config.difference_m, threads, waypoints)
        });
        let candidate = stepped(waypoints, slope_here, rate, config.max_move_m);
        surroundings.focus_on(&candidate);
        let candidate_cost = total_cost(problem.terms, &candidate, &context(problem, surroundings.answers()));
        if candidate_cost < cost {
            *waypoints = candidate;
            cost = candidate_cost;
            rate = (rate * RECOVERY).min(config.rate);
            slope = None;
        } else {
            rate *= 0.5;
            descent.steps_taken_back += 1;
        }
        descent.costs.push(cost);
    }
    descent
}

fn stepped(waypoints: &[DVec3], slope: &[DVec3], rate: f64, max_move_m: f64) -> Vec<DVec3> {
    let step = |(w, g): (&DVec3, &DVec3)| {
        let step = (-rate * *g).clamp_length_max(max_move_m);
        if step.is_finite() { *w + step } else { *w }
    };
    waypoints.iter().zip(slope).map(step).collect()
}

/// The result of one [`iteration`].
#[derive(Clone, Debug, PartialEq)]
pub struct Iteration {
    /// The waypoints after the step, whether or not it lowers the cost.
    pub waypoints: Vec<DVec3>,
    /// Total cost of the waypoints.
    pub cost: f64,
}

/// One iteration as the paper times it: a gradient, a step at the first rate, and the cost of where it leads. In any
/// surroundings, so that trees, filters and brute force can be compared.
pub fn iteration(
    problem: &Problem<'_>,
    surroundings: &(dyn Surroundings + Sync),
    config: &DescentConfig,
    threads: Threads,
    waypoints: &[DVec3],
) -> Iteration {
    let slope = gradient(problem, surroundings, config.difference_m, threads, waypoints);
    let waypoints = stepped(waypoints, &slope, config.rate, config.max_move_m);
    let cost = total_cost(problem.terms, &waypoints, &context(problem, surroundings));
    Iteration { waypoints, cost }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::with_street;
    use super::*;

    #[test]
    fn the_cost_never_rises_and_no_waypoint_moves_further_than_allowed() {
        with_street(|problem, obstacles, config, path| {
            let mut before = path.clone();
            let whole = descend(problem, obstacles, &config.descent, Threads::Caller, path);
            assert!(whole.costs.windows(2).all(|pair| pair[1] <= pair[0]));
            assert!(whole.costs.last() < whole.costs.first());
            assert!((whole.gradients as usize) < whole.costs.len());
            let one = DescentConfig { iterations: 1, ..config.descent.clone() };
            let mut after = before.clone();
            for _ in 0..5 {
                descend(problem, obstacles, &one, Threads::Caller, &mut after);
                assert!(before.iter().zip(&after).all(|(a, b)| a.distance(*b) <= 0.5 + 1e-12));
                before.clone_from(&after);
            }
        });
    }

    #[test]
    fn a_descent_of_no_waypoints_ends() {
        with_street(|problem, obstacles, config, _| {
            let descent = descend(problem, obstacles, &config.descent, Threads::Caller, &mut Vec::new());
            assert_eq!(descent.costs[0], 0.0);
        });
    }

    #[test]
    fn one_iteration_is_the_descents_first_step() {
        with_street(|problem, obstacles, config, path| {
            obstacles.focus_on(path);
            let one = iteration(problem, &*obstacles, &config.descent, Threads::Caller, path);
            let once = DescentConfig { iterations: 1, ..config.descent.clone() };
            let descent = descend(problem, obstacles, &once, Threads::Caller, path);
            if one.cost < descent.costs[0] {
                assert_eq!((one.cost, &one.waypoints), (descent.costs[1], &*path));
            }
        });
    }
}
