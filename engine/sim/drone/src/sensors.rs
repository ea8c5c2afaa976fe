//! Sensors: inertial unit, barometer, satellite receiver; each with its noise and its slowly changing error.

use cosfly_frames::{DMat3, DQuat, DVec3, RandomStream, Seed, real};

/// Acceleration of free fall, m/s^2.
const GRAVITY_MPS2: f64 = 9.81;

/// Noise of one kind of an inertial unit's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertialNoise {
    /// Density of the white noise, unit per root hertz.
    pub density: f64,
    /// Density of the random walk of the bias, unit per second and root hertz.
    pub walk: f64,
    /// Standard deviation of the bias at the beginning, unit.
    pub first_bias: f64,
}

/// Parameters of an inertial unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertialParameters {
    /// Samples per second, 200 to 1000.
    pub rate_hz: f64,
    /// Noise of the rates of turning, rad/s.
    pub gyroscope: InertialNoise,
    /// Noise of the specific force, m/s^2.
    pub accelerometer: InertialNoise,
}

impl InertialParameters {
    /// The unit ADIS16448 as the EuRoC data set states it (200 Hz).
    pub fn adis16448() -> Self {
        Self {
            rate_hz: 200.0,
            gyroscope: InertialNoise { density: 1.6968e-4, walk: 1.9393e-5, first_bias: 2e-3 },
            accelerometer: InertialNoise { density: 2.0e-3, walk: 3.0e-3, first_bias: 2e-2 },
        }
    }

    /// A unit without errors.
    pub fn exact(rate_hz: f64) -> Self {
        let none = InertialNoise { density: 0.0, walk: 0.0, first_bias: 0.0 };
        Self { rate_hz, gyroscope: none, accelerometer: none }
    }
}

/// Sample of an inertial unit, along the body's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertialSample {
    /// Rates of turning, rad/s.
    pub rates_rad_s: DVec3,
    /// Specific force (acceleration without gravity's), m/s^2.
    pub force_mps2: DVec3,
}

/// Attitude and velocity at a moment; right-handed, as in [`crate::quadrotor`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carried {
    /// Turns vectors of the body into the inertial frame.
    pub attitude: DQuat,
    /// Velocity, inertial frame, m/s.
    pub velocity_mps: DVec3,
}

/// An inertial unit. A sample without errors is the mean turn and the mean force since the moment before it: turns and
/// velocities come back exactly when samples are added up in order.
#[derive(Clone, Debug)]
pub struct InertialUnit {
    parameters: InertialParameters,
    biases: [DVec3; 2],
    stream: RandomStream,
}

impl InertialUnit {
    /// A unit with biases drawn from a seed.
    pub fn new(parameters: InertialParameters, seed: Seed) -> Self {
        let mut stream = seed.stream("inertial unit");
        let noises = [parameters.gyroscope, parameters.accelerometer];
        let biases = noises.map(|noise| normal(&mut stream, noise.first_bias));
        Self { parameters, biases, stream }
    }

    /// Time between samples, seconds.
    pub fn step_s(&self) -> f64 {
        1.0 / self.parameters.rate_hz
    }

    /// The sample between two moments, [`Self::step_s`] apart.
    pub fn sample(&mut self, before: &Carried, after: &Carried) -> InertialSample {
        let step_s = self.step_s();
        let turn = before.attitude.conjugate() * after.attitude;
        let rates = rotation_vector(turn) / step_s;
        let felt = (after.velocity_mps - before.velocity_mps) / step_s + GRAVITY_MPS2 * DVec3::Z;
        let force = DMat3::from_quat(before.attitude).transpose() * felt;
        let noises = [self.parameters.gyroscope, self.parameters.accelerometer];
        let root_hz = self.parameters.rate_hz.sqrt();
        let [rates_rad_s, force_mps2] = [0, 1].map(|kind| {
            let exact = if kind == 0 { rates } else { force };
            let measured = exact + self.biases[kind] + normal(&mut self.stream, noises[kind].density * root_hz);
            self.biases[kind] += normal(&mut self.stream, noises[kind].walk / root_hz);
            measured
        });
        InertialSample { rates_rad_s, force_mps2 }
    }
}

/// Adds a sample of `step_s` seconds to what is carried.
pub fn dead_reckoned(before: &Carried, sample: &InertialSample, step_s: f64) -> Carried {
    let force = DMat3::from_quat(before.attitude) * sample.force_mps2;
    let turn = step_s * sample.rates_rad_s;
    let (sin, cos) = real::sin_cos(0.5 * turn.length());
    let axis = turn.normalize_or_zero() * sin;
    Carried {
        attitude: (before.attitude * DQuat::from_xyzw(axis.x, axis.y, axis.z, cos)).normalize(),
        velocity_mps: before.velocity_mps + step_s * (force - GRAVITY_MPS2 * DVec3::Z),
    }
}

fn rotation_vector(turn: DQuat) -> DVec3 {
    let sign = if turn.w < 0.0 { -1.0 } else { 1.0 };
    let axis = sign * DVec3::new(turn.x, turn.y, turn.z);
    let size = axis.length();
    if size < 1e-12 { 2.0 * axis } else { axis * (2.0 * real::atan2(size, sign * turn.w) / size) }
}

