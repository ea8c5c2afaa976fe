//! [`CoverPlan`]: rings to be covered, and rows and rectangles of them in a direction.

use super::rows::{Row, Rows, coarse_rows, strips};
use super::thinning;
use crate::polygons::twice_area_m2;
use cosfly_frames::{DVec2, real};

/// Directions of sides that are tried, each lengthwise and across.
const DIRECTIONS: usize = 3;

/// A rectangle turned about its centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnedRectangle {
    /// Centre, metres.
    pub center: DVec2,
    /// Half its size along its own axes, metres.
    pub half_extents_m: DVec2,
    /// Turn from x towards y, radians.
    pub yaw_rad: f64,
}

/// Rings near the origin, thinned out, and the directions that suit them.
#[derive(Clone, Debug)]
pub struct CoverPlan {
    /// Outer rings first.
    pub(super) rings: Vec<Vec<DVec2>>,
    pub(super) outer_count: usize,
    /// Middle of the rings in their own frame.
    pub(super) middle: DVec2,
    /// Distance by which thinning out moved the rings at most, metres.
    pub(super) moved_m: f64,
    /// Directions of the longest sides, longest first, each followed by the direction across.
    pub(super) angles_rad: Vec<f64>,
    /// Width and depth, whichever is larger.
    pub(super) extent_m: f64,
}

impl CoverPlan {
    /// None when there is no corner or a coordinate is not finite.
    pub fn of(outer: &[&[DVec2]], holes: &[&[DVec2]]) -> Option<Self> {
        let corners = || outer.iter().chain(holes).copied().flatten().copied();
        let low = corners().fold(DVec2::INFINITY, DVec2::min);
        let high = corners().fold(DVec2::NEG_INFINITY, DVec2::max);
        let has_sides = outer.iter().any(|ring| ring.len() > 1);
        if !(has_sides && low.is_finite() && high.is_finite() && corners().all(DVec2::is_finite)) {
            return None;
        }
        let middle = 0.5 * (low + high);
        let near = |rings: &[&[DVec2]]| -> Vec<Vec<DVec2>> {
            rings.iter().map(|ring| ring.iter().map(|corner| *corner - middle).collect()).collect()
        };
        let (mut outer, mut holes) = (near(outer), near(holes));
        let moved_m = thinning::thin_out(&mut outer).max(thinning::thin_out(&mut holes));
        let outer_count = outer.len();
        let rings = [outer, holes].concat();
        let angles_rad = side_angles_rad(&rings);
        Some(Self { rings, outer_count, middle, moved_m, angles_rad, extent_m: (high - low).max_element() })
    }

    /// The rings, to be covered in these directions only.
    #[must_use]
    pub fn along(mut self, angles_rad: &[f64]) -> Self {
        self.angles_rad = angles_rad.to_vec();
        self
    }

    /// Directions of the longest sides, longest first, each followed by the direction across; radians, x towards y.
    pub fn angles_rad(&self) -> &[f64] {
        &self.angles_rad
    }

    /// Area of the outer rings without the holes, square metres.
    pub fn area_m2(&self) -> f64 {
        let area_m2 = |ring: &Vec<DVec2>| 0.5 * twice_area_m2(ring).abs();
        let (outer, holes) = self.rings.split_at(self.outer_count);
        (outer.iter().map(area_m2).sum::<f64>() - holes.iter().map(area_m2).sum::<f64>()).max(0.0)
    }

    /// The cover of rings whose sides are too many: courtyards are filled.
    pub(super) fn coarse_cover(&self, most: usize) -> Vec<TurnedRectangle> {
        let yaw_rad = self.angles_rad[0];
        let outer = self.rings[..self.outer_count].iter().map(|ring| self.turned(ring, yaw_rad));
        let rows = coarse_rows(outer);
        let mut allowed_m = self.extent_m / 64.0;
        loop {
            let strips = strips(rows.clone(), allowed_m);
            let count: usize = strips.iter().map(|row| row.spans.len()).sum();
            if count <= most || allowed_m > 4.0 * self.extent_m {
                return self.rectangles(strips, yaw_rad);
            }
            allowed_m *= core::f64::consts::SQRT_2;
        }
    }

