//! Goals of a flight in words at several grains: a sentence for the whole flight, a step for each stretch, a dialogue with a
//! correction, and a goal with one thing that is not so.
//!
//! [`Course`] reads off a flight what can be said of it, as typed [`Claim`]s; [`goals`] picks some of them and puts them into words.

mod around;
mod chinese;
mod chinese_frames;
mod claim;
mod compose;
mod course;
mod crossings;
mod english;
mod english_frames;
mod passing;
mod people;
mod pick;
mod plan;
mod steps;
#[cfg(test)]
mod tests;

pub use claim::{Claim, Hider, Subject};
pub use compose::goals;
pub use course::{Course, Flight, Hidden, Neighbour, Sample};
pub use plan::{Goal, Grain};
