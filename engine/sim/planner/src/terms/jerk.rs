//! Jerk (paper, section 3.2): squared third differences, in metres per frame^3.

use super::term::{CostTerm, TermContext};
use crate::equations::NormalEquations;
use cosfly_frames::DVec3;

/// `|w[i+2] - 3 w[i+1] + 3 w[i] - w[i-1]|^2`; the first and the last two frames have none.
pub struct Jerk;

impl CostTerm for Jerk {
    fn name(&self) -> &str {
        "jerk"
    }

    fn support(&self) -> usize {
        2
    }

    fn cost(&self, waypoints: &[DVec3], _context: &TermContext<'_>, per_frame: &mut [f64]) {
        per_frame.fill(0.0);
        for (i, w) in waypoints.windows(4).enumerate() {
            per_frame[i + 1] = (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).length_squared();
        }
    }

    fn add_gradient(&self, waypoints: &[DVec3], _: &TermContext<'_>, weight: f64, gradient: &mut [DVec3]) -> bool {
        for (i, w) in waypoints.windows(4).enumerate() {
            let jerk = 2.0 * weight * (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]);
            gradient[i] -= jerk;
            gradient[i + 1] += 3.0 * jerk;
            gradient[i + 2] -= 3.0 * jerk;
            gradient[i + 3] += jerk;
        }
        true
    }

    fn add_residuals(
        &self,
        waypoints: &[DVec3],
        _context: &TermContext<'_>,
        weight: f64,
        equations: &mut NormalEquations,
    ) -> bool {
        equations.add_differences(3, weight, waypoints);
        true
    }
}
