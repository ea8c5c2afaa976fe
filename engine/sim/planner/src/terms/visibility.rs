//! Visibility (paper, section 3.2): the squared share of body points that the camera cannot see.

use super::{CostTerm, TermContext};
use cosfly_frames::DVec3;

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
}
