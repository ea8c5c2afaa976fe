//! Smoothness (paper, appendix A.1): squared second differences, an acceleration penalty in metres per frame^2.

use super::term::{CostTerm, TermContext};
use crate::equations::NormalEquations;
use cosfly_frames::DVec3;

/// `|w[i+1] - 2 w[i] + w[i-1]|^2`; the first and the last frame have none.
pub struct Smoothness;

impl CostTerm for Smoothness {
    fn name(&self) -> &str {
        "smoothness"
    }

    fn support(&self) -> usize {
        1
    }

    fn cost(&self, waypoints: &[DVec3], _context: &TermContext<'_>, per_frame: &mut [f64]) {
        per_frame.fill(0.0);
        for (i, w) in waypoints.windows(3).enumerate() {
            per_frame[i + 1] = (w[2] - 2.0 * w[1] + w[0]).length_squared();
        }
    }

    fn add_gradient(&self, waypoints: &[DVec3], _: &TermContext<'_>, weight: f64, gradient: &mut [DVec3]) -> bool {
        for (i, w) in waypoints.windows(3).enumerate() {
            let bend = 2.0 * weight * (w[2] - 2.0 * w[1] + w[0]);
            gradient[i] += bend;
            gradient[i + 1] -= 2.0 * bend;
            gradient[i + 2] += bend;
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
        equations.add_differences(2, weight, waypoints);
        true
    }
}
