//! The list of all map formats.
//!
//! A new format is one file here and two lines in this one: its `mod` line and its entry in [`FORMATS`].

pub mod boxes;
pub mod generated;
pub mod opendrive;

use cosfly_geodata::{cityjson, osm};
use cosfly_scans::{gltf, las, obj, pcd, ply};
use cosfly_town::Format;

/// All formats.
pub const FORMATS: &[Format] = &[
    // Sorted by name.
    Format::of::<boxes::Boxes>(),
    Format::of::<cityjson::CityJson>(),
    Format::of::<generated::Generated>(),
    Format::of::<gltf::GlTf>(),
    Format::of::<las::Las>(),
    Format::of::<obj::Obj>(),
    Format::of::<opendrive::OpenDrive>(),
    Format::of::<osm::OpenStreetMap>(),
    Format::of::<pcd::Pcd>(),
    Format::of::<ply::Ply>(),
];
