//! A box prepared for queries: precomputed sine and cosine of its yaw, and the exact kernels in its own axes.

use crate::bounds::Bounds;
use crate::shape::Shape;
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, real};

/// An [`OrientedBox`] with the precomputed data of queries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnedBox {
    center_in_world: DVec3,
    half_extents_m: DVec3,
    sin: f64,
    cos: f64,
}

impl TurnedBox {
    /// Centre, world frame, metres.
    #[inline(always)]
    pub fn center_in_world(&self) -> DVec3 {
        self.center_in_world
    }

    /// Half the size along its own axes, metres.
    #[inline(always)]
    pub fn half_extents_m(&self) -> DVec3 {
        self.half_extents_m
    }

    /// Sine and cosine of its yaw.
    #[inline(always)]
    pub fn sin_cos(&self) -> (f64, f64) {
        (self.sin, self.cos)
    }

    /// Whether its axes are exactly the world's.
    #[inline(always)]
    pub fn is_axis_aligned(&self) -> bool {
        self.sin == 0.0 && self.cos == 1.0
    }

    /// Whether it fills its bounds up to a ten-billionth of its size: its yaw is a multiple of 90 degrees.
    #[inline]
    pub fn is_along_axes(&self) -> bool {
        self.sin.abs().min(self.cos.abs()) < 1e-10
    }

    /// Vector of the world frame in the box's axes.
    #[inline(always)]
    pub fn local_from_world_vector(&self, vector: DVec3) -> DVec3 {
        DVec3::new(self.cos * vector.x + self.sin * vector.y, self.cos * vector.y - self.sin * vector.x, vector.z)
    }

    /// Vector of the box's axes in the world frame.
    #[inline]
    fn world_from_local_vector(&self, vector: DVec3) -> DVec3 {
        DVec3::new(self.cos * vector.x - self.sin * vector.y, self.sin * vector.x + self.cos * vector.y, vector.z)
    }
}

impl Shape for TurnedBox {
    type Given = OrientedBox;

    fn prepare(given: &OrientedBox) -> Option<Self> {
        let numbers_are_finite =
            given.center_in_world.is_finite() && given.half_extents_m.is_finite() && given.yaw_rad.is_finite();
        let (sin, cos) = real::sin_cos(given.yaw_rad);
        let (center_in_world, half_extents_m) = (given.center_in_world, given.half_extents_m.abs());
        numbers_are_finite.then_some(Self { center_in_world, half_extents_m, sin, cos })
    }

    #[inline]
    fn bounds(&self) -> Bounds {
        let (sin, cos, half) = (self.sin.abs(), self.cos.abs(), self.half_extents_m);
        let reach = DVec3::new(cos * half.x + sin * half.y, sin * half.x + cos * half.y, half.z);
        Bounds { min_in_world: self.center_in_world - reach, max_in_world: self.center_in_world + reach }
    }

    #[inline]
    fn ray_entry(&self, origin_in_world: DVec3, direction_in_world: DVec3, max_t: f64) -> Option<f64> {
        let origin = self.local_from_world_vector(origin_in_world - self.center_in_world);
        let direction = self.local_from_world_vector(direction_in_world);
        slab_entry(origin, direction, self.half_extents_m, max_t)
    }

    /// On the inner medial surface the first of the tied axes is chosen.
    #[inline]
    fn signed_distance(&self, point_in_world: DVec3) -> (f64, DVec3) {
        let point = self.local_from_world_vector(point_in_world - self.center_in_world);
        let beyond = point.abs() - self.half_extents_m;
        let outside = beyond.max(DVec3::ZERO);
        let length = outside.length();
        let side = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
        if length > 0.0 {
            let away = DVec3::new(side(point.x), side(point.y), side(point.z)) * outside / length;
            return (length, self.world_from_local_vector(away));
        }
        let axis = if beyond.x >= beyond.y && beyond.x >= beyond.z {
            0
        } else if beyond.y >= beyond.z {
            1
        } else {
            2
        };
        let mut away = DVec3::ZERO;
        away[axis] = side(point[axis]);
        (beyond[axis], self.world_from_local_vector(away))
    }

    /// The squared distance is convex and piecewise quadratic along the segment. Its derivative is monotone and has
    /// kinks only where the segment crosses one of the six face planes; bisection over those leaves one linear piece,
    /// whose root is the closest point.
    #[inline]
    fn segment_distance(&self, from_in_world: DVec3, to_in_world: DVec3, within_m: f64) -> Option<f64> {
        let from = self.local_from_world_vector(from_in_world - self.center_in_world);
        let step = self.local_from_world_vector(to_in_world - from_in_world);
        let half = self.half_extents_m;
        let to = from + step;
        let gap = (from.min(to) - half).max(-half - from.max(to)).max(DVec3::ZERO);
        if within_m <= 0.0 || gap.length_squared() >= within_m * within_m {
            return None;
        }
        let distance = (from + closest_parameter(from, step, half) * step).abs() - half;
        let distance = distance.max(DVec3::ZERO).length();
        // Rounding may leave a tiny distance where the two touch; the slab test decides.
        let touches = distance < 1e-9 * (1.0 + from.abs().max_element()) && slab_entry(from, step, half, 1.0).is_some();
        let distance = if touches { 0.0 } else { distance };
        (distance < within_m).then_some(distance)
    }
}

/// Parameter of the point of `from + t * step`, `0 <= t <= 1`, closest to the box of half extents `half` around the
/// origin.
#[inline]
fn closest_parameter(from: DVec3, step: DVec3, half: DVec3) -> f64 {
    let slope = |t: f64| {
        let point = from + t * step;
        (point - point.clamp(-half, half)).dot(step)
    };
    let (mut low, mut slope_low) = (0.0, slope(0.0));
    if slope_low >= 0.0 {
        return 0.0;
    }
    let (mut high, mut slope_high) = (1.0, slope(1.0));
    if slope_high <= 0.0 {
        return 1.0;
    }
    for axis in 0..3 {
        if step[axis] == 0.0 {
            continue;
        }
        for face in [-half[axis], half[axis]] {
            let t = (face - from[axis]) / step[axis];
            if t > low && t < high {
                let at_face = slope(t);
                if at_face < 0.0 {
                    (low, slope_low) = (t, at_face);
                } else {
                    (high, slope_high) = (t, at_face);
                }
            }
        }
    }
    let rise = slope_high - slope_low;
    if rise > 0.0 { low + (high - low) * (-slope_low / rise) } else { low }
}

/// First `0 <= t <= max_t` of a ray in the closed box of half extents `half` around the origin.
#[inline]
fn slab_entry(origin: DVec3, direction: DVec3, half: DVec3, max_t: f64) -> Option<f64> {
    let (mut enter, mut leave) = (0.0_f64, max_t);
    for axis in 0..3 {
        let (o, d, h) = (origin[axis], direction[axis], half[axis]);
        if d.abs() < 1e-250 {
            if o.abs() > h {
                return None;
            }
            continue;
        }
        let inverse = 1.0 / d;
        let (near, far) = ((-h - o) * inverse, (h - o) * inverse);
        enter = enter.max(near.min(far));
        leave = leave.min(near.max(far));
    }
    (enter <= leave).then_some(enter)
}
