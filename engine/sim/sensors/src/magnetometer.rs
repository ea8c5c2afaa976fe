//! Sensor `magnetometer`: the Earth's magnetic field.

use crate::sensor::{Carrier, Quantity, Sensor, SensorMoment};
use cosfly_frames::{DVec3, real};

/// Field of a dipole along the Earth's axis at the equator, microtesla.
const EQUATOR_UT: f64 = 31.2;
/// White noise of a reading along each axis, microtesla: that of the LIS3MDL.
const NOISE_UT: f64 = 0.4;
/// Constant field of the drone itself that calibration leaves, microtesla.
const CONSTANT_UT: f64 = 0.5;

/// A magnetometer, fixed to the airframe.
pub static SENSOR: Sensor = Sensor {
    name: "magnetometer",
    doc: "Magnetic field of a dipole along the Earth's axis at the world's latitude, without declination, along the sensor's \
          left-handed axes, with white noise of 0.4 microtesla a reading (the class of the LIS3MDL) and a constant error.",
    version: 1,
    carrier: Carrier::Airframe,
    quantities: &[
        Quantity { name: "field_x_ut", doc: "field ahead, microtesla" },
        Quantity { name: "field_y_ut", doc: "field to the right, microtesla" },
        Quantity { name: "field_z_ut", doc: "field up, microtesla" },
    ],
    truths: &[
        Quantity { name: "true_field_x_ut", doc: "`field_x_ut` without errors" },
        Quantity { name: "true_field_y_ut", doc: "`field_y_ut` without errors" },
        Quantity { name: "true_field_z_ut", doc: "`field_z_ut` without errors" },
    ],
    read,
};

fn read(at: &SensorMoment<'_>, values: &mut [f64]) {
    let (sin, cos) = real::sin_cos(at.origin.latitude_deg.to_radians());
    // To the north, which is against y, and into the ground in the north.
    let field_in_world = EQUATOR_UT * DVec3::new(0.0, -cos, -2.0 * sin);
    let exact = at.airframe.world_from_body.transpose() * field_in_world;
    let (mut constants, mut noises) = (at.flight_seed.stream("magnetometer"), at.seed.stream("magnetometer"));
    let error = |value: f64| value + constants.normal(0.0, CONSTANT_UT) + noises.normal(0.0, NOISE_UT);
    values.copy_from_slice([exact.to_array().map(error), exact.to_array()].as_flattened());
}
