//! Vehicles and drones: bodies of flat faces, and riders, within the boxes of their bodies.

mod coaches;
mod drones;
mod livery;
mod model;
mod riders;
#[cfg(test)]
mod tests;
mod vehicle;

pub use livery::Livery;
pub(crate) use vehicle::add;
