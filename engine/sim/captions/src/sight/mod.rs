//! What one picture shows of the target: its way across the picture, its place, the people around it; and instructions
//! that single it out by that.

pub mod check;
mod chinese;
mod english;
pub mod facts;
mod reading;
mod wording;

pub use check::check_sight;
pub use facts::{Across, Near, Part, Person, Place, Seen, Side, Sight, View, sight};
pub use wording::instruction;
