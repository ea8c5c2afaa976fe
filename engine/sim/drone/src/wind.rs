//! Wind: a mean, and gusts with Dryden's spectra.

use cosfly_frames::{DVec3, RandomStream, Seed, real};

/// Metres in a foot.
const FOOT_M: f64 = 0.3048;
/// Heights for which the formulas near the ground hold, feet.
const NEAR_GROUND_FT: (f64, f64) = (10.0, 1000.0);

/// Size and length of gusts along the wind, across it and upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turbulence {
    /// Standard deviations, m/s.
    pub deviation_mps: DVec3,
    /// Lengths, metres.
    pub length_m: DVec3,
}

impl Turbulence {
    /// Turbulence near the ground (MIL-F-8785C, 3 to 305 m) at a height and for a mean wind 6 m above ground.
    pub fn near_ground(height_m: f64, wind_at_6_m_mps: f64) -> Self {
        let height_ft = (height_m / FOOT_M).clamp(NEAR_GROUND_FT.0, NEAR_GROUND_FT.1);
        let share = 0.177 + 0.000_823 * height_ft;
        let upwards = 0.1 * wind_at_6_m_mps;
        let level = upwards / real::powf(share, 0.4);
        let length_m = height_ft / real::powf(share, 1.2) * FOOT_M;
        Self {
            deviation_mps: DVec3::new(level, level, upwards),
            length_m: DVec3::new(length_m, length_m, height_ft * FOOT_M),
        }
    }
}

/// Slowest speed at which gusts are met, m/s.
const SLOWEST_MPS: f64 = 2.0;

/// The air around a drone: a mean wind, and gusts that it carries along.
#[derive(Clone, Debug)]
pub struct Air {
    mean_in_world: DVec3,
    along: DVec3,
    gusts: Option<Gusts>,
}

impl Air {
    /// Air that does not move.
    pub fn still() -> Self {
        Self { mean_in_world: DVec3::ZERO, along: DVec3::X, gusts: None }
    }

    /// A mean wind (world frame, m/s) with gusts, a sample every [`crate::quadrotor::TICK_S`].
    pub fn new(mean_in_world: DVec3, turbulence: Option<Turbulence>, seed: Seed) -> Self {
        let met_at_mps = mean_in_world.length().max(SLOWEST_MPS);
        let gusts = turbulence.map(|it| Gusts::new(&it, met_at_mps, crate::quadrotor::TICK_S, seed));
        Self { mean_in_world, along: mean_in_world.with_z(0.0).normalize_or(DVec3::X), gusts }
    }

    /// Velocity of the air in the next tick, world frame, m/s.
    pub fn next_in_world(&mut self) -> DVec3 {
        let gust = self.gusts.as_mut().map_or(DVec3::ZERO, Gusts::next_mps);
        let across = DVec3::new(-self.along.y, self.along.x, 0.0);
        self.mean_in_world + gust.x * self.along + gust.y * across + gust.z * DVec3::Z
    }
}

/// Gusts at equal steps, for a drone that meets frozen turbulence at a constant speed. Each sample is drawn from the exact
/// distribution of Dryden's process after the one before, so spectra do not depend on the step (up to its Nyquist frequency).
#[derive(Clone, Debug)]
pub struct Gusts {
    along: Process,
    across: Process,
    upwards: Process,
    stream: RandomStream,
}

impl Gusts {
    /// Gusts every `step_s` seconds, met at `speed_mps` (above 0); they begin in their stationary state.
    pub fn new(turbulence: &Turbulence, speed_mps: f64, step_s: f64, seed: Seed) -> Self {
        let mut stream = seed.stream("gusts");
        let [along, across, upwards] = [0, 1, 2].map(|axis| {
            let time_s = turbulence.length_m[axis] / speed_mps;
            Process::new(axis > 0, turbulence.deviation_mps[axis], step_s / time_s, &mut stream)
        });
        Self { along, across, upwards, stream }
    }

