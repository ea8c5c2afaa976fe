//! Clothes that were drawn before: many pictures show the same people.

use crate::Clothes;
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
    /// Clothes as [`Clothes::draw`] gives them.
    pub fn clothes(&mut self, seed: &Seed) -> &Clothes {
        let shelf = &mut self.shelves[usize::from(seed.0[0])];
        if shelf.as_ref().is_none_or(|(known, _)| known != seed) {
            *shelf = None;
        }
        &shelf.get_or_insert_with(|| (*seed, Clothes::draw(seed))).1
    }
}
