//! Reads published datasets: which flights there are, what the tables say of a flight, and the images in its log.
//!
//! Columns are found by their names, so that datasets with more columns than ours are read, too.

mod columns;
mod flights;
mod foreign;
mod inspection;
mod log;
mod tracks;
mod walk;
mod ways;

pub use flights::{PublishedDataset, PublishedFlight, PublishedFrame};
pub use foreign::{ForeignRows, foreign_rows};
pub use inspection::{BoxInWorld, FlightFacts, log_problem, parquet_problem};
pub use log::{LogReader, LoggedFrame, SceneBox};
pub use tracks::FlightTrack;
pub use walk::{Disturbance, FrameRow};

#[cfg(test)]
mod tests;
