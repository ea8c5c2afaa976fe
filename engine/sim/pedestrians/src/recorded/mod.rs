//! Recorded people: tracks with time from GPX, GeoJSON, ETH/UCY `obsmat` and CSV files, read from bytes.
//!
//! [`Recording::read`] gives tracks as the file has them, checked; [`Recording::placed`] puts them into a town as a
//! [`Prescribed`](cosfly_world::Prescribed) population.

mod columns;
mod config;
mod curve;
mod error;
mod geojson;
mod gpx;
mod instant;
mod placed;
mod reading;
mod tidy;
mod track;
mod unique;

pub use config::{RecordedConfig, RecordedFormat};
pub use error::RecordedError;
pub use track::{RecordedPoint, RecordedTrack, Recording};
