//! Parameters of quadrotors, with their sources.

use cosfly_frames::DVec3;

/// Acceleration of free fall, m/s^2.
pub const GRAVITY_MPS2: f64 = 9.81;

/// Signs of the torque of spinning rotors on a body that rolls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gyroscope {
    /// Torque of mechanics: minus the cross product of body rates and the rotors' angular momentum.
    Exact,
    /// Torque of the Python package `drone-models` 0.1.0, with the other sign in the roll component; to compare with it.
    OfDroneModels,
}

/// Parameters of a quadrotor. Vectors are along the body's axes (x ahead, y left, z up).
#[derive(Clone, Debug, PartialEq)]
pub struct QuadrotorParameters {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Factor from thrusts to torques around x and y, metres: the arm's length, or its projection on the axes.
    pub arm_m: f64,
    /// Moments of inertia around x, y, z, kg m^2.
    pub inertia_kgm2: DVec3,
    /// Thrust of a rotor, N: constant, per rev/min, per its square.
    pub thrust: [f64; 3],
    /// Torque of a rotor around its axis, Nm: constant, per rev/min, per its square.
    pub torque: [f64; 3],
    /// Change of a rotor's speed, 1/s and per (rev/min) s: when it rises per difference and per difference of squares, when it
    /// falls per difference and per difference of squares.
    pub spin: [f64; 4],
    /// Signs of the rotors' thrusts around x and y, and of their torques around z.
    pub mixing: [[f64; 4]; 3],
    /// Force of the air along the axes, N per m/s of the velocity against the air; below 0.
    pub drag: DVec3,
    /// Moment of inertia of a rotor around its axis, kg m^2.
    pub rotor_inertia_kgm2: f64,
    /// Signs of the gyroscopic torque.
    pub gyroscope: Gyroscope,
    /// Lowest and highest speed of a rotor, rev/min.
    pub speed_rpm: (f64, f64),
}

impl QuadrotorParameters {
    /// Speed at which a rotor has a thrust, rev/min, within its limits.
    pub fn speed_of_thrust_rpm(&self, thrust_n: f64) -> f64 {
        let [constant, linear, square] = self.thrust;
        let (low, high) = self.speed_rpm;
        let under = linear * linear - 4.0 * square * (constant - thrust_n);
        let speed = if under > 0.0 { (under.sqrt() - linear) / (2.0 * square) } else { low };
        speed.clamp(low, high)
    }

    /// Thrust of a rotor at a speed, N.
    pub fn thrust_n(&self, speed_rpm: f64) -> f64 {
        polynomial(&self.thrust, speed_rpm)
    }

    /// Torque of a rotor around its axis at a speed, Nm.
    pub fn torque_nm(&self, speed_rpm: f64) -> f64 {
        polynomial(&self.torque, speed_rpm)
    }

    /// Speed of the rotors at hover, rev/min.
    pub fn hover_rpm(&self) -> f64 {
        self.speed_of_thrust_rpm(0.25 * self.mass_kg * GRAVITY_MPS2)
    }
}

fn polynomial([constant, linear, square]: &[f64; 3], x: f64) -> f64 {
    constant + linear * x + square * x * x
}
