//! Seeded random streams: one per (recipe seed, stage, item), the same on every machine and thread count.

use crate::real::{TAU, cos, ln};
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};

/// The seed of one item of one stage; derive streams for separate purposes from it by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Seed(pub [u8; 32]);

impl Seed {
    /// The seed of item `item` of stage `stage` in a recipe with seed `recipe_seed`.
    pub fn of_item(recipe_seed: u64, stage: &str, item: &str) -> Self {
        let mut hasher = blake3::Hasher::new_derive_key("cosfly seed 1");
        hasher.update(&recipe_seed.to_le_bytes());
        for part in [stage, item] {
            hasher.update(&(part.len() as u64).to_le_bytes());
            hasher.update(part.as_bytes());
        }
        Self(*hasher.finalize().as_bytes())
    }

    /// A seed for something inside the item (an attempt, an object, a frame).
    pub fn child(&self, purpose: &str, index: u64) -> Self {
        let mut hasher = blake3::Hasher::new_keyed(&self.0);
        hasher.update(&index.to_le_bytes());
        hasher.update(purpose.as_bytes());
        Self(*hasher.finalize().as_bytes())
    }

    /// The random stream for `purpose`. Two purposes never share numbers, so adding a draw to one
    /// does not shift the other.
    pub fn stream(&self, purpose: &str) -> RandomStream {
        RandomStream { generator: ChaCha8Rng::from_seed(self.child(purpose, 0).0) }
    }

    /// The first eight bytes as a number, for readers that want an integer seed.
    pub fn as_u64(&self) -> u64 {
        u64::from_le_bytes(self.0[..8].try_into().expect("a seed has 32 bytes"))
    }
}

/// A stream of random numbers (ChaCha8).
#[derive(Clone, Debug)]
pub struct RandomStream {
    generator: ChaCha8Rng,
}

impl RandomStream {
    /// A uniform integer over all of `u64`.
    pub fn bits(&mut self) -> u64 {
        self.generator.next_u64()
    }

    /// Uniform in [0, 1), 53 bits.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Uniform in [`low`, `high`).
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform in 0..`bound`; 0 when `bound` is 0.
    pub fn index(&mut self, bound: usize) -> usize {
        ((u128::from(self.bits()) * bound as u128) >> 64) as usize
    }

    /// True with the given probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// Normal with the given mean and standard deviation (Box-Muller).
    pub fn normal(&mut self, mean: f64, deviation: f64) -> f64 {
        let radius = (-2.0 * ln(1.0 - self.unit())).sqrt();
        mean + deviation * radius * cos(TAU * self.unit())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_depend_on_every_part_of_their_name() {
        let base = Seed::of_item(1, "walkers", "p0").stream("route").bits();
        assert_eq!(base, Seed::of_item(1, "walkers", "p0").stream("route").bits());
        for other in [
            Seed::of_item(2, "walkers", "p0").stream("route"),
            Seed::of_item(1, "walkersp", "0").stream("route"),
            Seed::of_item(1, "walkers", "p1").stream("route"),
            Seed::of_item(1, "walkers", "p0").stream("speed"),
        ] {
            assert_ne!(base, other.clone().bits());
        }
    }

    #[test]
    fn a_normal_stream_has_the_asked_moments() {
        let mut stream = Seed::of_item(7, "s", "i").stream("n");
        let draws: Vec<f64> = (0..20_000).map(|_| stream.normal(1.34, 0.26)).collect();
        let mean = draws.iter().sum::<f64>() / draws.len() as f64;
        let variance = draws.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / draws.len() as f64;
        assert!((mean - 1.34).abs() < 0.01 && (variance.sqrt() - 0.26).abs() < 0.01);
    }
}
