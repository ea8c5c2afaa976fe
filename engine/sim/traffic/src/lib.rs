//! Traffic: people and vehicles of all origins, moved together through a town.
//!
//! * [`TrafficConfig`]: who moves; [`Follow`]: which bodies flights follow.
//! * [`simulate_traffic`]: everybody's track, dressed.
//! * [`Avoided`]: people on walks that were made before, around whom everybody moves.

mod avoided;
mod config;
mod follow;
mod populations;
mod simulate;

pub use avoided::Avoided;
pub use config::{RecordedSource, SumoSource, TrafficConfig};
pub use follow::Follow;
pub use populations::TrackFile;
pub use simulate::{SimulatedTraffic, simulate_traffic};
