//! Readers of survey data: OpenStreetMap, CityJSON.

pub mod cityjson;
mod open_ground;
pub mod osm;
pub mod projection;
pub mod slabs;
