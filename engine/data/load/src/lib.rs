//! Random access to frames for training, whatever the layout: datasets of cosfly, the published v7 layout, LeRobot's.
//!
//! * [`FlightSource`]: the seam; one file per layout implements it.
//! * [`open`]: the source in a folder.
//! * `tables`: tables of foreign layouts, with the names and columns that cosfly's own tables have.

mod foreign;
mod lerobot;
mod open;
mod ours;
mod source;
mod tables;
mod tasks;
#[cfg(test)]
mod tests;
mod v7;

pub use open::open;
pub use source::{FlightSource, LoadedFlight};
