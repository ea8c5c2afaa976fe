//! [`Controller`]: from a setpoint to thrust and body rates, and from those to speeds of the rotors.

use super::dynamics::QuadrotorState;
use super::parameters::{GRAVITY_MPS2, QuadrotorParameters};
use cosfly_frames::{DMat3, DQuat, DVec3, real};
use glam::{DMat4, DVec4};

/// Wanted motion, right-handed inertial frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Setpoint {
    /// Position, metres.
    pub position_m: DVec3,
    /// Velocity, m/s.
    pub velocity_mps: DVec3,
    /// Acceleration, m/s^2.
    pub acceleration_mps2: DVec3,
    /// Yaw, radians, x towards y (to the left).
    pub yaw_rad: f64,
}

/// Collective thrust and body rates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThrustAndRates {
    /// Sum of the thrusts, N.
    pub thrust_n: f64,
    /// Rates of turning around the body's axes, rad/s.
    pub rates_rad_s: DVec3,
}

/// Gains of a controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlGains {
    /// Acceleration per error of the position, 1/s^2.
    pub position: f64,
    /// Acceleration per error of the velocity, 1/s.
    pub velocity: f64,
    /// Largest acceleration, m/s^2.
    pub acceleration_mps2: f64,
    /// Rate of turning per error of the attitude, around each axis of the body, 1/s.
    pub attitude: DVec3,
    /// Angular acceleration per error of the rates, around each axis of the body, 1/s.
    pub rates: DVec3,
    /// Time within which rotors are brought to their wanted speeds, by commands beyond those, seconds.
    pub spin_s: f64,
    /// Largest tilt, radians.
    pub tilt_rad: f64,
}

impl Default for ControlGains {
    /// A critically damped loop of 2 rad/s around an attitude of 8 and rates of 25 rad/s; yaw is slower, because rotors turn the
    /// body around its vertical axis with little torque.
    fn default() -> Self {
        Self {
            position: 4.0,
            velocity: 4.0,
            acceleration_mps2: 6.0,
            attitude: DVec3::new(8.0, 8.0, 2.0),
            rates: DVec3::new(25.0, 25.0, 5.0),
            spin_s: 0.01,
            tilt_rad: 45.0_f64.to_radians(),
        }
    }
}

/// A controller of a quadrotor.
#[derive(Clone, Debug)]
pub struct Controller {
    gains: ControlGains,
    parameters: QuadrotorParameters,
    /// Thrusts of the rotors from collective thrust and torques.
    thrusts_from_wrench: DMat4,
}

impl Controller {
    /// The controller of a quadrotor.
    pub fn new(parameters: &QuadrotorParameters, gains: ControlGains) -> Self {
        let hover_rpm = parameters.hover_rpm();
        let ratio_m = parameters.torque_nm(hover_rpm) / parameters.thrust_n(hover_rpm);
        let [roll, pitch, yaw] = &parameters.mixing;
        let column = |rotor: usize| {
            DVec4::new(1.0, parameters.arm_m * roll[rotor], parameters.arm_m * pitch[rotor], ratio_m * yaw[rotor])
        };
        let wrench_from_thrusts = DMat4::from_cols(column(0), column(1), column(2), column(3));
        Self { gains, parameters: parameters.clone(), thrusts_from_wrench: wrench_from_thrusts.inverse() }
    }

    /// Thrust and body rates that lead to a setpoint.
    pub fn track(&self, state: &QuadrotorState, setpoint: &Setpoint) -> ThrustAndRates {
        let gains = &self.gains;
        let missing_m = setpoint.position_m - state.position_m;
        let missing_mps = setpoint.velocity_mps - state.velocity_mps;
        let wanted = setpoint.acceleration_mps2 + gains.position * missing_m + gains.velocity * missing_mps;
        let wanted = wanted.clamp_length_max(gains.acceleration_mps2);
        let lift = tilted_at_most(wanted + GRAVITY_MPS2 * DVec3::Z, gains.tilt_rad);
        let up = lift.normalize_or(DVec3::Z);
        let (sin, cos) = real::sin_cos(setpoint.yaw_rad);
        let left = up.cross(DVec3::new(cos, sin, 0.0)).normalize_or(DVec3::Y);
        let attitude = DQuat::from_mat3(&DMat3::from_cols(left.cross(up), left, up));
        let error = state.attitude.conjugate() * attitude;
        let sign = if error.w < 0.0 { -1.0 } else { 1.0 };
        let turn = 2.0 * sign * DVec3::new(error.x, error.y, error.z);
        let thrust_n = self.parameters.mass_kg * lift.dot(state.attitude * DVec3::Z);
        ThrustAndRates { thrust_n, rates_rad_s: gains.attitude * turn }
    }

    /// Thrusts of the rotors for thrust and body rates, N, whether rotors have them or not.
    fn thrusts_n(&self, state: &QuadrotorState, wanted: &ThrustAndRates) -> [f64; 4] {
        let inertia = self.parameters.inertia_kgm2;
        let rates = state.rates_rad_s;
        let torque = inertia * (self.gains.rates * (wanted.rates_rad_s - rates)) + rates.cross(inertia * rates);
        (self.thrusts_from_wrench * DVec4::new(wanted.thrust_n, torque.x, torque.y, torque.z)).to_array()
    }

    /// Whether thrust and body rates ask a rotor for more or less thrust than it has.
    pub fn saturates(&self, state: &QuadrotorState, wanted: &ThrustAndRates) -> bool {
        let (low, high) = self.parameters.speed_rpm;
        let allowed = self.parameters.thrust_n(low)..=self.parameters.thrust_n(high);
        self.thrusts_n(state, wanted).iter().any(|thrust_n| !allowed.contains(thrust_n))
    }

    /// Speeds of the rotors for thrust and body rates, rev/min. Where a rotor is at its limit the thrusts follow as far as they can.
    pub fn rotors_rpm(&self, state: &QuadrotorState, wanted: &ThrustAndRates) -> [f64; 4] {
        let speeds = self.thrusts_n(state, wanted).map(|thrust_n| self.parameters.speed_of_thrust_rpm(thrust_n));
        core::array::from_fn(|rotor| self.spun_to(state.rotors_rpm[rotor], speeds[rotor]))
    }
}

impl Controller {
    /// Command that brings a rotor from a speed to another one within the time that the gains give, where its limits allow; rev/min.
    fn spun_to(&self, speed_rpm: f64, wanted_rpm: f64) -> f64 {
        let [rise, rise_square, fall, fall_square] = self.parameters.spin;
        let (linear, square) = if wanted_rpm > speed_rpm { (rise, rise_square) } else { (fall, fall_square) };
        // linear * c + square * c^2 = pull
        let pull = linear * speed_rpm + square * speed_rpm * speed_rpm + (wanted_rpm - speed_rpm) / self.gains.spin_s;
        let under = linear * linear + 4.0 * square * pull;
        let command = match square {
            0.0 => pull / linear,
            _ if under > 0.0 => (under.sqrt() - linear) / (2.0 * square),
            _ => 0.0,
        };
        command.clamp(self.parameters.speed_rpm.0, self.parameters.speed_rpm.1)
    }
}

/// The vector, turned towards the vertical until its tilt is allowed; its height stays.
fn tilted_at_most(lift: DVec3, tilt_rad: f64) -> DVec3 {
    let up = lift.z.max(0.2 * GRAVITY_MPS2);
    let level = lift.truncate().clamp_length_max(up * real::tan(tilt_rad));
    level.extend(up)
}
