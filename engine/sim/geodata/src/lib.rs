//! Readers of survey data: OpenStreetMap, CityJSON.

pub mod osm;
pub mod projection;
pub mod slabs;
