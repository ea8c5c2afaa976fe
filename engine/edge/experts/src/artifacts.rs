//! Kinds of artifacts: each has a type of values, a format version and blobs.

use crate::codec;
use cosfly_blobs::OutputSink;
use cosfly_diagnose::Result;
use cosfly_domain::{Around, Followed, PlanOutcome, Town, Traffic};
use cosfly_film::nearby::{NearbyBodies, NearbyWalk};
use cosfly_flight::formation::Formation;
use cosfly_flight::losses::Trial;
use cosfly_flight::{Flown, NamedTrack};
use cosfly_pedestrians::PedestrianPath;
use cosfly_schema::Rejection;
use cosfly_stage::{Artifact, Inputs};
use serde::{Serialize, de::DeserializeOwned};
use std::any::Any;
use std::marker::PhantomData;
use std::sync::Arc;

/// A blob of an artifact with values of type `T`.
pub struct Kind<T> {
    /// Artifact with its format version, such as `town/1`.
    pub artifact: &'static str,
    /// Name of the blob.
    pub blob: &'static str,
    values: PhantomData<fn() -> T>,
}

/// A town. Every artifact that was made in it carries it as a link.
pub const TOWN: Kind<Town> = Kind::new("town/1", "town");
/// The walk of a pedestrian, or of another body that is followed.
pub const WALK: Kind<PedestrianPath> = Kind::new("walk/2", "walk");
/// The body of traffic that a walk or a flight follows.
pub const FOLLOWED: Kind<Followed> = Kind::new("walk/2", "followed");
/// Companions of a flight.
pub const COMPANIONS: Kind<Vec<NamedTrack>> = Kind::new("companions/1", "companions");
/// All people and vehicles that move through a town; the part and the blob have one name.
pub const TRAFFIC: Kind<Traffic> = Kind::new("traffic/1", "bodies");
/// Bodies around the target of a flight.
pub const AROUND: Kind<Around> = Kind::new("around/1", "around");
/// Id of the walk that a flight follows, such as `crowd/p00003`.
pub const WALK_ID: Kind<String> = Kind::new("walk-id/1", "walk-id");
/// Outcome of ordering a loss of the target.
pub const LOSSES: Kind<Trial> = Kind::new("losses/1", "trial");
/// Flights of all drones behind a walk; a blob for each, of this type.
pub const FORMATION: Kind<Flown> = Kind::new("formation/1", "");
/// All drones behind the walk of a flight; absent where the drone is alone.
pub const DRONES: Kind<Formation> = Kind::new("formation/1", "drones");
/// A planned or changed flight, or the reason why there is none.
pub const FLIGHT: Kind<PlanOutcome> = Kind::new("trajectory/5", "trajectory");
/// People who are near a flight, each with a blob of the walk.
pub const NEARBY: Kind<Vec<NearbyWalk>> = Kind::new("nearby/1", "people");
/// Bodies of traffic near a flight; absent where there is no traffic.
pub const NEARBY_BODIES: Kind<Vec<NearbyBodies>> = Kind::new("nearby/1", "bodies");
/// Artifact of a film.
pub const FRAMES: &str = "frames/4";
/// Blob of a film with its pictures.
pub const FILM: &str = "pack";
/// Reason why a film has no pictures; absent where it has.
pub const REJECTION: Kind<Rejection> = Kind::new(FRAMES, "rejection");

impl<T> Kind<T> {
    /// Values of type `T` in blobs called `blob` of artifacts `artifact`.
    pub const fn new(artifact: &'static str, blob: &'static str) -> Self {
        Self { artifact, blob, values: PhantomData }
    }

    /// Whether an artifact has such a blob.
    pub fn is_in(&self, artifact: &Artifact) -> bool {
        artifact.blobs.contains_key(self.blob)
    }
}

impl<T: Serialize> Kind<T> {
    /// A value as the bytes of a blob.
    ///
    /// # Errors
    /// Values that cannot be written.
    pub fn encode(&self, value: &T) -> Result<Vec<u8>> {
        codec::encode(self.artifact, value)
    }

    /// Writes a value as the blob of an item.
    ///
    /// # Errors
    /// Those of the disk.
    pub fn put(&self, outputs: &mut dyn OutputSink, value: &T) -> Result<()> {
        outputs.put(self.blob, &self.encode(value)?)
    }
}

impl<T: DeserializeOwned> Kind<T> {
    /// Value in the bytes of a blob.
    ///
    /// # Errors
    /// Bytes of another kind or format version, and broken ones.
    pub fn decode(&self, bytes: &[u8]) -> Result<T> {
        codec::decode(self.artifact, bytes)
    }

    /// Value in the blob of an artifact.
    ///
    /// # Errors
    /// Those of [`Self::decode`]; a blob that is not there.
    pub fn read(&self, inputs: &Inputs<'_>, artifact: &Artifact) -> Result<T> {
        self.decode(&inputs.read(artifact, self.blob)?)
    }

    /// Value in the blob of an artifact; `None` where there is no such blob.
    ///
    /// # Errors
    /// Those of [`Self::decode`].
    pub fn find(&self, inputs: &Inputs<'_>, artifact: &Artifact) -> Result<Option<T>> {
        self.is_in(artifact).then(|| self.read(inputs, artifact)).transpose()
    }
}

impl<T: DeserializeOwned + Any + Send + Sync> Kind<T> {
    /// Value of [`Self::read`], decoded once for all tasks that share it.
    ///
    /// # Errors
    /// Those of [`Self::read`].
    pub fn shared(&self, inputs: &Inputs<'_>, artifact: &Artifact) -> Result<Arc<T>> {
        inputs.decoded(artifact, self.blob, |bytes| self.decode(bytes))
    }
}

/// Links somebody's walk, and who that is, under names with the walk's id.
///
/// # Errors
/// Those of the disk.
pub fn link_walk(walk: &Artifact, walk_id: &str, outputs: &mut dyn OutputSink) -> Result<()> {
    for name in [WALK.blob, FOLLOWED.blob] {
        if let Some(blob) = walk.blobs.get(name) {
            outputs.link(&format!("{name}-{walk_id}"), *blob)?;
        }
    }
    Ok(())
}

/// Body that [`link_walk`] linked; `None` for a grown person on foot.
///
/// # Errors
/// Those of [`Kind::read`].
pub fn linked_walk(
    inputs: &Inputs<'_>,
    artifact: &Artifact,
    walk_id: &str,
) -> Result<(Arc<PedestrianPath>, Option<Followed>)> {
    let name = |blob: &str| format!("{blob}-{walk_id}");
    let walk = inputs.decoded(artifact, &name(WALK.blob), |bytes| WALK.decode(bytes))?;
    let followed = name(FOLLOWED.blob);
    let is_there = artifact.blobs.contains_key(&followed);
    Ok((walk, is_there.then(|| FOLLOWED.decode(&inputs.read(artifact, &followed)?)).transpose()?))
}
