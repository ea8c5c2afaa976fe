//! The list of all map formats.
//!
//! A new format is one file here and two lines in this one: its `mod` line and its entry in [`FORMATS`].

pub mod boxes;
pub mod opendrive;

use crate::Format;
use cosfly_scans::{gltf, las, obj, pcd, ply};

/// All formats.
pub const FORMATS: &[Format] = &[
    // Sorted by name.
    Format::of::<boxes::Boxes>(),
    Format::of::<gltf::GlTf>(),
    Format::of::<las::Las>(),
    Format::of::<obj::Obj>(),
    Format::of::<opendrive::OpenDrive>(),
    Format::of::<pcd::Pcd>(),
    Format::of::<ply::Ply>(),
];
