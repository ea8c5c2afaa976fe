//! Outlines of bodies seen from above: nearest points, and overlaps of bodies that are about to move.

use cosfly_frames::{DVec2, TargetState, real};
use cosfly_world::{BodyPlan, Present};

/// Bodies whose feet differ by more do not meet: one is on a bridge, metres.
pub(crate) const LEVEL_M: f64 = 2.5;

/// From a point to the nearest point of a body; zero inside.
pub(crate) fn to_outline(point: DVec2, body: &Present) -> DVec2 {
    let away = body.state.feet_in_world.truncate() - point;
    if body.kind.is_person() {
        return away * (1.0 - (body.radius_m / away.length().max(1e-9)).min(1.0));
    }
    let (sin, cos) = real::sin_cos(body.state.heading_rad);
    let (along, across) = (DVec2::new(cos, sin), DVec2::new(-sin, cos));
    let half = 0.5 * body.size_m.truncate();
    let excess = |away: f64, half: f64| away.signum() * (away.abs() - half).max(0.0);
    along * excess(away.dot(along), half.x) + across * excess(away.dot(across), half.y)
}

/// Whether two bodies in their states are closer than `apart_m`.
pub(crate) fn meet(plan: &BodyPlan, state: &TargetState, other: &BodyPlan, at: &TargetState, apart_m: f64) -> bool {
    let away = at.feet_in_world - state.feet_in_world;
    let reach_m = plan.radius_m() + other.radius_m() + apart_m;
    away.z.abs() < LEVEL_M
        && away.truncate().length_squared() < reach_m * reach_m
        && plan.gap_m(state, other, at) < apart_m
}
