//! The sections of the page, one file each.

pub mod distributions;
pub mod language;
pub mod maps;
pub mod numbers;
pub mod planners;
pub mod planning;
pub mod shares;
pub mod shortcuts;
pub mod timelines;
pub mod worst;
