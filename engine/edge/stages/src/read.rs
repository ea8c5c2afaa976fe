//! Results of stages, read back by other tools.

use crate::flight::Companion;
use crate::nearby::NearbyBodies;
use crate::other_drones::Formation;
use crate::ports::{AROUND, FORMATION, NEARBY, TOWN, TRAJECTORY, WALK};
use crate::walks::walk_seed;
use crate::{codec, companions};
use cosfly_diagnose::Result;
use cosfly_domain::{Around, Followed, PlanOutcome, Town};
use cosfly_frames::{DVec3, Seed, TargetTrack};
use cosfly_pedestrians::PedestrianPath;

/// Name of the blob of a `map` item that holds the town.
pub const TOWN_BLOB: &str = crate::world::TOWN_BLOB;
/// Name of the blob of a `pedestrians` item that holds the walk.
pub const WALK_BLOB: &str = "walk";
/// Name of the blob of a `muco` or `perturb` item that holds the trajectory.
pub const TRAJECTORY_BLOB: &str = "trajectory";

/// Name of the blob of a `muco` or `perturb` item that holds all drones behind the walk, where there are several.
pub const DRONES_BLOB: &str = crate::other_drones::DRONES_BLOB;
/// Name of the blob of an item of part `companions` of a `muco` stage.
pub const COMPANIONS_BLOB: &str = companions::NAME;

/// Town in a blob named [`TOWN_BLOB`].
///
/// # Errors
/// Bytes of another kind or format version, and broken ones.
pub fn town(bytes: &[u8]) -> Result<Town> {
    codec::decode(TOWN, bytes)
}

/// Walk in a blob named [`WALK_BLOB`].
///
/// # Errors
/// As [`town`].
pub fn walk(bytes: &[u8]) -> Result<PedestrianPath> {
    codec::decode(WALK, bytes)
}

/// Name of the blob of a flight through traffic that holds the bodies around its target.
pub const AROUND_BLOB: &str = crate::traffic::AROUND_BLOB;

/// Bodies in a blob named [`AROUND_BLOB`].
///
/// # Errors
/// As [`town`].
pub fn around(bytes: &[u8]) -> Result<Around> {
    codec::decode(AROUND, bytes)
}

/// Name of the blob of an item of part `nearby` of a `render` stage that holds the bodies of traffic near a film; its blobs
/// `walk-...` hold the walks near it.
pub const NEARBY_BODIES_BLOB: &str = crate::traffic::BODIES;

/// Bodies in a blob named [`NEARBY_BODIES_BLOB`], by traffic.
///
/// # Errors
/// As [`town`].
pub fn bodies_near(bytes: &[u8]) -> Result<Vec<Around>> {
    let near: Vec<NearbyBodies> = codec::decode(NEARBY, bytes)?;
    Ok(near.into_iter().map(|bodies| bodies.around).collect())
}

/// Name of the blob of a flight through traffic that holds the body it follows.
pub const FOLLOWED_BLOB: &str = crate::traffic::FOLLOWED;

/// Body in a blob named [`FOLLOWED_BLOB`].
///
/// # Errors
/// As [`town`].
pub fn followed(bytes: &[u8]) -> Result<Followed> {
    codec::decode(WALK, bytes)
}

/// Seed of the looks of a walker who is no body of traffic.
///
/// # Errors
/// As [`town`].
pub fn looks(track: &TargetTrack) -> Result<Seed> {
    walk_seed(track)
}

/// Trajectory in a blob named [`TRAJECTORY_BLOB`], or the reason why there is none.
///
/// # Errors
/// As [`town`].
pub fn trajectory(bytes: &[u8]) -> Result<PlanOutcome> {
    codec::decode(TRAJECTORY, bytes)
}

/// Places of the drones that were planned before that of a flight, frame by frame, from a blob named [`DRONES_BLOB`].
///
/// # Errors
/// As [`town`].
pub fn drones_before(bytes: &[u8]) -> Result<Vec<Vec<DVec3>>> {
    Ok(codec::decode::<Formation>(FORMATION, bytes)?.before().collect())
}

/// Companions in a blob named [`COMPANIONS_BLOB`].
///
/// # Errors
/// As [`town`].
pub fn companions(bytes: &[u8]) -> Result<Vec<Companion>> {
    companions::decode(bytes)
}
