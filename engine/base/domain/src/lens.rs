//! [`Lens`]: radial distortion after Brown, `r_seen = r (1 + k1 r^2 + k2 r^4)`, with r the tangent of the angle from the optical axis;
//! or a fisheye after Kannala and Brandt, `r_seen = a (1 + k1 a^2 + k2 a^4 + k3 a^6 + k4 a^8)`, with a the angle itself, radians.

use crate::Camera;
use cosfly_frames::real;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Angle from the optical axis from which on a fisheye shows nothing, radians: its picture is drawn by one ideal camera.
const MOST_ANGLE_RAD: f64 = 1.4;
/// Steps of a half turn in which the end of a fisheye's picture is looked for.
const LADDER: u32 = 3600;

/// Curve from the angle of a ray to its distance from the middle of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LensModel {
    /// Radial distortion of a pinhole after Brown, as OpenCV's `D = [k1, k2, 0, 0, 0]`.
    #[default]
    Brown,
    /// Fisheye after Kannala and Brandt, as OpenCV's `fisheye` with `D = [k1, k2, k3, k4]`; all 0: equidistant.
    Fisheye,
}

/// Lens before the ideal camera; all numbers 0: a pinhole, or an equidistant fisheye.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Lens {
    /// Curve from the angle of a ray to its distance from the middle of the picture.
    pub model: LensModel,
    /// Second-order coefficient; negative: barrel, positive: pincushion.
    #[schemars(range(min = -1, max = 1))]
    pub k1: f64,
    /// Fourth-order coefficient.
    #[schemars(range(min = -1, max = 1))]
    pub k2: f64,
    /// Sixth-order coefficient of a fisheye.
    #[schemars(range(min = -1, max = 1))]
    pub k3: f64,
    /// Eighth-order coefficient of a fisheye.
    #[schemars(range(min = -1, max = 1))]
    pub k4: f64,
}

impl LensModel {
    /// Name in recipes and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Brown => "brown",
            Self::Fisheye => "fisheye",
        }
    }

    /// The model called `name`.
    pub fn called(name: &str) -> Option<Self> {
        [Self::Brown, Self::Fisheye].into_iter().find(|model| model.name() == name)
    }

    /// Name of the model in `camera_info` of ROS 2 and in Foxglove's calibration.
    pub fn ros_name(self) -> &'static str {
        match self {
            Self::Brown => "plumb_bob",
            Self::Fisheye => "equidistant",
        }
    }
}

impl Lens {
    /// Radial distortion after Brown.
    pub const fn brown(k1: f64, k2: f64) -> Self {
        Self { model: LensModel::Brown, k1, k2, k3: 0.0, k4: 0.0 }
    }

    /// A fisheye after Kannala and Brandt.
    pub const fn fisheye([k1, k2, k3, k4]: [f64; 4]) -> Self {
        Self { model: LensModel::Fisheye, k1, k2, k3, k4 }
    }

    /// Whether it bends nothing.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// The numbers that calibrations of this model have.
    pub fn coefficients(&self) -> Vec<f64> {
        match self.model {
            LensModel::Brown => vec![self.k1, self.k2, 0.0, 0.0, 0.0],
            LensModel::Fisheye => vec![self.k1, self.k2, self.k3, self.k4],
        }
    }

    /// From the ideal to the seen radius.
    pub fn seen_radius(&self, ideal: f64) -> f64 {
        match self.model {
            LensModel::Brown => self.curve(ideal),
            LensModel::Fisheye => self.curve(real::atan2(ideal, 1.0)),
        }
    }

    /// From the seen to the ideal radius; `None` where nothing is seen at that radius, because the curve turns back or the ray
    /// is not ahead of the camera.
    pub fn ideal_radius(&self, seen: f64) -> Option<f64> {
        let bent = self.root(seen)?;
        match self.model {
            LensModel::Brown => Some(bent),
            LensModel::Fisheye => (bent < MOST_ANGLE_RAD).then(|| real::tan(bent)),
        }
    }

    /// The model's curve: of the tangent of the angle, of a fisheye of the angle.
    fn curve(&self, x: f64) -> f64 {
        let q = x * x;
        x * (1.0 + q * (self.k1 + q * (self.k2 + q * (self.k3 + q * self.k4))))
    }

    fn slope(&self, x: f64) -> f64 {
        let q = x * x;
        1.0 + q * (3.0 * self.k1 + q * (5.0 * self.k2 + q * (7.0 * self.k3 + q * 9.0 * self.k4)))
    }

