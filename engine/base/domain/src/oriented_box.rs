//! A solid box rotated around the vertical axis: the shape of every obstacle.

use cosfly_frames::{DVec3, real};
use serde::{Deserialize, Serialize};

/// A closed solid box; axis-aligned when `yaw_rad` is 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrientedBox {
    /// Centre, world frame, metres.
    pub center_in_world: DVec3,
    /// Half the size along its own x, y and z axes, metres, all at least 0.
    pub half_extents_m: DVec3,
    /// Rotation around z, radians; positive: x towards y.
    pub yaw_rad: f64,
}

impl OrientedBox {
    /// Axis-aligned box between two corners.
    pub fn from_corners(min_in_world: DVec3, max_in_world: DVec3) -> Self {
        Self {
            center_in_world: 0.5 * (min_in_world + max_in_world),
            half_extents_m: 0.5 * (max_in_world - min_in_world),
            yaw_rad: 0.0,
        }
    }

    /// Eight corners; bit 0 of the index is +x, bit 1 +y, bit 2 +z in the box's own axes.
    pub fn corners_in_world(&self) -> [DVec3; 8] {
        let (sin, cos) = real::sin_cos(self.yaw_rad);
        let half = self.half_extents_m;
        core::array::from_fn(|i| {
            let x = if i & 1 == 0 { -half.x } else { half.x };
            let y = if i & 2 == 0 { -half.y } else { half.y };
            let z = if i & 4 == 0 { -half.z } else { half.z };
            self.center_in_world + DVec3::new(cos * x - sin * y, sin * x + cos * y, z)
        })
    }

    /// Corners of the smallest axis-aligned box around it: (min, max).
    pub fn bounds_in_world(&self) -> (DVec3, DVec3) {
        let (sin, cos) = real::sin_cos(self.yaw_rad);
        let half = self.half_extents_m;
        let reach =
            DVec3::new(cos.abs() * half.x + sin.abs() * half.y, sin.abs() * half.x + cos.abs() * half.y, half.z);
        (self.center_in_world - reach, self.center_in_world + reach)
    }
}
