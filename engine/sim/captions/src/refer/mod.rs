//! Referring phrases: a few properties of the target that nobody else in a picture has.

mod phrase;
mod words;

pub use phrase::{Candidate, Phrase, Property};
pub use words::{noun, text};
