//! [`Lens`]: radial distortion after Brown, `r_seen = r (1 + k1 r^2 + k2 r^4)`, with r the tangent of the angle from the optical axis.

use crate::Camera;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Radial distortion, as OpenCV's `D = [k1, k2, 0, 0, 0]`; both 0: an ideal pinhole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Lens {
    /// Second-order coefficient; negative: barrel, positive: pincushion.
    #[schemars(range(min = -1, max = 1))]
    pub k1: f64,
    /// Fourth-order coefficient.
    #[schemars(range(min = -1, max = 1))]
    pub k2: f64,
}

impl Lens {
    /// Whether it bends nothing.
    pub fn is_none(&self) -> bool {
        self.k1 == 0.0 && self.k2 == 0.0
    }

    /// From the ideal to the seen radius.
    pub fn seen_radius(&self, ideal: f64) -> f64 {
        let square = ideal * ideal;
        ideal * (1.0 + square * (self.k1 + square * self.k2))
    }

    /// From the seen to the ideal radius; `None` where nothing is seen at that radius because the curve turns back.
    pub fn ideal_radius(&self, seen: f64) -> Option<f64> {
        let slope = |r: f64| 1.0 + r * r * (3.0 * self.k1 + 5.0 * self.k2 * r * r);
        let turn = self.turning_radius();
        // Newton's steps from the seen radius; the curve grows up to where it turns, so a root below is the only one.
        let mut ideal = seen;
        for _ in 0..12 {
            ideal -= (self.seen_radius(ideal) - seen) / slope(ideal);
        }
        if (0.0..turn).contains(&ideal) && (self.seen_radius(ideal) - seen).abs() <= 1e-13 * seen.max(1.0) {
            return Some(ideal);
        }
        let (mut low, mut high) = (0.0, if turn.is_finite() { turn } else { 64.0 * seen });
        if self.seen_radius(high) < seen {
            return None;
        }
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if self.seen_radius(middle) < seen {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(0.5 * (low + high))
    }

    /// The ideal radius from which on the curve falls; infinite when it never does.
    fn turning_radius(&self) -> f64 {
        // 1 + 3 k1 q + 5 k2 q^2 = 0, with q the square of the radius.
        let (a, b) = (5.0 * self.k2, 3.0 * self.k1);
        let square = if a == 0.0 {
            -1.0 / b
        } else {
            let discriminant = b * b - 4.0 * a;
            let root = discriminant.max(0.0).sqrt();
            let roots = [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)];
            let positive = roots.into_iter().filter(|q| *q > 0.0 && discriminant >= 0.0);
            positive.fold(f64::INFINITY, f64::min)
        };
        if square > 0.0 { square.sqrt() } else { f64::INFINITY }
    }

    /// Seen pixel coordinates of a point that an ideal camera would see at (u, v).
    pub fn bend(&self, camera: &Camera, (u, v): (f64, f64)) -> (f64, f64) {
        if self.is_none() {
            return (u, v);
        }
        let (cx, cy, focal) = camera.centre_and_focal_px();
        let (x, y) = ((u - cx) / focal, (v - cy) / focal);
        let square = x * x + y * y;
        let scale = 1.0 + square * (self.k1 + square * self.k2);
        (cx + focal * x * scale, cy + focal * y * scale)
    }

    /// Pixel coordinates in an ideal camera of the point that this lens shows at (u, v); `None` outside of the lens's
    /// reach.
    pub fn unbend(&self, camera: &Camera, (u, v): (f64, f64)) -> Option<(f64, f64)> {
        if self.is_none() {
            return Some((u, v));
        }
        let (cx, cy, focal) = camera.centre_and_focal_px();
        let (x, y) = ((u - cx) / focal, (v - cy) / focal);
        let seen = (x * x + y * y).sqrt();
        if seen == 0.0 {
            return Some((u, v));
        }
        let scale = self.ideal_radius(seen)? / seen;
        Some((cx + focal * x * scale, cy + focal * y * scale))
    }

    /// Width of the ideal picture that this lens needs, in widths of the picture; `None` when there is none.
    pub fn widening(&self, camera: &Camera) -> Option<f64> {
        let corner = self.unbend(camera, (0.0, 0.0))?;
        let (cx, cy, _) = camera.centre_and_focal_px();
        Some(((cx - corner.0) / cx).max((cy - corner.1) / cy).max(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: Camera = Camera { width: 320, height: 180, horizontal_fov_rad: 1.4 };

    #[test]
    fn bending_and_unbending_are_each_other_s_inverse() {
        for lens in [Lens { k1: -0.2, k2: 0.03 }, Lens { k1: 0.15, k2: 0.0 }, Lens { k1: -0.1, k2: -0.02 }] {
            for seen in [(0.5, 0.5), (160.0, 90.0), (319.5, 3.5), (17.5, 140.5)] {
                let ideal = lens.unbend(&CAMERA, seen).expect("in reach");
                let back = lens.bend(&CAMERA, ideal);
                assert!((back.0 - seen.0).abs() < 1e-9 && (back.1 - seen.1).abs() < 1e-9, "{seen:?} {back:?}");
            }
        }
    }

    #[test]
    fn a_curve_that_turns_back_shows_nothing_beyond() {
        assert_eq!(Lens { k1: -1.0, k2: 0.0 }.ideal_radius(0.5), None);
        assert_eq!(Lens { k1: -1.0, k2: 0.0 }.widening(&CAMERA), None);
        assert_eq!(Lens::default().widening(&CAMERA), Some(1.0));
    }
}
