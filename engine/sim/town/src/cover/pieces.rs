//! Convex pieces of ground, and what turned rectangles leave of them.

use crate::polygons::{clipped_to_band, twice_area_m2};
use cosfly_frames::{DVec2, real};

/// A piece that is thinner than this on average is none, metres.
const THINNEST_M: f64 = 1e-7;
/// Farther than any ground, metres.
const FAR_M: f64 = 1e12;

/// A turn about the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) yaw_rad: f64,
    along: DVec2,
}

/// A rectangle along the axes of a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rectangle {
    pub(super) frame: Frame,
    pub(super) low: DVec2,
    pub(super) high: DVec2,
}

/// A convex polygon, corners in order.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    corners: Vec<DVec2>,
    low: DVec2,
    high: DVec2,
}

impl Frame {
    /// With its x axis turned from x towards y.
    pub(super) fn turned(yaw_rad: f64) -> Self {
        let (sin, cos) = real::sin_cos(yaw_rad);
        Self { yaw_rad, along: DVec2::new(cos, sin) }
    }

    /// A point in the frame.
    pub(super) fn local(&self, point: DVec2) -> DVec2 {
        DVec2::new(self.along.dot(point), self.along.perp_dot(point))
    }

    /// A point of the frame outside of it.
    pub(super) fn outside(&self, local: DVec2) -> DVec2 {
        local.x * self.along + local.y * self.along.perp()
    }
}

impl Rectangle {
    pub(super) fn area_m2(&self) -> f64 {
        (self.high - self.low).element_product()
    }

    /// Least and greatest coordinates.
    pub(super) fn bounds(&self) -> (DVec2, DVec2) {
        let corners = [self.low, self.high, DVec2::new(self.low.x, self.high.y), DVec2::new(self.high.x, self.low.y)];
        bounds(&corners.map(|corner| self.frame.outside(corner)))
    }

    /// The bands whose common ground is the rectangle: direction, from, to.
    fn bands(&self) -> [(DVec2, f64, f64); 2] {
        let along = self.frame.along;
        [(along, self.low.x, self.high.x), (along.perp(), self.low.y, self.high.y)]
    }
}

impl Piece {
    pub(super) fn new(corners: Vec<DVec2>) -> Self {
        let (low, high) = bounds(&corners);
        Self { corners, low, high }
    }

    pub(super) fn corners(&self) -> &[DVec2] {
        &self.corners
    }

    pub(super) fn area_m2(&self) -> f64 {
        0.5 * twice_area_m2(&self.corners).abs()
    }

    /// Whether next to nothing is left of it.
    pub(super) fn is_thin(&self) -> bool {
        let size = self.high - self.low;
        self.corners.len() < 3 || self.area_m2() <= THINNEST_M * (size.x + size.y)
    }

    /// Its centre of area, which lies inside.
    pub(super) fn middle(&self) -> DVec2 {
        let first = self.corners[0];
        let (mut sum, mut area) = (DVec2::ZERO, 0.0);
        for pair in self.corners.windows(2).skip(1) {
            let (a, b) = (pair[0] - first, pair[1] - first);
            let part = a.perp_dot(b);
            sum += part * (a + b) / 3.0;
            area += part;
        }
        first + sum / area
    }

    /// Whether it may have ground in common with what lies between two corners.
    pub(super) fn touches(&self, (low, high): (DVec2, DVec2)) -> bool {
        self.low.cmple(high).all() && self.high.cmpge(low).all()
    }

    /// Part of it within a rectangle.
    pub(super) fn within(&self, rectangle: &Rectangle) -> Self {
        let [(x, low_x, high_x), (y, low_y, high_y)] = rectangle.bands();
        Self::new(clipped_to_band(&clipped_to_band(&self.corners, x, low_x, high_x), y, low_y, high_y))
    }

    /// Part of it outside of a rectangle, in convex pieces: itself where it has nothing of it.
    pub(super) fn outside(&self, rectangle: &Rectangle) -> Vec<Self> {
        if !self.touches(rectangle.bounds()) || self.within(rectangle).is_thin() {
            return vec![self.clone()];
        }
        let mut left = self.corners.clone();
        let mut parts = Vec::new();
        for (axis, low, high) in rectangle.bands() {
            parts.push(Self::new(clipped_to_band(&left, axis, -FAR_M, low)));
            parts.push(Self::new(clipped_to_band(&left, axis, high, FAR_M)));
            left = clipped_to_band(&left, axis, low, high);
        }
        parts.retain(|part| !part.is_thin());
        parts
    }
}

fn bounds(corners: &[DVec2]) -> (DVec2, DVec2) {
    let low = corners.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    (low, corners.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max))
}
