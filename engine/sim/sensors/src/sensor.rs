//! The entry of a sensor: name, meaning, quantities, and how a moment is read.

use crate::airframe::Airframe;
use crate::geo_origin::GeoOrigin;
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
    /// Its carrier, which says how it moves.
    pub carrier: Carrier,
    /// Numbers of a reading, in the order of the table's columns.
    pub quantities: &'static [Quantity],
    /// Numbers without errors beside them, in datasets alone; their names begin with `true_`.
    pub truths: &'static [Quantity],
    /// Reads one moment; `values` has one place for each quantity, then one for each truth, all of which it fills with finite numbers.
    pub read: fn(&SensorMoment<'_>, &mut [f64]),
}

impl Sensor {
    /// Number of the numbers that it fills: quantities and truths.
    pub fn count(&self) -> usize {
        self.quantities.len() + self.truths.len()
    }
}

/// Carrier of a sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carrier {
    /// The camera: the sensor is turned as the pictures are, and moves evenly from frame to frame.
    Camera,
    /// The airframe: the sensor is turned as a quadrotor that flies the frames' positions, and moves smoothly.
    Airframe,
}

/// One number of a reading.
#[derive(Debug)]
pub struct Quantity {
    /// Name of the column, with its unit: `range_m`.
    pub name: &'static str,
    /// Meaning, unit and frame, a fragment.
    pub doc: &'static str,
}

/// Surroundings of a sensor at one moment. World frame: CARLA's, metres, radians.
#[derive(Clone, Copy)]
pub struct SensorMoment<'a> {
    /// Time since the first frame, seconds.
    pub time_s: f64,
    /// Pose of the sensor: its place on the drone, and its own turn (x ahead, y right, z up).
    pub sensor_in_world: Pose,
    /// Velocity of the sensor, m/s.
    pub velocity_in_world: DVec3,
    /// Time between readings, seconds.
    pub step_s: f64,
    /// The sensor on the airframe, whatever carries it, with its acceleration and angular velocity.
    pub airframe: Airframe,
    /// Solid boxes of the town.
    pub town: &'a BoxBvh,
    /// Height of the ground.
    pub ground: &'a GroundIndex,
    /// Boxes of the people and vehicles that are there now, the target among them.
    pub bodies: &'a [OrientedBox],
    /// Place of the world on the globe.
    pub origin: GeoOrigin,
    /// Seed of this reading, for noise.
    pub seed: Seed,
    /// Seed of the flight, for what changes slowly.
    pub flight_seed: Seed,
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
