//! [`Lens`]: radial distortion after Brown, `r_seen = r (1 + k1 r^2 + k2 r^4)`, with r the tangent of the angle from the optical axis;
//! or a fisheye after Kannala and Brandt, `r_seen = a (1 + k1 a^2 + k2 a^4 + k3 a^6 + k4 a^8)`, with a the angle itself, radians;
//! or an equirectangular picture all around, whose columns are angles to the right and whose rows are angles upwards.

use crate::Camera;
use cosfly_frames::{DVec3, real};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Angle from the optical axis up to which one ideal camera draws the picture of a fisheye, radians.
const MOST_ANGLE_RAD: f64 = 1.4;
/// Width of an ideal picture from which on views all around draw that of a fisheye, widths of the finished one.
const MOST_WIDENING: f64 = 3.0;
/// Steps of a half turn in which the end of a fisheye's picture is looked for.
const LADDER: u32 = 3600;

/// Distance between a point and the place that its pixel shows, pixels of the ideal picture.
const SAME_PX: f64 = 1e-3;

/// Curve from the angle of a ray to its distance from the middle of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LensModel {
    /// Radial distortion of a pinhole after Brown, as OpenCV's `D = [k1, k2, 0, 0, 0]`.
    #[default]
    Brown,
    /// Fisheye after Kannala and Brandt, as OpenCV's `fisheye` with `D = [k1, k2, k3, k4]`; all 0: equidistant.
    Fisheye,
    /// All directions, 360 x 180 degrees: columns are even angles to the right, rows even angles upwards.
    Equirectangular,
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
            Self::Equirectangular => "equirectangular",
        }
    }

    /// The model called `name`.
    pub fn called(name: &str) -> Option<Self> {
        [Self::Brown, Self::Fisheye, Self::Equirectangular].into_iter().find(|model| model.name() == name)
    }

    /// Name of the model in `camera_info` of ROS 2 and in Foxglove's calibration.
    pub fn ros_name(self) -> &'static str {
        match self {
            Self::Brown => "plumb_bob",
            Self::Fisheye => "equidistant",
            Self::Equirectangular => "equirectangular",
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
            LensModel::Equirectangular => vec![],
        }
    }

    /// From the ideal to the seen radius.
    pub fn seen_radius(&self, ideal: f64) -> f64 {
        match self.model {
            LensModel::Brown | LensModel::Equirectangular => self.curve(ideal),
            LensModel::Fisheye => self.curve(real::atan2(ideal, 1.0)),
        }
    }

    /// From the seen to the ideal radius; `None` where nothing is seen at that radius, because the curve turns back or the ray
    /// is not ahead of the camera.
    pub fn ideal_radius(&self, seen: f64) -> Option<f64> {
        let bent = self.root(seen)?;
        match self.model {
            LensModel::Brown | LensModel::Equirectangular => Some(bent),
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

    /// Whether the curve rises up to a place, told by its falling terms alone; `false` says nothing.
    fn surely_rises_to(&self, x: f64) -> bool {
        let [k1, k2, k3, k4] = [self.k1, self.k2, self.k3, self.k4].map(|k| k.min(0.0));
        Self { k1, k2, k3, k4, ..*self }.slope(x) > 0.0
    }

    /// The place at which the curve reaches `seen` before it turns back.
    fn root(&self, seen: f64) -> Option<f64> {
        // Newton's steps from the seen radius; the curve grows up to where it turns, so a root below is the only one.
        let mut bent = seen;
        for _ in 0..12 {
            bent -= (self.curve(bent) - seen) / self.slope(bent);
        }
        let is_root = bent >= 0.0 && (self.curve(bent) - seen).abs() <= 1e-13 * seen.max(1.0);
        if is_root && self.surely_rises_to(bent) {
            return Some(bent);
        }
        let turn = self.turning_place();
        if is_root && bent < turn {
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

    /// Whether the picture is put together from views all around; its depth is the distance along the ray of a pixel, not along the
    /// optical axis.
    pub fn is_wide(&self, camera: &Camera) -> bool {
        match self.model {
            LensModel::Brown => false,
            LensModel::Fisheye => self.widening(camera).is_none_or(|widening| widening > MOST_WIDENING),
            LensModel::Equirectangular => true,
        }
    }

    /// Pixel coordinates and depth of a point before the camera (x ahead, y right, z up, metres); none where no picture shows it.
    pub fn project(&self, camera: &Camera, point: DVec3) -> Option<(f64, f64, f64)> {
        if !self.is_wide(camera) {
            let (u, v, depth_m) = camera.project_seen(point)?;
            let (u, v) = self.bend(camera, (u, v));
            return Some((u, v, depth_m));
        }
        let (cx, cy, focal) = camera.centre_and_focal_px();
        let (right, down) = if self.model == LensModel::Equirectangular {
            let flat = real::hypot(point.x, point.y);
            (real::atan2(point.y, point.x), -real::atan2(point.z, flat))
        } else {
            let across = real::hypot(point.y, point.z);
            let angle = real::atan2(across, point.x);
            let scale = if across > 0.0 { self.curve(angle) / across } else { 0.0 };
            if !self.surely_rises_to(angle) && angle >= self.turning_place() {
                return None;
            }
            (scale * point.y, -scale * point.z)
        };
        Some((cx + focal * right, cy + focal * down, point.length()))
    }

    /// Ray of pixel coordinates before the camera (x ahead, y right, z up): times the depth it is the point that the pixel shows. None
    /// outside of the lens's reach.
    pub fn ray(&self, camera: &Camera, (u, v): (f64, f64)) -> Option<DVec3> {
        let (cx, cy, focal) = camera.centre_and_focal_px();
        if !self.is_wide(camera) {
            let (u, v) = self.unbend(camera, (u, v))?;
            return Some(DVec3::new(1.0, (u - cx) / focal, (cy - v) / focal));
        }
        let (right, up) = ((u - cx) / focal, (cy - v) / focal);
        if self.model == LensModel::Equirectangular {
            let ((sin_yaw, cos_yaw), (sin, cos)) = (real::sin_cos(right), real::sin_cos(up));
            return Some(DVec3::new(cos * cos_yaw, cos * sin_yaw, sin));
        }
        let off = real::hypot(right, up);
        let angle = if off > 0.0 { self.root(off)? } else { 0.0 };
        let (sin, cos) = real::sin_cos(angle);
        let scale = if off > 0.0 { sin / off } else { 0.0 };
        (angle < real::PI).then(|| DVec3::new(cos, scale * right, scale * up))
    }

    /// Angle that the middle row of the picture spans, radians: of a pinhole its field of view, of pictures all around a whole turn.
    pub fn span_rad(&self, camera: &Camera) -> f64 {
        let left = self.ray(camera, (0.0, 0.5 * f64::from(camera.height)));
        left.map_or(camera.horizontal_fov_rad, |left| 2.0 * real::atan2(left.y.abs(), left.x))
    }

    /// Whether the pixel that [`Self::project`] gives shows the point, if any does: a curve may turn and lead back.
    pub fn shows(&self, camera: &Camera, point: DVec3, pixel: (f64, f64)) -> bool {
        if self.is_wide(camera) {
            return true;
        }
        let through = self.unbend(camera, pixel);
        camera.project_seen(point).zip(through).is_some_and(|((u, v, _), (x, y))| real::hypot(x - u, y - v) <= SAME_PX)
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
    fn a_picture_spans_what_its_lens_sees() {
        let wide = |fov_deg: f64| Camera { width: 300, height: 200, horizontal_fov_rad: fov_deg.to_radians() };
        let around = Lens { model: LensModel::Equirectangular, ..Lens::default() };
        for (lens, fov_deg, expected_deg) in [
            (Lens::default(), 90.0, 90.0),
            (Lens::brown(-0.1, 0.0), 90.0, 98.15),
            (Lens::fisheye([0.0; 4]), 90.0, 114.6),
            (Lens::fisheye([0.0; 4]), 115.0, 179.9),
            (Lens::fisheye([0.0; 4]), 127.6, 232.9),
            (around, Camera::ALL_AROUND_FOV_RAD.to_degrees(), 360.0),
        ] {
            let found_deg = lens.span_rad(&wide(fov_deg)).to_degrees();
            assert!((found_deg - expected_deg).abs() < 0.1, "{lens:?}: {found_deg}");
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

    #[test]
    fn wide_lenses_show_every_ray_where_its_pixel_says_at_the_distance_along_it() {
        let around = Camera { width: 400, height: 200, horizontal_fov_rad: Camera::ALL_AROUND_FOV_RAD };
        let wide = Camera { width: 300, height: 300, horizontal_fov_rad: 115f64.to_radians() };
        let all = Lens { model: LensModel::Equirectangular, ..Lens::default() };
        for (lens, camera) in
            [(all, around), (Lens::fisheye([0.0; 4]), wide), (Lens::fisheye([-0.02, 0.0, 0.0, 0.0]), wide)]
        {
            assert!(lens.is_wide(&camera));
            for seen in [(0.5, 0.5), (33.0, 150.0), (camera.centre_and_focal_px().0, 80.0), (299.0, 120.5)] {
                let ray = lens.ray(&camera, seen).expect("in reach");
                let (u, v, depth_m) = lens.project(&camera, 7.0 * ray).expect("in the picture");
                assert!((u - seen.0).abs() < 1e-9 && (v - seen.1).abs() < 1e-9 && (depth_m - 7.0).abs() < 1e-12);
            }
        }
        // A quarter of the width is a right angle; up is up.
        let at = |point: DVec3| all.project(&around, point).map(|(u, v, _)| (u.round(), v.round()));
        assert_eq!(at(DVec3::Y), Some((300.0, 100.0)));
        assert_eq!(at(DVec3::new(-1.0, -1e-9, 1e-9)), Some((0.0, 100.0)));
        assert_eq!(at(DVec3::new(1.0, 0.0, 1.0)), Some((200.0, 50.0)));
        // A straight lens of the same size is of one ideal picture.
        assert!(!Lens::fisheye([0.0; 4]).is_wide(&CAMERA) && !Lens::default().is_wide(&wide));
    }
}
