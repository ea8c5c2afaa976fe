//! OpenDRIVE 1.4 to 1.8: roads, lanes, objects and signals into a [`Town`].
//!
//! [`network`] is the file as it stands; [`plan_view`] and [`road_geometry`] evaluate it; the other rooms build the
//! town's parts from it. Everything stays in the file's right-handed frame until [`world`] turns it over.

mod attributes;
mod build;
mod crossings;
mod joining;
pub mod network;
mod object_kind;
mod objects;
mod parse_lanes;
mod parse_objects;
mod parse_road;
pub mod plan_view;
pub mod polynomial;
mod quadrature;
pub mod road_geometry;
mod road_marks;
mod signals;
mod stations;
mod surfaces;
mod terrain;
mod text;
mod walkable;
pub mod world;

pub use build::{LanePoint, RoadMap};

use super::MapFormat;
use crate::{MapConfig, MapError, Town};

/// The OpenDRIVE reader.
#[derive(Clone, Copy, Debug)]
pub struct OpenDrive;

impl MapFormat for OpenDrive {
    fn name(&self) -> &'static str {
        "OpenDRIVE"
    }

    fn recognises(&self, bytes: &[u8]) -> bool {
        let head = &bytes[..bytes.len().min(4096)];
        // UTF-16 is recognised, too, so that its refusal can say what to do.
        let plain: Vec<u8> = head.iter().copied().filter(|byte| *byte != 0).collect();
        plain.windows(10).any(|window| window == b"<OpenDRIVE")
    }

    fn read(&self, bytes: &[u8], options: &MapConfig) -> Result<(Town, Vec<String>), MapError> {
        build::town(bytes, options)
    }
}
