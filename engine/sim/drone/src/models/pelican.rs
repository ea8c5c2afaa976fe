//! `pelican`: the quadrotor AscTec Pelican.

use super::model::DroneModel;
use crate::quadrotor::{Gyroscope, QuadrotorParameters};
use cosfly_frames::{DVec3, real};

pub(super) const MODEL: DroneModel =
    DroneModel { name: "pelican", doc: "the quadrotor AscTec Pelican, 1 kg", parameters: Some(parameters) };

/// Rev/min in rad/s.
const RPM: f64 = real::TAU / 60.0;

/// AscTec Pelican, 1 kg: the figures of the simulator RotorS (`pelican.xacro`: mass, inertia, arm, motor and moment constants,
/// time constants, largest speed; rotors of 10 g as flat bars of 128 by 15 mm). Its drag of the rotors, which grows with their
/// speed, is taken at hover (496 rad/s).
fn parameters() -> QuadrotorParameters {
    let (thrust, ratio_m) = (9.9865e-6 * RPM * RPM, 0.016);
    let drag = -4.0 * 8.06428e-5 * 495.6;
    QuadrotorParameters {
        mass_kg: 1.0,
        arm_m: 0.21,
        inertia_kgm2: DVec3::new(0.01, 0.01, 0.02),
        thrust: [0.0, 0.0, thrust],
        torque: [0.0, 0.0, ratio_m * thrust],
        spin: [1.0 / 0.0125, 0.0, 1.0 / 0.025, 0.0],
        // Front, left, back, right; front and back turn clockwise, their torque on the body is to the left.
        mixing: [[0.0, 1.0, 0.0, -1.0], [-1.0, 0.0, 1.0, 0.0], [1.0, -1.0, 1.0, -1.0]],
        drag: DVec3::new(drag, drag, 0.0),
        rotor_inertia_kgm2: 0.01 / 12.0 * (0.128 * 0.128 + 0.015 * 0.015),
        gyroscope: Gyroscope::Exact,
        speed_rpm: (0.0, 838.0 / RPM),
    }
}
