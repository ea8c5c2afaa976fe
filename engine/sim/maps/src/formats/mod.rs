//! Map formats: the list of all of them, and what their readers share.
//!
//! A new format is one file here and two lines in this one: its `mod` line and its entry in [`FORMATS`].

pub mod boxes;
pub mod format;
mod mesh;
pub mod opendrive;
mod terrain;
mod text;
pub mod world;

pub use format::{Format, MapFormat};

/// All formats.
pub const FORMATS: &[Format] = &[
    // Sorted by name.
    Format::of::<boxes::Boxes>(),
    Format::of::<opendrive::OpenDrive>(),
];
