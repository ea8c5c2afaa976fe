//! The pinhole camera: intrinsics, and the way from the world to a pixel.

use cosfly_frames::{DVec3, Pose, real};
use serde::{Deserialize, Serialize};

/// A pinhole camera with square pixels and the optical centre in the image centre (CARLA's camera).
/// Pixel (0, 0) is the top-left pixel; its centre is at (0.5, 0.5).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// Image width, pixels.
    pub width: u32,
    /// Image height, pixels.
    pub height: u32,
    /// Horizontal field of view, radians.
    pub horizontal_fov_rad: f64,
}

impl Camera {
    /// Focal length in pixels, the same for both axes: width / (2 tan(fov / 2)).
    pub fn focal_px(&self) -> f64 {
        f64::from(self.width) / (2.0 * real::tan(0.5 * self.horizontal_fov_rad))
    }

    /// Pixel coordinates (u right, v down) and planar depth (metres along the optical axis) of a world point;
    /// `None` when it is not in front of the camera.
    pub fn project(&self, pose: &Pose, point_in_world: DVec3) -> Option<(f64, f64, f64)> {
        let seen = pose.body_from_world_point(point_in_world);
        if seen.x <= 1e-6 {
            return None;
        }
        let focal = self.focal_px();
        let u = 0.5 * f64::from(self.width) + focal * seen.y / seen.x;
        let v = 0.5 * f64::from(self.height) - focal * seen.z / seen.x;
        Some((u, v, seen.x))
    }

    /// The world direction through pixel coordinates (u, v), scaled so that its length along the optical
    /// axis is 1: `pose.position_in_world + depth * ray` is the point at that planar depth.
    pub fn ray_in_world(&self, pose: &Pose, u: f64, v: f64) -> DVec3 {
        let focal = self.focal_px();
        let y = (u - 0.5 * f64::from(self.width)) / focal;
        let z = (0.5 * f64::from(self.height) - v) / focal;
        pose.world_from_body() * DVec3::new(1.0, y, z)
    }
}
