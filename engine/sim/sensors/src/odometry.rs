//! Sensor `odometry`: own motion.

use crate::sensor::{Carrier, Quantity, Sensor, SensorMoment};
use cosfly_frames::DVec3;

/// Axis and velocity of the sensor along the world's axes; in environments and on flights of policies the sensor is turned as the camera.
pub static SENSOR: Sensor = Sensor {
    name: "odometry",
    doc: "Own motion as a visual and inertial odometry with a compass estimates it, without noise and drift: where the sensor \
          looks, and how fast it moves, along the axes of the world.",
    version: 1,
    carrier: Carrier::Camera,
    quantities: &[
        Quantity { name: "axis_x", doc: "unit vector along which the sensor looks, world frame, x" },
        Quantity { name: "axis_y", doc: "the same, y" },
        Quantity { name: "axis_z", doc: "the same, z" },
        Quantity { name: "velocity_x_mps", doc: "velocity of the sensor along x of the world, m/s" },
        Quantity { name: "velocity_y_mps", doc: "velocity of the sensor along y of the world, m/s" },
        Quantity { name: "velocity_z_mps", doc: "velocity of the sensor along z of the world, m/s" },
    ],
    truths: &[],
    read,
};

fn read(at: &SensorMoment<'_>, values: &mut [f64]) {
    let axis = at.sensor_in_world.world_from_body() * DVec3::X;
    values[..3].copy_from_slice(&axis.to_array());
    values[3..].copy_from_slice(&at.velocity_in_world.to_array());
}
