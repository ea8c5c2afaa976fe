//! Flights of experts: what they follow, how they are planned, from their beginning or from any state.
//!
//! * [`world`]: a town ready for queries.
//! * [`expert`]: weights, objective and aim; [`flight`]: one flight, and who moves around it; [`aim`]: the aim of its pilot;
//!   [`flown`]: what came of it.
//! * [`plugins`]: cost terms and objectives of others.
//! * [`formation`]: the drones behind one walk; [`companions`]: the walks beside it; [`losses`]: orders to lose the target.
//! * [`comparison`]: other planners on the walks of published flights.

pub mod aim;
pub mod companions;
pub mod comparison;
pub mod expert;
pub mod flight;
pub mod flown;
pub mod formation;
pub mod losses;
pub mod plugins;
pub mod world;

pub use companions::NamedTrack;
pub use expert::Expert;
pub use flight::{Flight, MovingBodies};
pub use flown::Flown;
pub use plugins::{DrawnReference, FlightPlugins, NoPlugins, OpenTerms};
pub use world::World;