    /// The place at which the curve reaches `seen` before it turns back.
    fn root(&self, seen: f64) -> Option<f64> {
        let turn = self.turning_place();
        // Newton's steps from the seen radius; the curve grows up to where it turns, so a root below is the only one.
        let mut bent = seen;
        for _ in 0..12 {
            bent -= (self.curve(bent) - seen) / self.slope(bent);
        }
        if (0.0..turn).contains(&bent) && (self.curve(bent) - seen).abs() <= 1e-13 * seen.max(1.0) {
            return Some(bent);
        }
        let (mut low, mut high) = (0.0, if turn.is_finite() { turn } else { 64.0 * seen });
        if self.curve(high) < seen {
            return None;
        }
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if self.curve(middle) < seen {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(0.5 * (low + high))
    }

    /// The place from which on the curve falls; infinite when it never does.
    fn turning_place(&self) -> f64 {
        if self.model == LensModel::Fisheye {
            // Angles end at a half turn; the first step of a fine ladder at which the curve falls is near enough.
            let steps = (1..=LADDER).map(|step| real::PI * f64::from(step) / f64::from(LADDER));
            return steps.into_iter().find(|angle| self.slope(*angle) <= 0.0).unwrap_or(f64::INFINITY);
        }
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

    /// Pixel coordinates at another distance from the middle, which `radius` tells from the one that they have, in focal lengths.
    fn scaled(camera: &Camera, (u, v): (f64, f64), radius: impl Fn(f64) -> Option<f64>) -> Option<(f64, f64)> {
        let (cx, cy, focal) = camera.centre_and_focal_px();
        let (x, y) = ((u - cx) / focal, (v - cy) / focal);
        let from = (x * x + y * y).sqrt();
        if from == 0.0 {
            return Some((u, v));
        }
        let scale = radius(from)? / from;
        Some((cx + focal * x * scale, cy + focal * y * scale))
    }

    /// Seen pixel coordinates of a point that an ideal camera would see at (u, v).
    pub fn bend(&self, camera: &Camera, (u, v): (f64, f64)) -> (f64, f64) {
        if self.is_none() {
            return (u, v);
        }
        if self.model == LensModel::Fisheye {
            return Self::scaled(camera, (u, v), |ideal| Some(self.seen_radius(ideal))).unwrap_or((u, v));
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
        Self::scaled(camera, (u, v), |seen| self.ideal_radius(seen))
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
        for lens in [
            Lens::brown(-0.2, 0.03),
            Lens::brown(0.15, 0.0),
            Lens::brown(-0.1, -0.02),
            Lens::fisheye([0.0; 4]),
            Lens::fisheye([-0.03, 0.01, -0.004, 0.001]),
        ] {
            for seen in [(0.5, 0.5), (160.0, 90.0), (319.5, 3.5), (17.5, 140.5)] {
                let ideal = lens.unbend(&CAMERA, seen).expect("in reach");
                let back = lens.bend(&CAMERA, ideal);
                assert!((back.0 - seen.0).abs() < 1e-9 && (back.1 - seen.1).abs() < 1e-9, "{seen:?} {back:?}");
            }
        }
    }

    #[test]
    fn a_curve_that_turns_back_shows_nothing_beyond() {
        assert_eq!(Lens::brown(-1.0, 0.0).ideal_radius(0.5), None);
        assert_eq!(Lens::brown(-1.0, 0.0).widening(&CAMERA), None);
        assert_eq!(Lens::default().widening(&CAMERA), Some(1.0));
    }

    #[test]
    fn an_equidistant_fisheye_shows_equal_angles_at_equal_distances() {
        let (lens, focal) = (Lens::fisheye([0.0; 4]), CAMERA.focal_px());
        for angle in [0.1, 0.4, 0.7, 1.0] {
            let (u, v) = lens.bend(&CAMERA, (160.0 + focal * real::tan(angle), 90.0));
            assert!((u - 160.0 - focal * angle).abs() < 1e-9 && v == 90.0, "{u} {v}");
        }
        assert_eq!(lens.ideal_radius(1.5), None);
        // The curve turns back at 1 / sqrt(3) rad, where it reaches 0.385.
        assert!(Lens::fisheye([-1.0, 0.0, 0.0, 0.0]).ideal_radius(0.38).is_some());
        assert_eq!(Lens::fisheye([-1.0, 0.0, 0.0, 0.0]).ideal_radius(0.39), None);
    }
}
