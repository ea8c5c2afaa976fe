//! A flight, and the readings of a sensor along it.

use crate::camera_motion::CameraMotion;
use crate::geo_origin::GeoOrigin;
use crate::place::SensorPlace;
use crate::sensor::{Carrier, Sensor, SensorMoment};
use crate::smooth_flight::SmoothFlight;
use cosfly_domain::OrientedBox;
use cosfly_frames::{Pose, Seed};
use cosfly_geometry::BoxBvh;
use cosfly_town::GroundIndex;

/// A flight that carries a sensor.
#[derive(Clone, Copy)]
pub struct SensedFlight<'a> {
    /// Solid boxes of the town around the drone.
    pub town: &'a BoxBvh,
    /// Height of the ground.
    pub ground: &'a GroundIndex,
    /// Adds the boxes of the people and vehicles that are there at a time, seconds since the first frame.
    pub bodies: &'a dyn Fn(f64, &mut Vec<OrientedBox>),
    /// Pose of the drone in each frame.
    pub poses_in_world: &'a [Pose],
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// Where the sensor sits.
    pub place: SensorPlace,
    /// Readings a second from the first frame on; `None` for one in each frame.
    pub rate_hz: Option<f64>,
    /// Place of the world on the globe.
    pub origin: GeoOrigin,
    /// Seed of the noise.
    pub seed: Seed,
}

/// One reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading<'a> {
    /// Frame at the time of the reading, or the last one before it.
    pub frame: usize,
    /// Time since the first frame, seconds.
    pub time_s: f64,
    /// Numbers in the order of the sensor's quantities, then of its truths.
    pub values: &'a [f64],
}

impl SensedFlight<'_> {
    /// Number of readings.
    pub fn readings(&self) -> usize {
        let frames = self.poses_in_world.len();
        match self.rate_hz {
            Some(rate_hz) if frames > 0 => {
                // Half a microsecond keeps the last one where the times meet.
                (((frames - 1) as f64 * self.dt_s + 5e-7) * rate_hz) as usize + 1
            }
            _ => frames,
        }
    }

    /// Reads a sensor at every moment, in their order. Between frames the camera moves evenly, the airframe smoothly.
    pub fn read(&self, sensor: &Sensor, each: &mut dyn FnMut(Reading<'_>)) {
        let step_s = self.rate_hz.map_or(self.dt_s, f64::recip);
        let (mut values, mut bodies) = (vec![0.0; sensor.count()], vec![]);
        if self.poses_in_world.is_empty() {
            return;
        }
        let smooth = SmoothFlight::new(self.poses_in_world, self.dt_s);
        let camera = CameraMotion { poses_in_world: self.poses_in_world, dt_s: self.dt_s, place: self.place };
        for index in 0..self.readings() {
            let time_s = index as f64 * step_s;
            let at = time_s / self.dt_s;
            bodies.clear();
            (self.bodies)(time_s, &mut bodies);
            let airframe = smooth.at(at).at(&self.place);
            let (sensor_in_world, velocity_in_world) = match sensor.carrier {
                Carrier::Camera => (camera.pose(at), camera.velocity(at)),
                Carrier::Airframe => (airframe.pose(), airframe.velocity_in_world),
            };
            let moment = SensorMoment {
                time_s,
                sensor_in_world,
                velocity_in_world,
                step_s,
                airframe,
                town: self.town,
                ground: self.ground,
                bodies: &bodies,
                origin: self.origin,
                flight_seed: self.seed,
                seed: self.seed.child("reading", index as u64),
            };
            (sensor.read)(&moment, &mut values);
            // A microsecond before a frame is that frame.
            each(Reading { frame: (at + 1e-6) as usize, time_s, values: &values });
        }
    }
}
