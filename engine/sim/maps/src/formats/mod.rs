//! The list of all map formats.
//!
//! A new format is one file here and two lines in this one: its `mod` line and its entry in [`FORMATS`].

pub mod boxes;
pub mod generated;
pub mod opendrive;

use crate::Format;

/// All formats.
pub const FORMATS: &[Format] = &[
    // Sorted by name.
    Format::of::<boxes::Boxes>(),
    Format::of::<generated::Generated>(),
    Format::of::<opendrive::OpenDrive>(),
    Format::of::<cosfly_geodata::osm::OpenStreetMap>(),
];
