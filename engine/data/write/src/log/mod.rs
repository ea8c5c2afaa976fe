//! Writes logs: MCAP files of Foxglove messages, readable without our code; one of a rendered trajectory, one of a closed-loop
//! flight.

mod channels;
mod container;
mod flown;
mod metadata;
mod readings;
mod scene;
mod writer;

pub use flown::{FlownFlight, FlownStep, SensedSample, write_flown_log};
pub use writer::{WrittenLog, write_log};

#[cfg(test)]
mod tests;
