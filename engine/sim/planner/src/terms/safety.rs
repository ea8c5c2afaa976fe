//! Safety (paper, appendix A.1): a soft push away from obstacles within the influence radius.

use super::term::{CostTerm, TermContext};
use crate::equations::NormalEquations;
use cosfly_frames::DVec3;

/// `0.5 (d_inf - d)^2` where the nearest obstacle is closer than `d_inf`; d is negative inside.
pub struct Safety;

impl CostTerm for Safety {
    fn name(&self) -> &str {
        "safety"
    }

    fn support(&self) -> usize {
        0
    }

    fn cost(&self, waypoints: &[DVec3], context: &TermContext<'_>, per_frame: &mut [f64]) {
        let influence = context.view.safety_influence_m;
        for (frame, (&waypoint, cost)) in waypoints.iter().zip(per_frame).enumerate() {
            let nearest = context.surroundings.nearest(frame, waypoint, influence);
            *cost = nearest.map_or(0.0, |(distance, _)| 0.5 * (influence - distance) * (influence - distance));
        }
    }

    fn add_gradient(
        &self,
        waypoints: &[DVec3],
        context: &TermContext<'_>,
        weight: f64,
        gradient: &mut [DVec3],
    ) -> bool {
        let influence = context.view.safety_influence_m;
        for (frame, (&waypoint, slope)) in waypoints.iter().zip(gradient).enumerate() {
            if let Some((distance, away)) = context.surroundings.nearest(frame, waypoint, influence) {
                *slope -= weight * (influence - distance) * away;
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
        let influence = context.view.safety_influence_m;
        for (frame, &waypoint) in waypoints.iter().enumerate() {
            if let Some((distance, away)) = context.surroundings.nearest(frame, waypoint, influence) {
                equations.add(frame, 0.5 * weight, influence - distance, -away);
            }
        }
        true
    }
}
