//! [`Sensing`]: the sensors of a quadrotor, sampled while it flies.

use crate::quadrotor::{QuadrotorState, TICK_S};
use crate::sensors::{Barometer, Carried, InertialParameters, InertialSample, InertialUnit, Receiver};
use cosfly_frames::{DVec3, Seed};

/// Ticks between samples of barometer and receiver: 10 Hz.
const SLOW_TICKS: u64 = 100;

/// A sample of all that is measured at a moment. Vectors are right-handed, as in [`crate::quadrotor`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensed {
    /// Time since the beginning, seconds.
    pub time_s: f64,
    /// Inertial unit, along the body's axes.
    pub inertial: InertialSample,
    /// Height by the barometer, metres.
    pub height_m: Option<f64>,
    /// Position (metres) and velocity (m/s) by the satellite receiver.
    pub fix: Option<(DVec3, DVec3)>,
}

/// The sensors of a quadrotor and what they measured: an inertial unit at 200 Hz, barometer and satellite receiver at 10 Hz.
#[derive(Clone, Debug)]
pub struct Sensing {
    unit: InertialUnit,
    barometer: Barometer,
    receiver: Receiver,
    ticks: u64,
    before: Option<Carried>,
    sensed: Vec<Sensed>,
}

impl Sensing {
    /// Sensors with errors drawn from a seed.
    pub fn new(seed: Seed) -> Self {
        let unit = InertialUnit::new(InertialParameters::adis16448(), seed);
        let ticks = (unit.step_s() / TICK_S).round() as u64;
        let slow_s = SLOW_TICKS as f64 * TICK_S;
        let (barometer, receiver) = (Barometer::new(slow_s, seed), Receiver::new(slow_s, seed));
        Self { unit, barometer, receiver, ticks, before: None, sensed: Vec::new() }
    }

    /// Everything measured so far, by time.
    pub fn sensed(&self) -> &[Sensed] {
        &self.sensed
    }

    /// Samples what is due after a number of ticks.
    pub(crate) fn tick(&mut self, ticks: u64, state: &QuadrotorState) {
        let carried = || Carried { attitude: state.attitude, velocity_mps: state.velocity_mps };
        let before = *self.before.get_or_insert_with(carried);
        if !ticks.is_multiple_of(self.ticks) {
            return;
        }
        let after = carried();
        let inertial = self.unit.sample(&before, &after);
        self.before = Some(after);
        let is_slow = ticks.is_multiple_of(SLOW_TICKS);
        let height_m = is_slow.then(|| self.barometer.sample_m(state.position_m.z));
        let fix = is_slow.then(|| self.receiver.sample(state.position_m, state.velocity_mps));
        self.sensed.push(Sensed { time_s: ticks as f64 * TICK_S, inertial, height_m, fix });
    }
}
