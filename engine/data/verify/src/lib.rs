//! Checks a finished dataset from the outside, by its files alone: hashes, schemas, counts, logs, geometry.
//!
//! Every finding names the file, the place in it and the rule. Files whose hash is wrong are reported and not
//! read further, except for logs, whose own checksums tell where the damage is.
//!
//! Flights are checked side by side and their findings joined in the order of the tables, so that the report is the same for
//! any number of threads. Beside the flights being checked, memory holds some hundred bytes per flight: names, figures,
//! digests.

mod bodies;
mod body;
mod boxes;
mod captions;
mod checks;
mod clouds;
mod croissant;
mod disparity;
mod extras;
mod figures;
mod files;
mod film;
mod flight_list;
mod flight_rows;
mod flights;
mod flow;
mod flow_masks;
mod frames;
mod ground;
mod log;
mod mesh;
mod on_request;
mod options;
mod readings;
mod report;
mod resume;
mod rows;
mod sensed;
mod sensed_rows;
mod splits;
mod sums;
mod surfaces;
mod tables;
#[cfg(test)]
mod tests;
mod verify;
mod waypoints;
mod windows;

pub use options::Options;
pub use report::{Finding, LabelGap, VerifyReport};
pub use verify::verify;
