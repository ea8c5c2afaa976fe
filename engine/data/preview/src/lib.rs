//! Pictures of a published flight: a contact sheet, an animated clip and a plan, from its tables and its log alone.
//!
//! Bytes depend on the dataset alone, on every machine.

mod clip;
mod ground;
mod pictures;
mod plan;
mod selection;
mod sheet;
mod shot;
mod town;

pub use pictures::{FlightPictures, clip, draw};
pub use selection::FrameList;
pub use shot::ClipShot;
pub use town::{PlanShade, town_plan};
