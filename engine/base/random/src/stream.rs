//! Streams of random numbers, the same on every machine.

use core::f64::consts::TAU;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// A stream of random numbers (ChaCha8).
#[derive(Clone, Debug)]
pub struct RandomStream {
    generator: ChaCha8Rng,
}

impl RandomStream {
    pub(crate) fn from_bytes(seed: [u8; 32]) -> Self {
        Self { generator: ChaCha8Rng::from_seed(seed) }
    }

    /// Uniform integer over all of `u64`.
    pub fn bits(&mut self) -> u64 {
        self.generator.next_u64()
    }

    /// Uniform number in [0, 1), 53 bits.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Uniform number in [`low`, `high`).
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform integer in 0..`bound`; 0 when `bound` is 0.
    pub fn index(&mut self, bound: usize) -> usize {
        ((u128::from(self.bits()) * bound as u128) >> 64) as usize
    }

    /// True with the given probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// Normally distributed number with the given mean and standard deviation (Box-Muller).
    pub fn normal(&mut self, mean: f64, deviation: f64) -> f64 {
        let radius = (-2.0 * libm::log(1.0 - self.unit())).sqrt();
        mean + deviation * radius * libm::cos(TAU * self.unit())
    }
}

#[cfg(test)]
mod tests {
    use crate::seed::Seed;

    #[test]
    fn a_normal_stream_has_the_asked_moments() {
        let mut stream = Seed::of_item(7, "s", "i").stream("n");
        let draws: Vec<f64> = (0..20_000).map(|_| stream.normal(1.34, 0.26)).collect();
        let mean = draws.iter().sum::<f64>() / draws.len() as f64;
        let variance = draws.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / draws.len() as f64;
        assert!((mean - 1.34).abs() < 0.01 && (variance.sqrt() - 0.26).abs() < 0.01);
    }
}
