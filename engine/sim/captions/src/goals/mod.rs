//! Goals of a flight in words at several grains: a sentence for the whole flight, a step for each stretch, a dialogue with a
//! correction, and a goal with one thing that is not so.
//!
//! [`Course`] reads off a flight what can be said of it, as typed [`Claim`]s; [`goals`] picks some of them and puts them into words.

mod around;
mod claim;
mod compose;
mod course;
mod crossings;
mod passing;
mod people;
mod pick;
mod plan;
mod predicate;
mod steps;
#[cfg(test)]
mod tests;

pub use claim::{Claim, Hider, Subject};
pub(crate) use claim::{landmark_name, side_name};
pub use compose::goals;
pub use course::{Course, CourseData, Hidden, Neighbour, Sample};
pub use plan::{Goal, Grain};
