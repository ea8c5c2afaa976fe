//! [`Quadrotor`]: the motion that follows from speeds of the rotors.

use super::parameters::{GRAVITY_MPS2, Gyroscope, QuadrotorParameters};
use cosfly_frames::{DMat3, DQuat, DVec3};

/// Time between ticks of the controller and of the model, seconds.
pub const TICK_S: f64 = 0.001;
/// Rev/min in rad/s.
const RPM: f64 = cosfly_frames::real::TAU / 60.0;

/// State of a quadrotor; right-handed frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadrotorState {
    /// Position, metres.
    pub position_m: DVec3,
    /// Attitude: turns vectors of the body into the inertial frame.
    pub attitude: DQuat,
    /// Velocity, inertial frame, m/s.
    pub velocity_mps: DVec3,
    /// Rates of turning around the body's axes, rad/s.
    pub rates_rad_s: DVec3,
    /// Speeds of the rotors, rev/min.
    pub rotors_rpm: [f64; 4],
}

/// Rates of change of a [`QuadrotorState`], without that of the attitude, which the rates of turning give.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derivative {
    /// Acceleration, inertial frame, m/s^2.
    pub acceleration_mps2: DVec3,
    /// Angular acceleration around the body's axes, rad/s^2.
    pub rates_rad_s2: DVec3,
    /// Change of the rotors' speeds, rev/min per second.
    pub rotors_rpm_s: [f64; 4],
}

/// A quadrotor.
#[derive(Clone, Debug, PartialEq)]
pub struct Quadrotor {
    /// Present state.
    pub state: QuadrotorState,
    /// Parameters.
    pub parameters: QuadrotorParameters,
}

impl Quadrotor {
    /// At rest at a place, level, with rotors at the speed of hover.
    pub fn hovering(position_m: DVec3, parameters: QuadrotorParameters) -> Self {
        let rotors_rpm = [parameters.hover_rpm(); 4];
        let (velocity_mps, rates_rad_s, attitude) = (DVec3::ZERO, DVec3::ZERO, DQuat::IDENTITY);
        Self { state: QuadrotorState { position_m, attitude, velocity_mps, rates_rad_s, rotors_rpm }, parameters }
    }

    /// Moves on by `step_s` seconds (Runge and Kutta's method of fourth order) with rotors told to turn at `command_rpm`, in air
    /// that moves at `wind_mps` (inertial frame).
    pub fn step(&mut self, command_rpm: [f64; 4], wind_mps: DVec3, step_s: f64) {
        let (low, high) = self.parameters.speed_rpm;
        let command = command_rpm.map(|rpm| if rpm.is_finite() { rpm.clamp(low, high) } else { low });
        let first = self.slope(&self.state, command, wind_mps);
        let second = self.slope(&self.state.moved(&first, 0.5 * step_s), command, wind_mps);
        let third = self.slope(&self.state.moved(&second, 0.5 * step_s), command, wind_mps);
        let fourth = self.slope(&self.state.moved(&third, step_s), command, wind_mps);
        let mean = Slope::mean(&first, &second, &third, &fourth);
        let mut state = self.state.moved(&mean, step_s);
        state.attitude = state.attitude.normalize();
        self.state = state;
    }

