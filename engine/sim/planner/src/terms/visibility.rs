//! Visibility (paper, section 3.2): the squared share of body points that the camera cannot see.

use super::term::{CostTerm, TermContext};
use crate::equations::NormalEquations;
use cosfly_frames::DVec3;
use cosfly_surroundings::local::GUARDED_POINTS;

/// Lines of sight are wished this far from the edge of a shadow, metres.
const MARGIN_M: f64 = 0.7;
/// A waypoint deeper in shadow than this is not pulled, metres: the way out is likely the wrong one.
const HOPELESS_M: f64 = 1.5;
/// Weight of a metre of shadow, squared, beside that of a hidden point.
const SIGHT_FACTOR: f64 = 3.0;

/// `(1 - v)^2`. A step function of the waypoint: the solver takes differences wide enough to cross an edge.
pub struct Visibility;

impl CostTerm for Visibility {
    fn name(&self) -> &str {
        "visibility"
    }

    fn support(&self) -> usize {
        0
    }

    fn cost(&self, waypoints: &[DVec3], context: &TermContext<'_>, per_frame: &mut [f64]) {
        for (frame, (&waypoint, cost)) in waypoints.iter().zip(per_frame).enumerate() {
            let hidden = 1.0 - context.surroundings.visibility(frame, waypoint);
            *cost = hidden * hidden;
        }
    }

    fn add_residuals(
        &self,
        waypoints: &[DVec3],
        context: &TermContext<'_>,
        weight: f64,
        equations: &mut NormalEquations,
    ) -> bool {
        // The share of hidden points is a step function; what is linear is how deep in shadow the waypoint is.
        let each = SIGHT_FACTOR * weight / GUARDED_POINTS.len() as f64;
        for (frame, &waypoint) in waypoints.iter().enumerate() {
            context.surroundings.shadows(frame, waypoint, &mut |slack_m, away| {
                if slack_m > -HOPELESS_M && slack_m < MARGIN_M {
                    equations.add(frame, each, MARGIN_M - slack_m, -away);
                }
            });
        }
        true
    }
}
