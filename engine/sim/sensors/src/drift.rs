//! [`Drift`]: an error that wanders and returns, a function of time alone.

use cosfly_frames::{Seed, real};

/// Halvings of a stretch of [`STRETCH`] time constants, between whose ends errors are independent: knots are 1/128 of it apart.
const HALVINGS: u32 = 12;

/// Length of a stretch in time constants.
const STRETCH: f64 = 32.0;

/// A Gauss-Markov process of first order: its deviation, and the time in which it forgets.
///
/// Its value at a time does not depend on which other times are asked for, in what order or how often: the two ends of the stretch of
/// the time are drawn, then the middle given both ends, and so on down to knots that are a 128th of the time constant apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// Standard deviation, in the unit of the quantity.
    pub deviation: f64,
    /// Time constant, seconds.
    pub time_constant_s: f64,
}

impl Drift {
    /// Errors of `N` axes, four at most, at a time, seconds from 0; the seed and the purpose name the process.
    pub fn at<const N: usize>(&self, seed: &Seed, purpose: &str, time_s: f64) -> [f64; N] {
        let knots_s = STRETCH * self.time_constant_s / f64::from(1 << HALVINGS);
        let place = time_s.max(0.0) / knots_s;
        let knot = place as u64;
        let drawn = |number: u64| -> [f64; N] {
            let normals = normals(&seed.child(purpose, number));
            core::array::from_fn(|axis| self.deviation * normals[axis])
        };
        let mut low = knot >> HALVINGS << HALVINGS;
        let (mut before, mut after) = (drawn(low), drawn(low + (1 << HALVINGS)));
        for halving in (0..HALVINGS).rev() {
            let middle = low + (1 << halving);
            let kept = real::exp(-STRETCH * f64::from(1 << halving) / f64::from(1 << HALVINGS));
            let square = kept * kept;
            let (pull, fresh) = (kept / (1.0 + square), ((1.0 - square) / (1.0 + square)).sqrt());
            let noise = drawn(middle);
            let value = core::array::from_fn(|axis| pull * (before[axis] + after[axis]) + fresh * noise[axis]);
            if knot >= middle {
                (low, before) = (middle, value);
            } else {
                after = value;
            }
        }
        let share = place - low as f64;
        core::array::from_fn(|axis| before[axis] + share * (after[axis] - before[axis]))
    }
}

/// Four normally distributed numbers of a seed (Box and Muller).
fn normals(seed: &Seed) -> [f64; 4] {
    let unit = |number: usize| {
        let bytes: [u8; 8] = core::array::from_fn(|byte| seed.0[8 * number + byte]);
        (u64::from_le_bytes(bytes) >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    };
    let pair = |number: usize| {
        let radius = (-2.0 * real::ln(1.0 - unit(number))).sqrt();
        let (sin, cos) = real::sin_cos(real::TAU * unit(number + 1));
        [radius * cos, radius * sin]
    };
    let ([a, b], [c, d]) = (pair(0), pair(2));
    [a, b, c, d]
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRIFT: Drift = Drift { deviation: 2.0, time_constant_s: 10.0 };

    #[test]
    fn deviation_and_memory_are_those_that_are_stated() {
        let (seed, count) = (Seed([8; 32]), 20_000);
        let values: Vec<[f64; 3]> =
            (0..count).map(|step| DRIFT.at(&seed, "bias", 5.0 * f64::from(step) + 0.3)).collect();
        let mean = |lag: usize| {
            let pairs = values.iter().zip(&values[lag..]);
            pairs.flat_map(|(a, b)| core::array::from_fn::<f64, 3, _>(|axis| a[axis] * b[axis])).sum::<f64>()
                / (3 * (values.len() - lag)) as f64
        };
        for (lag, expected) in
            [(0, 4.0), (1, 4.0 * real::exp(-0.5)), (2, 4.0 * real::exp(-1.0)), (12, 4.0 * real::exp(-6.0))]
        {
            assert!((mean(lag) - expected).abs() < 0.15, "{lag}: {} {expected}", mean(lag));
        }
    }

    #[test]
    fn values_are_continuous_and_independent_of_purpose() {
        let seed = Seed([8; 32]);
        let at = |time_s: f64| DRIFT.at::<1>(&seed, "bias", time_s)[0];
        for step in 1..5_000 {
            let time_s = 0.078_125 * f64::from(step);
            assert!((at(time_s + 1e-9) - at(time_s - 1e-9)).abs() < 1e-6, "{time_s}");
        }
        assert_ne!(at(7.0), DRIFT.at::<1>(&seed, "other", 7.0)[0]);
    }
}
