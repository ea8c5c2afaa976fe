//! Seeds: one per (recipe seed, stage, item), and the seeds and streams derived from it by name.

use crate::stream::RandomStream;
use serde::{Deserialize, Serialize};

/// Seed of one item of one stage. Streams for separate purposes are derived from it by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Seed(pub [u8; 32]);

impl Seed {
    /// Seed of item `item` of stage `stage` in a recipe with seed `recipe_seed`.
    pub fn of_item(recipe_seed: u64, stage: &str, item: &str) -> Self {
        let mut hasher = blake3::Hasher::new_derive_key("cosfly seed 1");
        hasher.update(&recipe_seed.to_le_bytes());
        for part in [stage, item] {
            hasher.update(&(part.len() as u64).to_le_bytes());
            hasher.update(part.as_bytes());
        }
        Self(*hasher.finalize().as_bytes())
    }

    /// Seed of a part of the item (an attempt, an object, a frame).
    pub fn child(&self, purpose: &str, index: u64) -> Self {
        let mut hasher = blake3::Hasher::new_keyed(&self.0);
        hasher.update(&index.to_le_bytes());
        hasher.update(purpose.as_bytes());
        Self(*hasher.finalize().as_bytes())
    }

    /// Random stream for `purpose`. Streams of different purposes are independent, so adding a draw to one does not
    /// shift the other.
    pub fn stream(&self, purpose: &str) -> RandomStream {
        RandomStream::from_bytes(self.child(purpose, 0).0)
    }

    /// First eight bytes as a little-endian number, for users that need an integer seed.
    pub fn as_u64(&self) -> u64 {
        u64::from_le_bytes(self.0[..8].try_into().expect("a seed has 32 bytes"))
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
}
