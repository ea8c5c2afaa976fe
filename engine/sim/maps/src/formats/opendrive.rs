//! OpenDRIVE 1.4 to 1.8: roads, lanes, objects and signals into a [`Town`].
//!
//! [`network`] is the file as it stands; [`plan_view`] and [`road_geometry`] evaluate it; the other rooms build the
//! town's parts from it. Everything stays in the file's right-handed frame until [`cosfly_town::world`] turns it over.

mod attributes;
mod build;
mod crossings;
mod document;
mod gaps;
mod ground_patches;
mod header;
mod inner_lanes;
mod island_outline;
mod islands;
mod joining;
mod kerb_stones;
mod lanes;
mod line_ends;
pub mod network;
mod object_kind;
mod objects;
mod options;
mod parse_lanes;
mod parse_objects;
mod parse_road;
pub mod plan_view;
pub mod polynomial;
mod quadrature;
mod refuges;
mod repeats;
mod road_ends;
pub mod road_geometry;
mod road_map;
mod road_marks;
mod signals;
mod slits;
mod stations;
mod surfaces;
mod unread;
mod verges;
mod walkable;
mod xml_bounds;

pub use options::{OpenDriveOptions, Roofs};
pub use road_map::{LanePoint, RoadMap};

use cosfly_domain::Town;
use cosfly_town::MapError;
use cosfly_town::format::MapFormat;

/// The OpenDRIVE format.
#[derive(Clone, Copy, Debug)]
pub struct OpenDrive;

impl MapFormat for OpenDrive {
    type Options = OpenDriveOptions;

    const NAME: &'static str = "OpenDRIVE";

    const EXAMPLE: &'static [u8] = include_bytes!("opendrive/every_feature.xodr");

    fn recognises(head: &[u8]) -> bool {
        // UTF-16 is recognised, too, so that its refusal can say what to do.
        let plain: Vec<u8> = head.iter().copied().filter(|byte| *byte != 0).collect();
        plain.windows(10).any(|window| window == b"<OpenDRIVE")
    }

    fn read(bytes: &[u8], options: &OpenDriveOptions) -> Result<(Town, Vec<String>), MapError> {
        build::town(bytes, options)
    }
}
