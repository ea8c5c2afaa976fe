//! Slanted walls: a rectangle along the inner side of each, so that rows behind it need not follow the wall in steps.

use super::plan::{CoverPlan, TurnedRectangle};
use cosfly_frames::{DVec2, real};

/// Depths of the rectangles that are tried, metres, and the least share of a side that one of each takes.
const DEPTHS: [(f64, f64); 4] = [(4.0, 0.85), (2.0, 0.85), (1.0, 0.7), (0.5, 0.4)];
/// Shortest wall with a rectangle, metres.
const SHORTEST_M: f64 = 1.5;
/// Rings of more sides have none: they are round or rough.
const MOST_SIDES: usize = 128;
/// Other sides may touch a rectangle this deep, metres: its neighbours at corners do.
const TOUCHES_M: f64 = 1e-4;

/// A stretch of a side along which the inside reaches at least so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wall {
    /// Number of the ring, and of its side.
    pub ring: usize,
    pub side: usize,
    /// Ends of the stretch; the ring leads from the first to the second.
    pub ends: [DVec2; 2],
    /// Inwards, unit length.
    inwards: DVec2,
    /// Depth of the inside there, metres.
    pub depth_m: f64,
}

impl Wall {
    /// Whether rows in this direction have steps along the wall that are deeper than `tolerance_m`.
    pub fn is_slanted(&self, yaw_rad: f64, tolerance_m: f64) -> bool {
        let (sin, cos) = real::sin_cos(yaw_rad);
        let along = self.ends[1] - self.ends[0];
        (cos * along.x + sin * along.y).abs().min((cos * along.y - sin * along.x).abs()) > tolerance_m
    }

    /// The rectangle on the inner side.
    pub fn rectangle(&self, plan: &CoverPlan) -> TurnedRectangle {
        let along = self.ends[1] - self.ends[0];
        TurnedRectangle {
            center: plan.middle + 0.5 * (self.ends[0] + self.ends[1] + self.depth_m * self.inwards),
            half_extents_m: 0.5 * DVec2::new(along.length(), self.depth_m) + plan.moved_m,
            yaw_rad: real::atan2(along.y, along.x),
        }
    }
}

/// The walls of a plan of one outer ring.
pub(super) fn walls(plan: &CoverPlan) -> Vec<Wall> {
    let count: usize = plan.rings.iter().map(Vec::len).sum();
    if plan.outer_count != 1 || count > MOST_SIDES {
        return Vec::new();
    }
    let sides = (0..plan.rings.len()).flat_map(|ring| (0..plan.rings[ring].len()).map(move |side| (ring, side)));
    sides.filter_map(|(ring, side)| DEPTHS.into_iter().find_map(|depth| wall(plan, ring, side, depth))).collect()
}

fn wall(plan: &CoverPlan, ring: usize, side: usize, (depth_m, least_share): (f64, f64)) -> Option<Wall> {
    let corners = &plan.rings[ring];
    let corner = |k: usize| corners[(side + corners.len() + k) % corners.len()];
    let (before, a, b, after) = (corner(corners.len() - 1), corner(0), corner(1), corner(2));
    let length_m = a.distance(b);
    if length_m < SHORTEST_M {
        return None;
    }
    let along = (b - a) / length_m;
    let is_left = (crate::polygons::twice_area_m2(corners) > 0.0) == (ring < plan.outer_count);
    let inwards = if is_left { along.perp() } else { -along.perp() };
    // Where a corner is acute, its other side leads through the rectangle's end.
    let cut_m = |away: DVec2, along: DVec2| {
        let (ahead, aside) = (away.dot(along), away.dot(inwards));
        if aside > 0.0 && ahead > 0.0 { depth_m * ahead / aside } else { 0.0 }
    };
    let (from_m, to_m) = (cut_m(before - a, along), length_m - cut_m(after - b, -along));
    if to_m - from_m < SHORTEST_M.max(least_share * length_m) {
        return None;
    }
    let ends = [a + from_m * along, a + to_m * along];
    let local = |point: DVec2| DVec2::new((point - ends[0]).dot(along), (point - ends[0]).dot(inwards));
    let (low, high) = (DVec2::splat(TOUCHES_M), DVec2::new(to_m - from_m, depth_m) - TOUCHES_M);
    let middle = 0.5 * (ends[0] + ends[1] + depth_m * inwards);
    let mut is_inside = false;
    for ring in &plan.rings {
        for k in 0..ring.len() {
            let (p, q) = (ring[k], ring[(k + 1) % ring.len()]);
            if crosses(local(p), local(q), low, high) {
                return None;
            }
            let is_right = |x: f64| x > middle.x;
            let crossing = || p.x + (q.x - p.x) * ((middle.y - p.y) / (q.y - p.y));
            is_inside ^= (p.y > middle.y) != (q.y > middle.y) && is_right(crossing());
        }
    }
    is_inside.then_some(Wall { ring, side, ends, inwards, depth_m })
}

/// Whether a segment has a point within an upright rectangle.
fn crosses(p: DVec2, q: DVec2, low: DVec2, high: DVec2) -> bool {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let (start, step) = (p[axis], q[axis] - p[axis]);
        if step == 0.0 {
            if start <= low[axis] || start >= high[axis] {
                return false;
            }
            continue;
        }
        let (enter, leave) = ((low[axis] - start) / step, (high[axis] - start) / step);
        from = from.max(enter.min(leave));
        to = to.min(enter.max(leave));
    }
    from < to
}