    /// Rates of change in a state.
    pub fn derivative(&self, state: &QuadrotorState, command_rpm: [f64; 4], wind_mps: DVec3) -> Derivative {
        let parameters = &self.parameters;
        let [rise, rise_square, fall, fall_square] = parameters.spin;
        let rotors_rpm_s: [f64; 4] = core::array::from_fn(|rotor| {
            let (command, speed) = (command_rpm[rotor], state.rotors_rpm[rotor]);
            let (linear, square) = if command > speed { (rise, rise_square) } else { (fall, fall_square) };
            linear * (command - speed) + square * (command * command - speed * speed)
        });
        let thrusts = state.rotors_rpm.map(|rpm| parameters.thrust_n(rpm));
        let torques = state.rotors_rpm.map(|rpm| parameters.torque_nm(rpm));
        let world_from_body = DMat3::from_quat(state.attitude.normalize());
        let [roll, pitch, yaw] = &parameters.mixing;
        let sum = |signs: &[f64; 4], values: &[f64; 4]| signs.iter().zip(values).map(|(a, b)| a * b).sum::<f64>();
        let air_mps = world_from_body.transpose() * (state.velocity_mps - wind_mps);
        let lift = world_from_body * DVec3::new(0.0, 0.0, thrusts.iter().sum());
        let drag = world_from_body * (parameters.drag * air_mps);
        let rates = state.rates_rad_s;
        let momentum = parameters.rotor_inertia_kgm2 * RPM * sum(yaw, &state.rotors_rpm);
        let spun_up = parameters.rotor_inertia_kgm2 * RPM * sum(yaw, &rotors_rpm_s);
        let of_rotors = match parameters.gyroscope {
            Gyroscope::Exact => DVec3::new(rates.y * momentum, -rates.x * momentum, spun_up),
            Gyroscope::OfDroneModels => DVec3::new(-rates.y * momentum, -rates.x * momentum, spun_up),
        };
        let of_thrust = DVec3::new(
            parameters.arm_m * sum(roll, &thrusts),
            parameters.arm_m * sum(pitch, &thrusts),
            sum(yaw, &torques),
        );
        let inertia = parameters.inertia_kgm2;
        Derivative {
            acceleration_mps2: (lift + drag) / parameters.mass_kg - GRAVITY_MPS2 * DVec3::Z,
            rates_rad_s2: (of_thrust + of_rotors - rates.cross(inertia * rates)) / inertia,
            rotors_rpm_s,
        }
    }

    fn slope(&self, state: &QuadrotorState, command_rpm: [f64; 4], wind_mps: DVec3) -> Slope {
        let turn = DQuat::from_xyzw(state.rates_rad_s.x, state.rates_rad_s.y, state.rates_rad_s.z, 0.0);
        Slope {
            velocity_mps: state.velocity_mps,
            attitude: (state.attitude * turn) * 0.5,
            rest: self.derivative(state, command_rpm, wind_mps),
        }
    }
}

/// Rates of change of a whole state.
struct Slope {
    velocity_mps: DVec3,
    attitude: DQuat,
    rest: Derivative,
}

impl Slope {
    /// Weighted mean of Runge and Kutta.
    fn mean(a: &Self, b: &Self, c: &Self, d: &Self) -> Self {
        let vector = |of: fn(&Self) -> DVec3| (of(a) + 2.0 * of(b) + 2.0 * of(c) + of(d)) / 6.0;
        Self {
            velocity_mps: vector(|it| it.velocity_mps),
            attitude: (a.attitude + b.attitude * 2.0 + c.attitude * 2.0 + d.attitude) * (1.0 / 6.0),
            rest: Derivative {
                acceleration_mps2: vector(|it| it.rest.acceleration_mps2),
                rates_rad_s2: vector(|it| it.rest.rates_rad_s2),
                rotors_rpm_s: core::array::from_fn(|rotor| {
                    let of = |it: &Self| it.rest.rotors_rpm_s[rotor];
                    (of(a) + 2.0 * of(b) + 2.0 * of(c) + of(d)) / 6.0
                }),
            },
        }
    }
}

impl QuadrotorState {
    fn moved(&self, slope: &Slope, time_s: f64) -> Self {
        Self {
            position_m: self.position_m + time_s * slope.velocity_mps,
            attitude: self.attitude + slope.attitude * time_s,
            velocity_mps: self.velocity_mps + time_s * slope.rest.acceleration_mps2,
            rates_rad_s: self.rates_rad_s + time_s * slope.rest.rates_rad_s2,
            rotors_rpm: core::array::from_fn(|rotor| self.rotors_rpm[rotor] + time_s * slope.rest.rotors_rpm_s[rotor]),
        }
    }
}
