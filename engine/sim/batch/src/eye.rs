//! The camera: its position, its turn, and the ray of each pixel as a linear function.

use cosfly_frames::{DMat3, DVec3, Pose, real};

/// Nothing nearer than this along the optical axis is drawn, metres (as in large pictures).
pub const NEAR_M: f64 = 0.01;

/// A linear function over the image: its value at the centre, its steps per pixel to the right and down.
pub type Linear = [f64; 3];

/// A linear function times a number. Written out, as all that runs once for each shape: `map` of arrays is a call.
#[inline(always)]
pub fn scaled([center, across, down]: Linear, by: f64) -> Linear {
    [center * by, across * by, down * by]
}

/// A linear function in single precision.
#[inline(always)]
pub fn in_single([center, across, down]: Linear) -> [f32; 3] {
    [center as f32, across as f32, down as f32]
}

/// A camera with the size of its pictures.
#[derive(Clone, Copy)]
pub struct Eye {
    pub position_in_world: DVec3,
    pub focal_px: f64,
    /// Half the width and half the height, pixels.
    pub half_px: [f64; 2],
    /// The ray through the image's centre, and its change per pixel to the right and down; its length along the optical
    /// axis is 1.
    pub ray_in_world: [DVec3; 3],
    pub body_from_world: DMat3,
    /// The world's axes as [`Self::pixels_ahead`].
    pub turn_to_pixels: [[f32; 3]; 3],
}

impl Eye {
    pub fn new(pose: &Pose, width: usize, height: usize, horizontal_fov_rad: f64) -> Self {
        let world_from_body = pose.world_from_body();
        let half_px = [0.5 * width as f64, 0.5 * height as f64];
        let focal_px = half_px[0] / real::tan(0.5 * horizontal_fov_rad);
        let body_from_world = world_from_body.transpose();
        let axes = [body_from_world.x_axis, body_from_world.y_axis, body_from_world.z_axis];
        let to_pixels = |axis: DVec3| DVec3::new(axis.x, focal_px * axis.y, -focal_px * axis.z).as_vec3().to_array();
        Self {
            position_in_world: pose.position_in_world,
            focal_px,
            half_px,
            ray_in_world: [
                world_from_body.x_axis,
                world_from_body.y_axis / focal_px,
                -world_from_body.z_axis / focal_px,
            ],
            body_from_world,
            turn_to_pixels: axes.map(to_pixels),
        }
    }

    /// A world point in body axes (x ahead, y right, z up).
    #[inline]
    pub fn see(&self, point_in_world: DVec3) -> DVec3 {
        self.body_from_world * (point_in_world - self.position_in_world)
    }

    /// A point in body axes with its ways across and down in pixels times metres: divided by the way ahead, it is a place in
    /// the image.
    #[inline]
    pub fn pixels_ahead(&self, seen: DVec3) -> DVec3 {
        DVec3::new(seen.x, self.focal_px * seen.y, -self.focal_px * seen.z)
    }

    /// Component of each pixel's ray along a world direction.
    #[inline]
    pub fn along(&self, direction_in_world: DVec3) -> Linear {
        let [center, across, down] = &self.ray_in_world;
        [center.dot(direction_in_world), across.dot(direction_in_world), down.dot(direction_in_world)]
    }

    /// Inverse depth of the plane with a unit normal and the component `offset_m` of its points along it; `None` when the
    /// camera lies in it.
    #[inline]
    pub fn plane(&self, normal_in_world: DVec3, offset_m: f64) -> Option<Linear> {
        let distance = offset_m - normal_in_world.dot(self.position_in_world);
        if distance.abs() < 1e-12 || !distance.is_finite() {
            return None;
        }
        Some(scaled(self.along(normal_in_world), 1.0 / distance))
    }
}
