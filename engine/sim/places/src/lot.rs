//! Rectangles on the ground: the plots of things.

use cosfly_frames::{DVec2, real};

/// A rectangle on the ground, map frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lot {
    /// Middle, metres.
    pub center: DVec2,
    /// Half its length and width along its own axes, metres.
    pub half_m: DVec2,
    /// Direction of its length, radians.
    pub heading_rad: f64,
}

impl Lot {
    /// Unit axes.
    pub fn axes(&self) -> [DVec2; 2] {
        let (sin, cos) = real::sin_cos(self.heading_rad);
        [DVec2::new(cos, sin), DVec2::new(-sin, cos)]
    }

    /// Corners, counter-clockwise.
    pub fn corners(&self) -> [DVec2; 4] {
        let [along, across] = self.axes();
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| self.center + along * (x * self.half_m.x) + across * (y * self.half_m.y))
    }

    /// Distance of a point, 0 inside.
    pub fn distance_m(&self, point: DVec2) -> f64 {
        let [along, across] = self.axes();
        let from_center = point - self.center;
        let local = DVec2::new(from_center.dot(along), from_center.dot(across));
        (local.abs() - self.half_m).max(DVec2::ZERO).length()
    }

    /// Whether two lots come closer than `gap_m` (separating axes).
    pub fn is_near(&self, other: &Self, gap_m: f64) -> bool {
        let (mine, theirs) = (self.corners(), other.corners());
        let [a, b] = self.axes();
        let [c, d] = other.axes();
        [a, b, c, d].iter().all(|axis| {
            let span = |corners: &[DVec2; 4]| {
                corners.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), corner| {
                    let at = corner.dot(*axis);
                    (low.min(at), high.max(at))
                })
            };
            let (first, second) = (span(&mine), span(&theirs));
            first.0 < second.1 + gap_m && second.0 < first.1 + gap_m
        })
    }
}
