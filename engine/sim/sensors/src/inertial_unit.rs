//! Sensor `inertial_unit`: specific force and angular velocity.

use crate::drift::Drift;
use crate::sensor::{Carrier, Quantity, Sensor, SensorMoment};
use cosfly_frames::{DQuat, DVec3};

/// Errors of three axes of one kind.
pub(crate) struct AxisErrors {
    /// Density of the white noise, unit per root hertz.
    pub(crate) density: f64,
    /// In-run instability of the bias, unit.
    pub(crate) bias: Drift,
    /// Standard deviation of the constant bias that calibration leaves, unit.
    pub(crate) constant: f64,
    purpose: &'static str,
}

/// Gyroscopes of the data sheet of the ADIS16448: 0.66 deg/sqrt(h), 14.5 deg/h; 0.05 deg/s left by calibration.
pub(crate) const GYROSCOPE: AxisErrors = AxisErrors {
    density: 1.92e-4,
    bias: Drift { deviation: 7.03e-5, time_constant_s: 300.0 },
    constant: 8.73e-4,
    purpose: "gyroscope",
};

/// Accelerometers of the same data sheet: 0.11 m/s/sqrt(h), 0.25 mg; 2 mg left by calibration.
pub(crate) const ACCELEROMETER: AxisErrors = AxisErrors {
    density: 1.83e-3,
    bias: Drift { deviation: 2.45e-3, time_constant_s: 300.0 },
    constant: 1.96e-2,
    purpose: "accelerometer",
};

/// An inertial unit, fixed to the airframe.
pub static SENSOR: Sensor = Sensor {
    name: "inertial_unit",
    doc: "Specific force and angular velocity of the airframe along the sensor's left-handed axes (x ahead, y right, z up), with white \
          noise, a bias that wanders and a constant one, of the class of the ADIS16448.",
    version: 1,
    carrier: Carrier::Airframe,
    quantities: &[
        Quantity { name: "force_x_mps2", doc: "specific force ahead, m/s^2" },
        Quantity { name: "force_y_mps2", doc: "specific force to the right, m/s^2" },
        Quantity { name: "force_z_mps2", doc: "specific force up, m/s^2; 9.81 at rest" },
        Quantity { name: "rate_x_rad_s", doc: "angular velocity around x, rad/s; positive: right side up" },
        Quantity { name: "rate_y_rad_s", doc: "angular velocity around y, rad/s; positive: nose down" },
        Quantity { name: "rate_z_rad_s", doc: "angular velocity around z, rad/s; positive: nose to the right" },
    ],
    truths: &[
        Quantity { name: "true_force_x_mps2", doc: "`force_x_mps2` without errors" },
        Quantity { name: "true_force_y_mps2", doc: "`force_y_mps2` without errors" },
        Quantity { name: "true_force_z_mps2", doc: "`force_z_mps2` without errors" },
        Quantity { name: "true_rate_x_rad_s", doc: "`rate_x_rad_s` without errors" },
        Quantity { name: "true_rate_y_rad_s", doc: "`rate_y_rad_s` without errors" },
        Quantity { name: "true_rate_z_rad_s", doc: "`rate_z_rad_s` without errors" },
        Quantity { name: "true_x_m", doc: "x of the sensor, world frame, metres" },
        Quantity { name: "true_y_m", doc: "y of the sensor, world frame, metres" },
        Quantity { name: "true_z_m", doc: "z of the sensor, world frame, metres" },
        Quantity { name: "true_velocity_x_mps", doc: "velocity of the sensor along x of the world, m/s" },
        Quantity { name: "true_velocity_y_mps", doc: "velocity of the sensor along y of the world, m/s" },
        Quantity { name: "true_velocity_z_mps", doc: "velocity of the sensor along z of the world, m/s" },
        Quantity { name: "true_qx", doc: "x of the quaternion that turns vectors of the sensor into the world" },
        Quantity { name: "true_qy", doc: "y of that quaternion" },
        Quantity { name: "true_qz", doc: "z of that quaternion" },
        Quantity { name: "true_qw", doc: "w of that quaternion, not negative" },
    ],
    read,
};

impl AxisErrors {
    fn read(&self, exact: DVec3, at: &SensorMoment<'_>) -> DVec3 {
        let mut constants = at.flight_seed.stream(self.purpose);
        let mut noises = at.seed.stream(self.purpose);
        let wander: [f64; 3] = self.bias.at(&at.flight_seed, self.purpose, at.time_s);
        let white = self.density / at.step_s.sqrt();
        let error = |wander: f64| wander + constants.normal(0.0, self.constant) + noises.normal(0.0, white);
        exact + DVec3::from_array(wander.map(error))
    }
}

fn read(at: &SensorMoment<'_>, values: &mut [f64]) {
    let airframe = &at.airframe;
    let (force, rates) = (airframe.force_in_body(), airframe.rates_in_body);
    let turn = DQuat::from_mat3(&airframe.world_from_body);
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let vectors = [
        ACCELEROMETER.read(force, at),
        GYROSCOPE.read(rates, at),
        force,
        rates,
        airframe.position_in_world,
        airframe.velocity_in_world,
    ];
    let (of_vectors, of_turn) = values.split_at_mut(18);
    of_vectors.copy_from_slice(vectors.map(|vector| vector.to_array()).as_flattened());
    of_turn.copy_from_slice(&turn.to_array());
}
