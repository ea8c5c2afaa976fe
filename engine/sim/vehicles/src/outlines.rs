//! Outlines seen from above: nearest points of bodies, overlaps of bodies that are about to move, solid things on lanes.

use crate::network::{Drive, Network};
use cosfly_domain::{BodyPlan, ObstacleKind, OrientedBox, Town};
use cosfly_frames::{DVec2, DVec3, TargetState, real};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_world::Present;

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
        && cosfly_world::gap_m(plan, state, other, at) < apart_m
}

/// Size of what must fit on a lane: length of a piece, width and height, metres.
const FITS_M: DVec3 = DVec3::new(2.0, 2.1, 2.6);
/// Widths that are tried beyond it, metres: of buses and lorries with room beside them, of vans, of cars.
const WIDTHS_M: [f64; 3] = [3.1, 2.7, 2.4];
/// Things whose tops are lower above the ground are driven over, metres.
const STEP_M: f64 = 0.3;

/// Solid things of a town that vehicles would drive into; crowns of trees give way.
pub(crate) struct Solid {
    things: BoxBvh,
}

impl Solid {
    pub fn new(town: &Town) -> Self {
        let solid = town.obstacles.iter().filter(|thing| thing.kind != ObstacleKind::TreeCrown);
        Self { things: BoxBvh::build(solid.map(|thing| thing.shape).collect()) }
    }

    /// Whether a box overlaps a solid thing.
    pub fn touches(&self, shape: &OrientedBox) -> bool {
        let (low, high) = shape.bounds_in_world();
        let mut touches = false;
        self.things.within(low + STEP_M * DVec3::Z, high, &mut |number| {
            touches |= overlap(shape, &self.things.boxes()[number as usize]);
        });
        touches
    }
}

/// Lanes on which something solid stands, ascending; the others become as narrow as what stands beside them leaves them.
pub(crate) fn blocked_lanes(network: &mut Network, town: &Town) -> Vec<u32> {
    let solid = Solid::new(town);
    let is_blocked_at = |lane: &Drive, width_m: f64| {
        let size_m = FITS_M.with_y(width_m.min(lane.width_m));
        (0..=(lane.length_m / FITS_M.x) as usize).any(|piece| {
            let (place, along) = lane.at((piece as f64 + 0.5) * FITS_M.x);
            let center_in_world = place + DVec3::Z * (0.5 * size_m.z);
            let yaw_rad = real::atan2(along.y, along.x);
            solid.touches(&OrientedBox { center_in_world, half_extents_m: 0.5 * size_m, yaw_rad })
        })
    };
    let mut blocked = vec![];
    for (number, lane) in (0..).zip(&mut network.lanes) {
        let fitting = WIDTHS_M.into_iter().find(|width_m| !is_blocked_at(lane, *width_m));
        match fitting {
            Some(width_m) if width_m == WIDTHS_M[0] => {}
            Some(width_m) => lane.width_m = lane.width_m.min(width_m),
            None if is_blocked_at(lane, FITS_M.y) => blocked.push(number),
            None => lane.width_m = lane.width_m.min(FITS_M.y),
        }
    }
    blocked
}

/// Whether two upright boxes overlap seen from above.
fn overlap(one: &OrientedBox, other: &OrientedBox) -> bool {
    let axes = |yaw_rad: f64| {
        let (sin, cos) = real::sin_cos(yaw_rad);
        [DVec2::new(cos, sin), DVec2::new(-sin, cos)]
    };
    let (own, others) = (axes(one.yaw_rad), axes(other.yaw_rad));
    let between = (other.center_in_world - one.center_in_world).truncate();
    own.into_iter().chain(others).all(|axis| {
        let reach =
            |half: DVec3, [along, across]: [DVec2; 2]| half.x * axis.dot(along).abs() + half.y * axis.dot(across).abs();
        axis.dot(between).abs() < reach(one.half_extents_m, own) + reach(other.half_extents_m, others)
    })
}
