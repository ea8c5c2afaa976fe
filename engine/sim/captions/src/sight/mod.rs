//! What one picture shows of the target: its way across the picture, its place, people and landmarks around it; and instructions
//! that single it out by that.

mod beside;
mod chinese;
mod crossings;
mod english;
pub mod facts;
pub mod landmarks;
mod wording;

pub use beside::{Beside, NearLandmark, OnSide};
pub use crossings::Crossing;
pub use facts::{Across, Near, Person, Place, Seen, Side, Sight, View, sight};
pub use landmarks::{LandmarkKind, Landmarks};
pub use wording::instruction;
