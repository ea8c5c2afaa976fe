//! Vehicles and drones: bodies of flat faces, and riders, within the boxes of their bodies.

mod cars;
mod coaches;
mod drones;
mod fit;
mod fittings;
mod livery;
mod lorries;
mod model;
mod riders;
mod shapes;
mod shell;
mod sitters;
mod taken_along;
#[cfg(test)]
mod tests;
mod vehicle;
mod wheels;

pub use fittings::Fittings;
pub use livery::Livery;
pub(crate) use vehicle::add;
