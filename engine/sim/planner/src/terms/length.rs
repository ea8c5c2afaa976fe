//! Path length (paper, appendix A.1): a tenth of the way from the frame before.

use super::term::{CostTerm, TermContext};
use cosfly_frames::DVec3;

/// Cost of a metre flown, before the weight.
pub const COST_PER_M: f64 = 0.1;

/// `0.1 |w[i] - w[i-1]|`; the first frame has none.
pub struct Length;

impl CostTerm for Length {
    fn name(&self) -> &str {
        "length"
    }

    fn support(&self) -> usize {
        1
    }

    fn cost(&self, waypoints: &[DVec3], _context: &TermContext<'_>, per_frame: &mut [f64]) {
        per_frame.fill(0.0);
        for (i, w) in waypoints.windows(2).enumerate() {
            per_frame[i + 1] = COST_PER_M * w[1].distance(w[0]);
        }
    }

    fn add_gradient(&self, waypoints: &[DVec3], _: &TermContext<'_>, weight: f64, gradient: &mut [DVec3]) -> bool {
        for (i, w) in waypoints.windows(2).enumerate() {
            let along = COST_PER_M * weight * (w[1] - w[0]).normalize_or_zero();
            gradient[i] -= along;
            gradient[i + 1] += along;
        }
        true
    }
}
