//! Readers of survey data: OpenStreetMap, CityJSON.

pub mod cityjson;
pub mod conformal;
pub mod datum;
mod epsg;
mod open_ground;
pub mod osm;
pub mod projection;
pub mod reference;
pub mod slabs;
