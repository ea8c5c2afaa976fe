//! The entry of a sensor: name, meaning, quantities, and how a moment is read.

use cosfly_flight::World;
use cosfly_frames::{DVec3, Pose, Seed};

/// A sensor that gives numbers.
#[derive(Debug)]
pub struct Sensor {
    /// Name in recipes and of the table: lower-case letters and `_`.
    pub name: &'static str,
    /// Meaning with its model and its limits, a sentence.
    pub doc: &'static str,
    /// Raised whenever the readings change.
    pub version: u32,
    /// Numbers of a reading, in the order of the table's columns.
    pub quantities: &'static [Quantity],
    /// Reads one moment; `values` has one place for each quantity, all of which it fills with finite numbers.
    pub read: fn(&Moment<'_>, &mut [f64]),
}

/// One number of a reading.
#[derive(Debug)]
pub struct Quantity {
    /// Name of the column, with its unit: `range_m`.
    pub name: &'static str,
    /// Meaning, unit and frame, a fragment.
    pub doc: &'static str,
}

/// What surrounds a sensor at one moment. World frame: CARLA's, metres, radians.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// Time since the first frame, seconds.
    pub time_s: f64,
    /// Pose of the sensor: its place on the drone, and its own turn (x ahead, y right, z up).
    pub sensor_in_world: Pose,
    /// Velocity of the sensor, m/s.
    pub velocity_in_world: DVec3,
    /// Town with its solid boxes and its ground.
    pub world: &'a World,
    /// Seed of this reading, for noise.
    pub seed: Seed,
}
