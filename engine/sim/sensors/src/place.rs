//! Where a sensor sits on the drone.

use cosfly_domain::Mount;
use cosfly_frames::{DVec3, Pose};

/// Place and turn of a sensor in the drone's body frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SensorPlace {
    /// Position: ahead, right, up; metres.
    pub position_in_body: DVec3,
    /// Turn against the drone.
    pub mount: Mount,
}

impl SensorPlace {
    /// Pose of the sensor on a drone at `body`.
    pub fn on(&self, body: &Pose) -> Pose {
        let position_in_world = body.position_in_world + body.world_from_body() * self.position_in_body;
        Pose { position_in_world, ..self.mount.camera_pose(body) }
    }
}
