//! Readers of survey data: OpenStreetMap, CityJSON.
