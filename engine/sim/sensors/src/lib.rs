//! Sensors that are no cameras: numbers at moments of a flight.
//!
//! * [`ALL`]: the sensors, one file and one entry each; recipes, environments and policies find them here by name.
//! * [`Airframe`]: the body of a quadrotor whose attitude follows from its acceleration; [`SmoothFlight`]: its flight between frames.
//! * [`lidar`]: sensors whose reading is a cloud of points.
//! * [`SensedFlight`]: a flight with a place for a sensor, which is read along it. [`SensorSet`]: those that an environment reads.

mod airframe;
mod barometer;
mod camera_motion;
mod config;
mod constellation;
mod drift;
mod flown;
mod geo_origin;
mod inertial_unit;
mod laser_altimeter;
pub mod lidar;
mod magnetometer;
mod odometry;
mod place;
mod satellite_receiver;
mod sensor;
mod set;
mod smooth_flight;
#[cfg(test)]
mod tests;

pub use airframe::{Airframe, Derivatives, GRAVITY_MPS2};
pub use camera_motion::CameraMotion;
pub use config::SenseConfig;
pub use drift::Drift;
pub use flown::{Reading, SensedFlight};
pub use geo_origin::GeoOrigin;
pub use place::SensorPlace;
pub use sensor::{Carrier, Quantity, Sensor, SensorMoment};
pub use set::SensorSet;
pub use smooth_flight::SmoothFlight;

/// All sensors, sorted by name.
pub static ALL: &[&Sensor] = &[
    // Each has a file of its own.
    &barometer::SENSOR,
    &inertial_unit::SENSOR,
    &laser_altimeter::SENSOR,
    &magnetometer::SENSOR,
    &odometry::SENSOR,
    &satellite_receiver::SENSOR,
];

/// The sensor called `name`.
pub fn called(name: &str) -> Option<&'static Sensor> {
    ALL.iter().copied().find(|sensor| sensor.name == name)
}
