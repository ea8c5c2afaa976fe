//! Vehicles: simulated on the lanes of a town ([`Vehicles`]), or recorded by SUMO ([`fcd`]). Both are a
//! [`cosfly_world::Population`].
//!
//! Simulated vehicles follow each other by the intelligent driver model (Treiber, Hennecke, Helbing 2000), slow down in
//! bends, ask for their way through a junction before they enter it, and stop for people on crossings.

mod config;
mod driver;
mod error;
pub mod fcd;
mod junctions;
mod kinds;
mod network;
mod outlines;
mod parked;
mod parking;
mod paved;
mod route;
mod start;
mod vehicle;
mod vehicles;

pub use config::{MixConfig, VehicleConfig};
pub use error::{VehicleConfigRule, VehicleError};
pub use vehicles::Vehicles;
