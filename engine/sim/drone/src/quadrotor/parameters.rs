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

/// Rev/min in rad/s.
const RPM: f64 = cosfly_frames::real::TAU / 60.0;

impl QuadrotorParameters {
    /// Crazyflie 2.x with the large propellers: parameter set `cf2x_L250` of `drone-models` 0.1.0 (identified by its authors).
    /// The speeds are those of its least and largest thrust.
    pub fn crazyflie() -> Self {
        Self {
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

    /// AscTec Pelican, 1 kg: the figures of the simulator RotorS (`pelican.xacro`: mass, inertia, arm, motor and moment constants,
    /// time constants, largest speed; rotors of 10 g as flat bars of 128 by 15 mm). Its drag of the rotors, which grows with their
    /// speed, is taken at hover (496 rad/s).
    pub fn pelican() -> Self {
        let (thrust, ratio_m) = (9.9865e-6 * RPM * RPM, 0.016);
        let drag = -4.0 * 8.06428e-5 * 495.6;
        Self {
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
