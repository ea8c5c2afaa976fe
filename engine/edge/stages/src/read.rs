//! What stages made, read back by tools that are no stages.

use crate::codec;
use crate::ports::{TOWN, WALK};
use cosfly_diagnose::Result;
use cosfly_maps::Town;
use cosfly_pedestrians::PedestrianPath;

/// Name of the blob of a `map` item that holds the town.
pub const TOWN_BLOB: &str = crate::world::TOWN_BLOB;
/// Name of the blob of a `pedestrians` item that holds the walk.
pub const WALK_BLOB: &str = "walk";

/// The town in a blob named [`TOWN_BLOB`].
///
/// # Errors
/// When the bytes are of another kind or format version, or broken.
pub fn town(bytes: &[u8]) -> Result<Town> {
    codec::decode(TOWN, bytes)
}

/// The walk in a blob named [`WALK_BLOB`].
///
/// # Errors
/// As [`town`].
pub fn walk(bytes: &[u8]) -> Result<PedestrianPath> {
    codec::decode(WALK, bytes)
}
