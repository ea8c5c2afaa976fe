//! Random access to frames for training, whatever the layout: datasets of cosfly, the published v7 layout, LeRobot's.
//!
//! * [`FlightSource`]: the seam; each layout of `layouts` implements it.
//! * [`open`]: the source in a folder.
//! * `tables`: tables of foreign layouts, with the names and columns that cosfly's own tables have.

mod foreign;
mod layout;
mod layouts;
mod open;
mod source;
mod tables;
#[cfg(test)]
mod tests;

pub use open::open;
pub use source::{FlightSource, LoadedFlight};