    /// The next gust: along the wind, across it, upwards, m/s.
    pub fn next_mps(&mut self) -> DVec3 {
        let Self { along, across, upwards, stream } = self;
        DVec3::new(along.next(stream), across.next(stream), upwards.next(stream))
    }
}

/// Dryden's process in units of its time constant: white noise through `1/(1+s)` (along) or `(1+sqrt(3) s)/(1+s)^2` (across).
#[derive(Clone, Debug)]
struct Process {
    is_second_order: bool,
    deviation: f64,
    kept: f64,
    step: f64,
    /// Lower triangle of the root of the covariance of a step's noise.
    root: [f64; 3],
    /// Noise through one and through two filters, of deviation 1.
    state: [f64; 2],
}

impl Process {
    fn new(is_second_order: bool, deviation: f64, step: f64, stream: &mut RandomStream) -> Self {
        let (kept, square) = (real::exp(-step), real::exp(-2.0 * step));
        // For noise of intensity 1; stationary: 1/2, 1/4, 1/4.
        let first = 0.5 * (1.0 - square);
        let both = 0.25 * (1.0 - square * (1.0 + 2.0 * step));
        let second = 0.25 * (1.0 - square * (1.0 + 2.0 * step + 2.0 * step * step));
        let (root, begin) = (root_of(first, both, second), root_of(0.5, 0.25, 0.25));
        let state = drawn(&begin, stream);
        Self { is_second_order, deviation, kept, step, root, state }
    }

    fn next(&mut self, stream: &mut RandomStream) -> f64 {
        let [first, second] = self.state;
        let noise = drawn(&self.root, stream);
        self.state = [self.kept * first + noise[0], self.kept * (second + self.step * first) + noise[1]];
        let [first, second] = self.state;
        let root = 3.0_f64.sqrt();
        self.deviation
            * if self.is_second_order { root * first + (1.0 - root) * second } else { 2.0_f64.sqrt() * first }
    }
}

fn root_of(first: f64, both: f64, second: f64) -> [f64; 3] {
    let a = first.max(0.0).sqrt();
    let b = if a > 0.0 { both / a } else { 0.0 };
    [a, b, (second - b * b).max(0.0).sqrt()]
}

fn drawn([a, b, c]: &[f64; 3], stream: &mut RandomStream) -> [f64; 2] {
    let (x, y) = (stream.normal(0.0, 1.0), stream.normal(0.0, 1.0));
    [a * x, b * x + c * y]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gusts_have_the_asked_deviations_for_any_step() {
        let turbulence = Turbulence { deviation_mps: DVec3::new(1.0, 2.0, 0.5), length_m: DVec3::new(10.0, 10.0, 5.0) };
        for step_s in [0.02, 0.5] {
            let mut gusts = Gusts::new(&turbulence, 10.0, step_s, Seed([4; 32]));
            let count = (8000.0 / step_s) as usize;
            let mut square = DVec3::ZERO;
            (0..count).for_each(|_| {
                let gust = gusts.next_mps();
                square += gust * gust;
            });
            let deviation = (square / count as f64).map(f64::sqrt);
            let relative = deviation / turbulence.deviation_mps - DVec3::ONE;
            assert!(relative.abs().max_element() < 0.05, "{step_s} {relative}");
        }
    }

    #[test]
    fn turbulence_near_the_ground_is_that_of_the_standard() {
        // At 20 ft a wind of 20 knots gives an intensity of 2 knots upwards and a length of 20 ft.
        let found = Turbulence::near_ground(6.096, 10.0);
        assert!((found.deviation_mps.z - 1.0).abs() < 1e-12 && (found.length_m.z - 6.096).abs() < 1e-12);
        let share: f64 = 0.177 + 0.000_823 * 20.0;
        assert!((found.length_m.x - 20.0 / real::powf(share, 1.2) * 0.3048).abs() < 1e-9);
        assert!(found.deviation_mps.x > found.deviation_mps.z);
    }
}