    pub(super) fn turned(&self, ring: &[DVec2], yaw_rad: f64) -> Vec<DVec2> {
        let (sin, cos) = real::sin_cos(yaw_rad);
        ring.iter().map(|p| DVec2::new(cos * p.x + sin * p.y, cos * p.y - sin * p.x)).collect()
    }

    /// The rings turned so that `yaw_rad` is x.
    pub(crate) fn rows(&self, yaw_rad: f64) -> Rows {
        let rings = self.rings.iter().enumerate();
        Rows::of(rings.map(|(index, ring)| (self.turned(ring, yaw_rad), index >= self.outer_count)))
    }

    /// Convex quads, corners in order, that tile the inside; a ring's sides must not cross. Thinned out like a cover;
    /// none where the sides are too many.
    pub fn trapezoids(&self) -> Vec<[DVec2; 4]> {
        let rows = self.rows(0.0);
        let quads = if rows.are_too_many() { Vec::new() } else { rows.trapezoids() };
        quads.into_iter().map(|quad| quad.map(|corner| corner + self.middle)).collect()
    }

    /// The smallest rectangle in this direction.
    pub(crate) fn bounding(&self, yaw_rad: f64) -> TurnedRectangle {
        let corners = self.rings.iter().flat_map(|ring| self.turned(ring, yaw_rad));
        let (low, high) = corners.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
        self.rectangle(low, high, yaw_rad)
    }

    /// The rectangles of strips.
    pub(crate) fn rectangles(&self, strips: Vec<Row>, yaw_rad: f64) -> Vec<TurnedRectangle> {
        let of_strip = |strip: Row| {
            let (low_y, high_y) = (strip.low_y, strip.high_y);
            strip.spans.into_iter().map(move |span| (DVec2::new(span.low, low_y), DVec2::new(span.high, high_y)))
        };
        strips.into_iter().flat_map(of_strip).map(|(low, high)| self.rectangle(low, high, yaw_rad)).collect()
    }

    pub(super) fn rectangle(&self, low: DVec2, high: DVec2, yaw_rad: f64) -> TurnedRectangle {
        let (sin, cos) = real::sin_cos(yaw_rad);
        let center = 0.5 * (low + high);
        let turned = DVec2::new(cos * center.x - sin * center.y, sin * center.x + cos * center.y);
        let half_extents_m = 0.5 * (high - low) + self.moved_m;
        TurnedRectangle { center: self.middle + turned, half_extents_m, yaw_rad }
    }
}

/// Directions in which the sides are longest together, sides within two degrees of each other (or of a right angle)
/// counted together.
fn side_angles_rad(rings: &[Vec<DVec2>]) -> Vec<f64> {
    let quarter = 0.5 * real::PI;
    let near = |a: f64, b: f64| {
        let apart = (a - b).rem_euclid(quarter);
        apart.min(quarter - apart) < 0.035
    };
    let mut sides: Vec<DVec2> = rings
        .iter()
        .flat_map(|ring| (0..ring.len()).map(|i| ring[(i + 1) % ring.len()] - ring[i]))
        .filter(|side| side.length() > 1e-6)
        .collect();
    sides.sort_by(|a, b| b.length_squared().total_cmp(&a.length_squared()));
    let mut groups: Vec<(f64, f64)> = Vec::new();
    for side in &sides {
        let angle = real::atan2(side.y, side.x);
        match groups.iter().position(|(other, _)| near(*other, angle)) {
            Some(group) => groups[group].1 += side.length(),
            None if groups.len() < 32 => groups.push((angle, side.length())),
            None => {}
        }
    }
    if groups.is_empty() {
        groups.push((0.0, 0.0));
    }
    groups.sort_by(|a, b| b.1.total_cmp(&a.1));
    groups.iter().take(DIRECTIONS).flat_map(|(angle, _)| [*angle, *angle + quarter]).collect()
}
