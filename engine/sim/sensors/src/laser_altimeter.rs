//! Sensor `laser_altimeter`: a beam straight down.

use crate::sensor::{Carrier, Quantity, Sensor, SensorMoment};
use cosfly_frames::DVec3;

/// Range of the beam, metres; that of common laser altimeters for drones.
const RANGE_M: f64 = 100.0;

/// Distance to the first roof, crown, body or ground below.
pub static SENSOR: Sensor = Sensor {
    name: "laser_altimeter",
    doc: "A gimballed laser beam straight down, 100 m at most, without noise: it meets the town's boxes, its ground, and people \
          and vehicles as boxes.",
    version: 3,
    carrier: Carrier::Camera,
    quantities: &[
        Quantity { name: "range_m", doc: "distance to the first thing below, metres; 100 where nothing is nearer" },
        Quantity { name: "is_hit", doc: "1 where something is within the range, else 0" },
    ],
    truths: &[
        Quantity { name: "true_x_m", doc: "x of the sensor, where the beam begins, world frame, metres" },
        Quantity { name: "true_y_m", doc: "y of the sensor, world frame, metres" },
        Quantity { name: "true_z_m", doc: "z of the sensor, world frame, metres" },
    ],
    read,
};

fn read(at: &SensorMoment<'_>, values: &mut [f64]) {
    let from = at.sensor_in_world.position_in_world;
    let ground_m = at.ground.ground_below(from, 0.0).map(|ground| from.z - ground.height_m);
    let nearest_m = [at.hit_m(-DVec3::Z, RANGE_M), ground_m].into_iter().flatten().fold(f64::INFINITY, f64::min);
    values[0] = nearest_m.min(RANGE_M);
    values[1] = f64::from(u8::from(nearest_m <= RANGE_M));
    values[2..].copy_from_slice(&from.to_array());
}
