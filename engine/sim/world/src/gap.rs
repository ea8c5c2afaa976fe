//! [`gap_m`]: the distance between two bodies seen from above.

use cosfly_domain::BodyPlan;
use cosfly_frames::{DVec2, TargetState, real};

/// Distance between two bodies seen from above, metres; negative where they overlap. Exact for two cylinders and for a
/// cylinder beside a box; for two boxes the largest gap along one of their axes, which is negative exactly where they overlap.
pub fn gap_m(body: &BodyPlan, state: &TargetState, other: &BodyPlan, other_state: &TargetState) -> f64 {
    let between = (other_state.feet_in_world - state.feet_in_world).truncate();
    match (body.kind.is_person(), other.kind.is_person()) {
        (true, true) => between.length() - body.radius_m() - other.radius_m(),
        (false, true) => plan_distance_m(body, state, between) - other.radius_m(),
        (true, false) => plan_distance_m(other, other_state, -between) - body.radius_m(),
        (false, false) => {
            let axes = [axes(state), axes(other_state)];
            let gap = |axis: DVec2| {
                let reach = |plan: &BodyPlan, [along, across]: [DVec2; 2]| {
                    0.5 * (plan.size_m.x * axis.dot(along).abs() + plan.size_m.y * axis.dot(across).abs())
                };
                axis.dot(between).abs() - reach(body, axes[0]) - reach(other, axes[1])
            };
            axes.into_iter().flatten().map(gap).fold(f64::NEG_INFINITY, f64::max)
        }
    }
}

/// Unit vectors along and across the body seen from above.
fn axes(state: &TargetState) -> [DVec2; 2] {
    let (sin, cos) = real::sin_cos(state.heading_rad);
    [DVec2::new(cos, sin), DVec2::new(-sin, cos)]
}

/// Signed distance from the outline of a box to a point that lies `offset` from its middle.
fn plan_distance_m(body: &BodyPlan, state: &TargetState, offset: DVec2) -> f64 {
    let [along, across] = axes(state);
    let excess = DVec2::new(offset.dot(along), offset.dot(across)).abs() - 0.5 * body.size_m.truncate();
    excess.max(DVec2::ZERO).length() + excess.max_element().min(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::BodyKind;
    use cosfly_frames::{DVec3, Seed};

    fn plan(kind: BodyKind, length_m: f64, width_m: f64) -> BodyPlan {
        let size_m = DVec3::new(length_m, width_m, 1.5);
        BodyPlan { source: String::new(), kind, size_m, looks: Seed([0; 32]), group: None }
    }

    fn at(x: f64, y: f64, heading_rad: f64) -> TargetState {
        TargetState { feet_in_world: DVec3::new(x, y, 0.0), heading_rad, speed_mps: 0.0 }
    }

    #[test]
    fn gaps_are_those_of_circles_and_boxes() {
        let (person, car) = (plan(BodyKind::Pedestrian, 0.5, 0.5), plan(BodyKind::Car, 4.0, 2.0));
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        close(gap_m(&person, &at(0.0, 0.0, 0.0), &person, &at(0.3, 0.4, 1.0)), 0.0);
        close(gap_m(&car, &at(0.0, 0.0, 0.0), &person, &at(5.0, 5.0, 0.0)), 5.0 - 0.25);
        close(gap_m(&person, &at(0.0, 2.0, 0.0), &car, &at(0.0, 0.0, real::FRAC_PI_2)), 2.0 - 2.0 - 0.25);
        close(gap_m(&car, &at(0.0, 0.0, 0.0), &person, &at(0.5, 0.0, 0.0)), -1.0 - 0.25);
        close(gap_m(&car, &at(0.0, 0.0, 0.0), &car, &at(5.0, 0.0, 0.0)), 1.0);
        close(gap_m(&car, &at(0.0, 0.0, 0.0), &car, &at(0.0, 3.5, real::FRAC_PI_2)), 0.5);
        assert!(gap_m(&car, &at(0.0, 0.0, 0.0), &car, &at(3.0, 1.5, 0.7)) < 0.0);
    }
}
