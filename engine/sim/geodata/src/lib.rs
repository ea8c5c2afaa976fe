//! Readers of survey data: OpenStreetMap, CityJSON.

pub mod cityjson;
mod open_ground;
