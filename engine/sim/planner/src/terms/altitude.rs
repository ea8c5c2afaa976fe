//! Altitude (paper, appendix A.1): a strong penalty below the band, a light one above it, and oscillation.

use super::term::{CostTerm, TermContext};
use crate::equations::NormalEquations;
use cosfly_frames::DVec3;

/// With h the height above the ground under the target: `0.01 (h - h_pref)^2` above h_pref, and
/// `(h_min - h)^2` below h_min, where h is then the smaller of the heights above the ground under the target
/// and under the drone. Where the climbs before and after a frame have opposite signs, half the smaller climb on
/// top. The paper names the three parts without their sizes; these are ours.
pub struct Altitude;

/// The cost of a height above the ground, metres, without the oscillation part.
pub fn band_cost(height_m: f64, lowest_height_m: f64, min_m: f64, preferred_m: f64) -> f64 {
    let (below, above) = ((min_m - lowest_height_m).max(0.0), (height_m - preferred_m).max(0.0));
    below * below + 0.01 * above * above
}

fn heights(waypoint: DVec3, frame: usize, context: &TermContext<'_>) -> (f64, f64) {
    let over_target = waypoint.z - context.track.states[frame].feet_in_world.z;
    let over_ground = waypoint.z - context.surroundings.ground_z_m(waypoint.x, waypoint.y);
    (over_target, over_target.min(over_ground))
}

impl CostTerm for Altitude {
    fn name(&self) -> &str {
        "altitude"
    }

    fn support(&self) -> usize {
        1
    }

    fn cost(&self, waypoints: &[DVec3], context: &TermContext<'_>, per_frame: &mut [f64]) {
        for (frame, (&waypoint, cost)) in waypoints.iter().zip(per_frame.iter_mut()).enumerate() {
            let (height, lowest) = heights(waypoint, frame, context);
            *cost = band_cost(height, lowest, context.view.min_altitude_m, context.view.preferred_altitude_m);
        }
        for (i, w) in waypoints.windows(3).enumerate() {
            let (before, after) = (w[1].z - w[0].z, w[2].z - w[1].z);
            if before * after < 0.0 {
                per_frame[i + 1] += 0.5 * before.abs().min(after.abs());
            }
        }
    }

    fn add_gradient(
        &self,
        waypoints: &[DVec3],
        context: &TermContext<'_>,
        weight: f64,
        gradient: &mut [DVec3],
    ) -> bool {
        // The slope of the ground itself is left out: it is small beside the vertical part.
        for (frame, (&waypoint, slope)) in waypoints.iter().zip(gradient.iter_mut()).enumerate() {
            let (height, lowest) = heights(waypoint, frame, context);
            let below = (context.view.min_altitude_m - lowest).max(0.0);
            let above = (height - context.view.preferred_altitude_m).max(0.0);
            slope.z += weight * (0.02 * above - 2.0 * below);
        }
        for (i, w) in waypoints.windows(3).enumerate() {
            let (before, after) = (w[1].z - w[0].z, w[2].z - w[1].z);
            if before * after >= 0.0 {
                continue;
            }
            let (low, high, climb) =
                if before.abs() < after.abs() { (i, i + 1, before) } else { (i + 1, i + 2, after) };
            let step = 0.5 * weight * climb.signum();
            gradient[high].z += step;
            gradient[low].z -= step;
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
        for (frame, &waypoint) in waypoints.iter().enumerate() {
            let (height, lowest) = heights(waypoint, frame, context);
            let below = (context.view.min_altitude_m - lowest).max(0.0);
            let above = (height - context.view.preferred_altitude_m).max(0.0);
            if below > 0.0 {
                equations.add(frame, weight, below, -DVec3::Z);
            }
            if above > 0.0 {
                equations.add(frame, 0.01 * weight, above, DVec3::Z);
            }
        }
        true
    }
}
