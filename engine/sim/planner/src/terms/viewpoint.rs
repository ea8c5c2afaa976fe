//! Viewpoint (paper, section 3.2): prefer to be behind a target that walks steadily.

use super::term::{CostTerm, TermContext};
use cosfly_frames::{DVec2, DVec3};

/// `f(c) d` with c the cosine between "target to drone" (seen from above) and the walking direction, d the
/// directness of the walk, and f(c) = ((1 + c) / 2)^2: the paper leaves f open, and only an f that rises
/// from 0 behind the walker (c = -1) to 1 in front agrees with its rear start.
pub struct Viewpoint;

/// f of the cosine.
pub fn front_cost(cosine: f64) -> f64 {
    0.25 * (1.0 + cosine) * (1.0 + cosine)
}

fn toward_drone(waypoint: DVec3, feet: DVec3) -> Option<(DVec2, f64)> {
    let sight = (waypoint - feet).truncate();
    let length = sight.length();
    (length > 1e-6).then(|| (sight / length, length))
}

impl CostTerm for Viewpoint {
    fn name(&self) -> &str {
        "viewpoint"
    }

    fn support(&self) -> usize {
        0
    }

    fn cost(&self, waypoints: &[DVec3], context: &TermContext<'_>, per_frame: &mut [f64]) {
        for (frame, (&waypoint, cost)) in waypoints.iter().zip(per_frame).enumerate() {
            let toward = toward_drone(waypoint, context.track.states[frame].feet_in_world);
            *cost = toward.map_or(0.0, |(unit, _)| {
                front_cost(unit.dot(context.walk.direction[frame])) * context.walk.directness[frame]
            });
        }
    }

    fn add_gradient(
        &self,
        waypoints: &[DVec3],
        context: &TermContext<'_>,
        weight: f64,
        gradient: &mut [DVec3],
    ) -> bool {
        for (frame, (&waypoint, slope)) in waypoints.iter().zip(gradient).enumerate() {
            if let Some((unit, length)) = toward_drone(waypoint, context.track.states[frame].feet_in_world) {
                let walk = context.walk.direction[frame];
                let cosine = unit.dot(walk);
                let scale = weight * 0.5 * (1.0 + cosine) * context.walk.directness[frame] / length;
                *slope += (scale * (walk - cosine * unit)).extend(0.0);
            }
        }
        true
    }
}
