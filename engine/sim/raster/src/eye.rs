//! The camera's position and turn: from the world to body axes, and whether a box is in view.

use crate::visibility::Screen;
use cosfly_frames::{DMat3, DVec3, Pose};

/// The camera's position and turn.
#[derive(Clone, Copy)]
pub struct Eye {
    /// Position, metres.
    pub position_in_world: DVec3,
    /// Columns are the camera's axes: ahead, right, up.
    pub world_from_body: DMat3,
    body_from_world: DMat3,
}

impl Eye {
    /// The eye of a camera in a pose.
    pub fn new(pose: &Pose) -> Self {
        let world_from_body = pose.world_from_body();
        Self {
            position_in_world: pose.position_in_world,
            world_from_body,
            body_from_world: world_from_body.transpose(),
        }
    }

    /// A world point in body axes.
    #[inline]
    pub fn see(&self, point_in_world: DVec3) -> DVec3 {
        self.body_from_world * (point_in_world - self.position_in_world)
    }

    /// A world direction in body axes.
    #[inline]
    pub fn turn(&self, direction_in_world: DVec3) -> DVec3 {
        self.body_from_world * direction_in_world
    }

    /// A drawing order (near first) of an axis-aligned box, or `None` when it lies outside the view.
    pub fn order_if_seen(&self, screen: &Screen, center_in_world: DVec3, half: DVec3) -> Option<u64> {
        let center = self.see(center_in_world);
        let rows = self.world_from_body;
        // Reach of the box along a body direction: |R^T axis| against its half sizes.
        let reach = |direction: DVec3| (rows * direction).abs().dot(half);
        let across = 0.5 * screen.width as f64 / screen.focal_px;
        let up = 0.5 * screen.height as f64 / screen.focal_px;
        for plane in [
            DVec3::X,
            DVec3::new(across, 1.0, 0.0),
            DVec3::new(across, -1.0, 0.0),
            DVec3::new(up, 0.0, 1.0),
            DVec3::new(up, 0.0, -1.0),
        ] {
            if plane.dot(center) + reach(plane) < 0.0 {
                return None;
            }
        }
        let nearest = ((center_in_world - self.position_in_world).abs() - half).max(DVec3::ZERO);
        Some((nearest.length_squared() * 1024.0) as u64)
    }
}