fn normal(stream: &mut RandomStream, deviation: f64) -> DVec3 {
    DVec3::from_array(core::array::from_fn(|_| stream.normal(0.0, deviation)))
}

/// A value with white noise and an error that wanders and returns (Gauss-Markov process), per axis.
#[derive(Clone, Debug)]
struct Wandering {
    error: DVec3,
    kept: f64,
    fresh: DVec3,
    noise: DVec3,
    stream: RandomStream,
}

impl Wandering {
    fn new(noise: DVec3, drift: DVec3, drift_s: f64, step_s: f64, mut stream: RandomStream) -> Self {
        let kept = real::exp(-step_s / drift_s);
        let error = drift * normal(&mut stream, 1.0);
        Self { error, kept, fresh: drift * (1.0 - kept * kept).sqrt(), noise, stream }
    }

    fn next(&mut self, exact: DVec3) -> DVec3 {
        self.error = self.kept * self.error + self.fresh * normal(&mut self.stream, 1.0);
        exact + self.error + self.noise * normal(&mut self.stream, 1.0)
    }
}

/// A barometer that gives heights: white noise of 0.1 m and a drift of 0.5 m with a time constant of 300 s.
#[derive(Clone, Debug)]
pub struct Barometer(Wandering);

impl Barometer {
    /// A barometer with a sample every `step_s` seconds.
    pub fn new(step_s: f64, seed: Seed) -> Self {
        let stream = seed.stream("barometer");
        Self(Wandering::new(DVec3::new(0.0, 0.0, 0.1), DVec3::new(0.0, 0.0, 0.5), 300.0, step_s, stream))
    }

    /// The height that is measured at a height, metres.
    pub fn sample_m(&mut self, height_m: f64) -> f64 {
        self.0.next(height_m * DVec3::Z).z
    }
}

/// A satellite receiver: positions with white noise of 0.2 m (0.4 m in height) and a wandering error of 1 m (1.5 m) with a time
/// constant of 100 s; velocities with white noise of 0.05 m/s.
#[derive(Clone, Debug)]
pub struct Receiver {
    position: Wandering,
    velocity: Wandering,
}

impl Receiver {
    /// A receiver with a sample every `step_s` seconds.
    pub fn new(step_s: f64, seed: Seed) -> Self {
        let (noise, drift) = (DVec3::new(0.2, 0.2, 0.4), DVec3::new(1.0, 1.0, 1.5));
        let position = Wandering::new(noise, drift, 100.0, step_s, seed.stream("receiver"));
        let velocity = Wandering::new(DVec3::splat(0.05), DVec3::ZERO, 1.0, step_s, seed.stream("receiver velocity"));
        Self { position, velocity }
    }

    /// Position (metres) and velocity (m/s) that are measured.
    pub fn sample(&mut self, position_m: DVec3, velocity_mps: DVec3) -> (DVec3, DVec3) {
        (self.position.next(position_m), self.velocity.next(velocity_mps))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::quadrotor;
    use crate::quadrotor::Quadrotor;

    #[test]
    fn samples_without_errors_add_up_to_the_flight() {
        let mut drone = Quadrotor::hovering(DVec3::ZERO, quadrotor("pelican").unwrap());
        let hover = drone.parameters.hover_rpm();
        let mut unit = InertialUnit::new(InertialParameters::exact(500.0), Seed([1; 32]));
        let carried =
            |drone: &Quadrotor| Carried { attitude: drone.state.attitude, velocity_mps: drone.state.velocity_mps };
        let (mut reckoned, mut place) = (carried(&drone), drone.state.position_m);
        for step in 0..1000 {
            let tilt = 0.02 * hover * real::sin(0.01 * f64::from(step));
            let before = carried(&drone);
            drone.step([hover + tilt, hover, hover - tilt, hover + 0.5 * tilt], DVec3::ZERO, unit.step_s());
            let sample = unit.sample(&before, &carried(&drone));
            let next = dead_reckoned(&reckoned, &sample, unit.step_s());
            place += 0.5 * unit.step_s() * (reckoned.velocity_mps + next.velocity_mps);
            reckoned = next;
        }
        assert!((reckoned.velocity_mps - drone.state.velocity_mps).length() < 1e-9);
        assert!(1.0 - reckoned.attitude.dot(drone.state.attitude).abs() < 1e-12);
        let length_m = drone.state.position_m.length();
        assert!(length_m > 1.0 && (place - drone.state.position_m).length() < 1e-4 * length_m);
    }

    #[test]
    fn errors_have_the_deviations_that_are_stated() {
        let (mut barometer, mut receiver) = (Barometer::new(0.1, Seed([2; 32])), Receiver::new(0.1, Seed([2; 32])));
        let (mut square, mut square_of_velocity, count) = (0.0, 0.0, 400_000);
        for _ in 0..count {
            square += (barometer.sample_m(50.0) - 50.0) * (barometer.sample_m(50.0) - 50.0);
            let (_, velocity) = receiver.sample(DVec3::ONE, DVec3::ZERO);
            square_of_velocity += velocity.x * velocity.x;
        }
        // Two samples in a row share the drift alone.
        assert!(((square / f64::from(count)).sqrt() - 0.5).abs() < 0.1);
        assert!(((square_of_velocity / f64::from(count)).sqrt() - 0.05).abs() < 0.001);
    }
}
