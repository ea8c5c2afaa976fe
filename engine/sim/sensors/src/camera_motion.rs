//! [`CameraMotion`]: a sensor that the camera carries, which moves evenly from frame to frame.

use crate::place::SensorPlace;
use cosfly_frames::{DVec3, Pose};
use cosfly_optics::pose_at;

/// Motion of a sensor on the camera's drone, at frame numbers that may lie between two frames. Poses are of the drone, at least one.
#[derive(Clone, Copy, Debug)]
pub struct CameraMotion<'a> {
    /// Pose of the drone in each frame, world frame.
    pub poses_in_world: &'a [Pose],
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// Where the sensor sits.
    pub place: SensorPlace,
}

impl CameraMotion<'_> {
    /// Pose of the sensor.
    pub fn pose(&self, at: f64) -> Pose {
        let last = (self.poses_in_world.len() - 1) as f64;
        self.place.on(&pose_at(self.poses_in_world, at.clamp(0.0, last)))
    }

    /// Mean velocity over the time of a frame around a frame number, m/s; over its inner half at both ends of the flight.
    pub fn velocity(&self, at: f64) -> DVec3 {
        let last = (self.poses_in_world.len() - 1) as f64;
        let (before, after) = ((at - 0.5).max(0.0), (at + 0.5).min(last));
        let way = self.pose(after).position_in_world - self.pose(before).position_in_world;
        way / ((after - before) * self.dt_s).max(1e-9)
    }
}
