//! Covers of crooked rings: rectangles that grow inside as far as the walls let them, each turned along a wall near it.

use super::pieces::{Frame, Piece, Rectangle};
use super::plan::{CoverPlan, TurnedRectangle};
use cosfly_frames::{DVec2, real};

/// Walls near a place whose directions are tried there, beside the plan's own.
const NEAR_WALLS: usize = 4;
/// Directions closer than this are one, radians.
const SAME_DIRECTION_RAD: f64 = 1e-3;
/// Rectangles reach beyond what they have to cover by this, so that no rounding leaves a slit, metres.
const SPARE_M: f64 = 1e-6;
/// Most pieces that are left at a time.
const MOST_PIECES: usize = 20_000;
/// Most walls.
const MOST_WALLS: usize = 6000;

/// Rectangles whose union contains the plan and stands over it by at most `tolerance_m`; `None` where that would take more
/// than `most`.
///
/// The rest is a list of convex pieces. From the middle of the largest one rectangles grow in several directions; the
/// one that covers most of what is left is kept, cut to that.
pub(super) fn cover(plan: &CoverPlan, tolerance_m: f64, most: usize) -> Option<Vec<TurnedRectangle>> {
    let frame = Frame::turned(*plan.angles_rad.first()?);
    let rows = plan.rows(frame.yaw_rad).with_levels_at_crossings()?;
    let walls: Vec<[DVec2; 2]> = rows.sides().map(|side| side.map(|end| frame.outside(end))).collect();
    if walls.len() > MOST_WALLS {
        return None;
    }
    let quads = rows.trapezoids().into_iter().map(|quad| Piece::new(quad.map(|end| frame.outside(end)).to_vec()));
    let mut left: Vec<Piece> = quads.filter(|piece| !piece.is_thin()).collect();
    let grower = Grower { walls, reach_m: tolerance_m * core::f64::consts::FRAC_1_SQRT_2 };
    let mut out = Vec::new();
    while let Some(largest) = (0..left.len()).max_by(|a, b| left[*a].area_m2().total_cmp(&left[*b].area_m2())) {
        if out.len() >= most || left.len() > MOST_PIECES {
            return None;
        }
        let Some(best) = grower.best(left[largest].middle(), &plan.angles_rad, &left) else {
            left.swap_remove(largest); // too thin for any rectangle to be of use
            continue;
        };
        left = left.iter().flat_map(|piece| piece.outside(&best)).collect();
        out.push(plan.rectangle(best.low, best.high, best.frame.yaw_rad));
    }
    Some(out)
}

/// Grows rectangles between walls.
struct Grower {
    walls: Vec<[DVec2; 2]>,
    /// Distance by which each side of a rectangle may lie beyond the inside: its corners are within the tolerance then.
    reach_m: f64,
}

impl Grower {
    /// The rectangle around a place inside that covers most of the pieces, cut to what it covers.
    fn best(&self, at: DVec2, angles_rad: &[f64], pieces: &[Piece]) -> Option<Rectangle> {
        let mut all: Vec<Rectangle> = Vec::new();
        for yaw_rad in self.directions(at, angles_rad) {
            let frame = Frame::turned(yaw_rad);
            let walls: Vec<[DVec2; 2]> = self.walls.iter().map(|wall| wall.map(|end| frame.local(end))).collect();
            let reaching = |(low, high)| Rectangle { frame, low: low - self.reach_m, high: high + self.reach_m };
            all.extend(grown(&walls, frame.local(at)).map(reaching));
        }
        all.sort_by(|a, b| b.area_m2().total_cmp(&a.area_m2()));
        let mut best: Option<(f64, Rectangle)> = None;
        for rectangle in all {
            let most_m2 = best.as_ref().map_or(0.0, |(covered_m2, _)| *covered_m2);
            if rectangle.area_m2() <= most_m2 {
                break; // nor can any smaller one cover more
            }
            best = covered(&rectangle, pieces).filter(|(covered_m2, _)| *covered_m2 > most_m2).or(best);
        }
        best.map(|(_, rectangle)| rectangle)
    }

