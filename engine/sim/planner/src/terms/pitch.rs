//! Pitch (paper, appendix A.1): piecewise quadratic around the target pitch, in degrees.

use super::term::{CostTerm, TermContext};
use crate::equations::NormalEquations;
use cosfly_frames::{DVec3, real};

/// 0.02 (theta - 45)^2 between 30 and 60 degrees below the horizon; beyond, 0.5 (theta - 60)^2 and
/// 0.2 (30 - theta)^2 on top of the 4.5 that the middle branch has reached. The paper prints the outer
/// branches without that offset, which would reward leaving the band. The band is 15 degrees to each side of
/// the configured pitch.
pub struct Pitch;

const HALF_BAND_DEG: f64 = 15.0;

/// (cost, its derivative by the angle) at an angle below the horizon, degrees.
pub fn pitch_cost(theta_deg: f64, best_deg: f64) -> (f64, f64) {
    let off = theta_deg - best_deg;
    let beyond = off.abs() - HALF_BAND_DEG;
    if beyond <= 0.0 {
        return (0.02 * off * off, 0.04 * off);
    }
    let factor = if off > 0.0 { 0.5 } else { 0.2 };
    (0.02 * HALF_BAND_DEG * HALF_BAND_DEG + factor * beyond * beyond, 2.0 * factor * beyond * off.signum())
}

/// Angle of the line of sight below the horizon, degrees.
pub fn pitch_below_horizon_deg(sight_to_drone: DVec3) -> f64 {
    real::atan2(sight_to_drone.z, real::hypot(sight_to_drone.x, sight_to_drone.y)).to_degrees()
}

impl CostTerm for Pitch {
    fn name(&self) -> &str {
        "pitch"
    }

    fn support(&self) -> usize {
        0
    }

    fn cost(&self, waypoints: &[DVec3], context: &TermContext<'_>, per_frame: &mut [f64]) {
        for ((waypoint, state), cost) in waypoints.iter().zip(&context.track.states).zip(per_frame) {
            let theta = pitch_below_horizon_deg(waypoint - state.feet_in_world);
            *cost = pitch_cost(theta, context.view.pitch_deg).0;
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
            let across = real::hypot(sight.x, sight.y);
            let squared = sight.length_squared();
            if across < 1e-6 {
                continue;
            }
            let by_angle = pitch_cost(pitch_below_horizon_deg(sight), context.view.pitch_deg).1;
            let scale = weight * by_angle * (180.0 / real::PI) / squared;
            *slope += scale * DVec3::new(-sight.z * sight.x / across, -sight.z * sight.y / across, across);
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
            let across = real::hypot(sight.x, sight.y);
            if across < 1e-6 {
                continue;
            }
            let degrees_per_m = (180.0 / real::PI) / sight.length_squared();
            let turn = degrees_per_m * DVec3::new(-sight.z * sight.x / across, -sight.z * sight.y / across, across);
            let off = pitch_below_horizon_deg(sight) - context.view.pitch_deg;
            // Half the slope divided by the curvature of the branch: the residual with the same square.
            let curvature = if off.abs() <= HALF_BAND_DEG {
                0.02
            } else if off > 0.0 {
                0.5
            } else {
                0.2
            };
            let slope = pitch_cost(off + context.view.pitch_deg, context.view.pitch_deg).1;
            equations.add(frame, weight * curvature, 0.5 * slope / curvature, turn);
        }
        true
    }
}
