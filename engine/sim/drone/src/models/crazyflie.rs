//! `crazyflie`: the quadrotor Crazyflie 2.x.

use super::model::DroneModel;
use crate::quadrotor::{Gyroscope, QuadrotorParameters};
use cosfly_frames::DVec3;

pub(super) const MODEL: DroneModel =
    DroneModel { name: "crazyflie", doc: "the quadrotor Crazyflie 2.x, 32 g", parameters: Some(parameters) };

/// Crazyflie 2.x with the large propellers: parameter set `cf2x_L250` of `drone-models` 0.1.0 (identified by its authors).
/// The speeds are those of its least and largest thrust.
fn parameters() -> QuadrotorParameters {
    QuadrotorParameters {
        mass_kg: 0.0319,
        arm_m: 0.03253,
        inertia_kgm2: DVec3::new(16.8e-6, 16.8e-6, 29.8e-6),
        thrust: [0.0, -5.382196214637237e-7, 2.4582929831265485e-10],
        torque: [0.0, 1.410454111996297e-9, 1.4592584373980652e-12],
        spin: [7.355623702172756, 0.0, 0.0, 0.00024443862952110715],
        mixing: [[-1.0, -1.0, 1.0, 1.0], [-1.0, 1.0, 1.0, -1.0], [-1.0, 1.0, -1.0, 1.0]],
        drag: DVec3::new(-0.01471782, -0.01471782, -0.01277641),
        rotor_inertia_kgm2: 34.52e-9,
        gyroscope: Gyroscope::Exact,
        speed_rpm: (8_400.0, 23_200.0),
    }
}
