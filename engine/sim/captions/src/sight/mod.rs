//! Facts that one picture shows of the target: its way across the picture, its place, people and landmarks around it; and instructions
//! that single it out by that.

mod beside;
mod crossings;
pub mod facts;
pub mod landmarks;
mod relation;
#[cfg(test)]
mod test_views;
mod view;
mod wording;

pub use beside::{Beside, NearLandmark, OnSide};
pub use crossings::Crossing;
pub use facts::{Across, Near, PlaceAmong, SeenTarget, Side, Sight, sight};
pub use landmarks::{LandmarkKind, Landmarks};
pub use view::{SeenPerson, WindowView};
pub use wording::{instruction, phrase_instruction};