    /// The plan's directions and those of the nearest walls, right angles apart counted once.
    fn directions(&self, at: DVec2, angles_rad: &[f64]) -> Vec<f64> {
        let quarter = real::FRAC_PI_2;
        let mut near: Vec<(f64, f64)> = self
            .walls
            .iter()
            .map(|[a, b]| {
                let along = *b - *a;
                let share = ((at - *a).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
                (at.distance(*a + share * along), real::atan2(along.y, along.x))
            })
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut found: Vec<f64> = Vec::new();
        let mut add = |angle_rad: f64, most: usize| {
            let angle_rad = angle_rad.rem_euclid(quarter);
            let is_known = found.iter().any(|known| {
                let apart = (angle_rad - known).abs();
                apart.min(quarter - apart) < SAME_DIRECTION_RAD
            });
            if !is_known && found.len() < most {
                found.push(angle_rad);
            }
        };
        near.iter().take(8 * NEAR_WALLS).for_each(|(_, angle_rad)| add(*angle_rad, NEAR_WALLS));
        angles_rad.iter().for_each(|angle_rad| add(*angle_rad, usize::MAX));
        found
    }
}

/// The area that a rectangle covers of some pieces, and the rectangle cut to that.
fn covered(rectangle: &Rectangle, pieces: &[Piece]) -> Option<(f64, Rectangle)> {
    let mut area_m2 = 0.0;
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let near = rectangle.bounds();
    for piece in pieces.iter().filter(|piece| piece.touches(near)) {
        let common = piece.within(rectangle);
        if common.is_thin() {
            continue;
        }
        area_m2 += common.area_m2();
        for corner in common.corners() {
            let local = rectangle.frame.local(*corner);
            (low, high) = (low.min(local), high.max(local));
        }
    }
    let cut = Rectangle { frame: rectangle.frame, low: low - SPARE_M, high: high + SPARE_M };
    (area_m2 > 0.0).then_some((area_m2, cut))
}

/// Rectangles around a place, as large as the walls let them be: lengthwise or crosswise first, from the place itself or
/// from the largest square about it.
fn grown(walls: &[[DVec2; 2]], at: DVec2) -> [(DVec2, DVec2); 4] {
    let free_m = walls.iter().map(|wall| away_from_wall_m(at, wall)).fold(f64::INFINITY, f64::min);
    let free_m = if free_m.is_finite() { free_m } else { 0.0 };
    [(0, 0.0), (1, 0.0), (0, free_m), (1, free_m)].map(|(first, half_m)| {
        let (mut low, mut high) = (at - half_m, at + half_m);
        for axis in [first, 1 - first] {
            let (least, most) = limits(walls, low, high, axis);
            (low[axis], high[axis]) = (low[axis].min(least), high[axis].max(most));
        }
        (low, high)
    })
}

/// How far a rectangle can grow along an axis, both ways, until a wall leads into its way.
fn limits(walls: &[[DVec2; 2]], low: DVec2, high: DVec2, axis: usize) -> (f64, f64) {
    /// Walls that lie along the rectangle's sides are not in its way, metres.
    const TOUCH_M: f64 = 1e-9;
    let across = 1 - axis;
    let middle = 0.5 * (low[axis] + high[axis]);
    let (mut from, mut to) = (low[across] + TOUCH_M, high[across] - TOUCH_M);
    if from >= to {
        let line = 0.5 * (low[across] + high[across]);
        (from, to) = (line, line);
    }
    let (mut least, mut most) = (f64::NEG_INFINITY, f64::INFINITY);
    for [a, b] in walls {
        let (a, b) = if a[across] <= b[across] { (a, b) } else { (b, a) };
        if a[across] > to || b[across] < from {
            continue;
        }
        let rise = b[across] - a[across];
        let at = |level: f64| {
            let share = if rise > 0.0 { ((level - a[across]) / rise).clamp(0.0, 1.0) } else { 0.0 };
            a[axis] + share * (b[axis] - a[axis])
        };
        let ends = if rise > 0.0 { [at(from), at(to)] } else { [a[axis], b[axis]] };
        let (nearest, farthest) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        if 0.5 * (nearest + farthest) > middle { most = most.min(nearest) } else { least = least.max(farthest) }
    }
    let is_closed = least.is_finite() && most.is_finite() && least <= most;
    if is_closed { (least, most) } else { (low[axis], high[axis]) }
}

/// Largest half side of a square about a point that a wall stays out of.
fn away_from_wall_m(at: DVec2, [a, b]: &[DVec2; 2]) -> f64 {
    let (from, step) = (*a - at, *b - *a);
    let away_m = |share: f64| (from + share.clamp(0.0, 1.0) * step).abs().max_element();
    // The larger of both distances is least at an end, or where one of them is 0, or where both are equal.
    let places = [
        0.0,
        1.0,
        -from.x / step.x,
        -from.y / step.y,
        -(from.x - from.y) / (step.x - step.y),
        -(from.x + from.y) / (step.x + step.y),
    ];
    places.into_iter().filter(|share| share.is_finite()).map(away_m).fold(f64::INFINITY, f64::min)
}
