//! The entry of a sensor: name, meaning, quantities, and how a moment is read.

use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, Pose, Seed};
use cosfly_geometry::{BoxBvh, BruteForce, SpatialQuery};
use cosfly_town::GroundIndex;

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
    pub read: fn(&SensorMoment<'_>, &mut [f64]),
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
pub struct SensorMoment<'a> {
    /// Time since the first frame, seconds.
    pub time_s: f64,
    /// Pose of the sensor: its place on the drone, and its own turn (x ahead, y right, z up).
    pub sensor_in_world: Pose,
    /// Velocity of the sensor, m/s.
    pub velocity_in_world: DVec3,
    /// Solid boxes of the town.
    pub town: &'a BoxBvh,
    /// Height of the ground.
    pub ground: &'a GroundIndex,
    /// Boxes of the people and vehicles that are there now, the target among them.
    pub bodies: &'a [OrientedBox],
    /// Seed of this reading, for noise.
    pub seed: Seed,
}

impl SensorMoment<'_> {
    /// Distance from the sensor along a direction of length 1 to the first box of the town or of a body, metres; `None` beyond `range_m`.
    pub fn hit_m(&self, direction_in_world: DVec3, range_m: f64) -> Option<f64> {
        let from = self.sensor_in_world.position_in_world;
        let town = self.town.closest_hit(from, direction_in_world, range_m);
        let body = BruteForce::new(self.bodies).closest_hit(from, direction_in_world, range_m);
        [town, body].into_iter().flatten().map(|hit| hit.t).reduce(f64::min)
    }
}
