//! The instruction of a picture: whom to follow, by clothes, by the people around, by the way across the picture.

use super::facts::Sight;
use super::{chinese, english};
use cosfly_claims::Language;
use cosfly_random::Seed;

/// One sentence for the pilot that holds in this picture. The wording is the seed's.
pub fn instruction(sight: &Sight, language: Language, seed: Seed) -> String {
    let words = &mut seed.child(language.code(), 0).stream("words");
    match language {
        Language::Zh => chinese::instruction(sight, words),
        Language::En => english::instruction(sight, words),
    }
}
