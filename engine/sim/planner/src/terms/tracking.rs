//! Tracking distance (paper, appendix A.1): squared departure from the best observation distance.

use super::term::{CostTerm, TermContext};
use crate::equations::NormalEquations;
use cosfly_frames::DVec3;

/// `(|w - p| - d_opt)^2`, with p the point between the target's feet.
pub struct Tracking;

/// The cost at a distance, both in metres.
pub fn distance_cost(distance_m: f64, best_m: f64) -> f64 {
    (distance_m - best_m) * (distance_m - best_m)
}

impl CostTerm for Tracking {
    fn name(&self) -> &str {
        "tracking"
    }

    fn support(&self) -> usize {
        0
    }

    fn cost(&self, waypoints: &[DVec3], context: &TermContext<'_>, per_frame: &mut [f64]) {
        for ((waypoint, state), cost) in waypoints.iter().zip(&context.track.states).zip(per_frame) {
            *cost = distance_cost(waypoint.distance(state.feet_in_world), context.view.distance_m);
        }
    }

    fn add_gradient(
        &self,
        waypoints: &[DVec3],
        context: &TermContext<'_>,
        weight: f64,
        gradient: &mut [DVec3],
    ) -> bool {
        for ((waypoint, state), slope) in waypoints.iter().zip(&context.track.states).zip(gradient) {
            let sight = waypoint - state.feet_in_world;
            let distance = sight.length();
            if distance > 1e-9 {
                *slope += weight * 2.0 * (distance - context.view.distance_m) / distance * sight;
            }
        }
        true
    }

    fn add_residuals(
        &self,
        waypoints: &[DVec3],
        context: &TermContext<'_>,
        weight: f64,
        equations: &mut NormalEquations,
    ) -> bool {
        for (frame, (waypoint, state)) in waypoints.iter().zip(&context.track.states).enumerate() {
            let sight = waypoint - state.feet_in_world;
            let distance = sight.length();
            if distance > 1e-9 {
                equations.add(frame, weight, distance - context.view.distance_m, sight / distance);
            }
        }
        true
    }
}
