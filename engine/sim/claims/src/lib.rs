//! Claims of Chinese and English texts about a flight: numbers with units, directions, turns, stops, clothes.
//!
//! [`read`] lists them; [`foreign_things`] names what no facts of a flight have. One reader serves both languages: files in
//! `words/` map words to concepts, and rules of nearness give a number its subject. Words outside of the files say nothing.
//! The templates of `cosfly-captions` are unknown here: a text that is read back proves them.

mod claim;
mod clothes;
mod compass;
mod language;
mod lexicon;
mod quantities;
mod read;
mod sentence;
mod token;
mod turn;
mod turns;

pub use claim::Claim;
pub use compass::Compass;
pub use language::{Language, Script};
pub use read::{foreign_things, read};
pub use turn::TurnKind;
