//! Clothes that were drawn before: many pictures show the same people.

use crate::clothes::Clothes;
use cosfly_frames::Seed;

/// Clothes of people by their seeds, so that nobody's are drawn again in every picture. Forgets rather than grows.
pub struct Wardrobe {
    shelves: Vec<Option<(Seed, Clothes)>>,
}

impl Default for Wardrobe {
    fn default() -> Self {
        Self { shelves: vec![None; 256] }
    }
}

impl Wardrobe {
    /// What [`Clothes::draw`] gives.
    pub fn clothes(&mut self, seed: &Seed) -> Clothes {
        let shelf = &mut self.shelves[usize::from(seed.0[0])];
        match shelf {
            Some((known, clothes)) if known == seed => *clothes,
            _ => shelf.insert((*seed, Clothes::draw(seed))).1,
        }
    }
}
