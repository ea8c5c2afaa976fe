//! Map files of any known format to a [`Town`], things to stand beside streets. Types of the town
//! come from the room `town` and are found here, too.

pub mod advice;
mod apart;
pub mod bounds;
pub mod combine;
pub mod config;
pub mod fill;
pub mod form;
pub mod formats;
pub mod options;
mod paving;
pub mod read;
mod recognise;
mod streets;

pub use bounds::PlanRectangle;
pub use config::MapConfig;
pub use formats::FORMATS;
pub use read::{read_town, read_town_of};
pub use recognise::recognise;
pub use streets::Streets;
