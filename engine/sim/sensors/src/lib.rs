//! Sensors that are no cameras: numbers at moments of a flight.
//!
//! * [`ALL`]: the sensors, one file and one entry each; recipes, environments and policies find them here by name.
//! * [`SensedFlight`]: a flight with a place for a sensor, which is read along it. [`SensorSet`]: those that an environment reads.

mod config;
mod flown;
mod laser_altimeter;
mod odometry;
mod place;
mod sensor;
mod set;
#[cfg(test)]
mod tests;

pub use config::SenseConfig;
pub use flown::{Reading, SensedFlight};
pub use place::SensorPlace;
pub use sensor::{Quantity, Sensor, SensorMoment};
pub use set::SensorSet;

/// All sensors, sorted by name.
pub static ALL: &[&Sensor] = &[
    // Each has a file of its own.
    &laser_altimeter::SENSOR,
    &odometry::SENSOR,
];

/// The sensor called `name`.
pub fn called(name: &str) -> Option<&'static Sensor> {
    ALL.iter().copied().find(|sensor| sensor.name == name)
}
