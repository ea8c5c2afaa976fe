//! Reads published datasets: the trajectories, what the tables say of them, and the images in their logs; and what models
//! predicted.
//!
//! Columns are asked for by their entries in [`cosfly_schema::tables`], so datasets with more columns than ours are read, too.

mod damage;
mod dataset;
mod foreign;
mod frames;
mod log;
mod objects;
mod plain;
pub mod predictions;
mod records;
mod rows;
mod tracks;
mod trajectory;
mod ways;
mod whole_files;

pub use dataset::PublishedDataset;
pub use foreign::{ForeignRows, foreign_rows};
pub use frames::{Disturbance, FrameRow};
pub use log::{LogReader, LoggedFrame, SceneBox};
pub use objects::{BoxInWorld, PublishedObject};
pub use records::read_records;
pub use rows::{Rows, TableFile, Values, read};
pub use tracks::FlightTrack;
pub use trajectory::PublishedFlight;
pub use whole_files::{log_problem, parquet_problem};

#[cfg(test)]
mod tests;
