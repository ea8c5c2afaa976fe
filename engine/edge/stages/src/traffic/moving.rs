//! The moving world of a walk or a flight, as artifacts carry it.

use cosfly_blobs::OutputSink;
use cosfly_diagnose::Result;
use cosfly_domain::{Around, Followed, Traffic};
use cosfly_experts::artifacts;
use cosfly_frames::TargetTrack;
use cosfly_stage::{Artifact, Inputs};
use std::sync::Arc;

/// Bodies that come within this distance of the followed one, seen from above, are around it, metres.
const AROUND_M: f64 = 60.0;

/// Traffic that a walk was taken out of; `None` for a walk of a stage `pedestrians`.
pub fn traffic_of(inputs: &Inputs<'_>, walk: &Artifact) -> Result<Option<Arc<Traffic>>> {
    artifacts::TRAFFIC.is_in(walk).then(|| artifacts::TRAFFIC.shared(inputs, walk)).transpose()
}

/// The followed body of a walk or a flight; `None` outside of traffic.
pub fn followed(inputs: &Inputs<'_>, artifact: &Artifact) -> Result<Option<Followed>> {
    artifacts::FOLLOWED.find(inputs, artifact)
}

/// Bodies around the target of a walk; nobody outside of traffic.
pub fn cut_around(inputs: &Inputs<'_>, walk: &Artifact, track: &TargetTrack) -> Result<Around> {
    let Some(traffic) = traffic_of(inputs, walk)? else { return Ok(Around::default()) };
    let own = followed(inputs, walk)?.map(|followed| followed.number);
    Ok(Around::of(&traffic, track, own, AROUND_M))
}

/// Writes the id of the walk that a flight follows and the bodies around it, and links what later stages need to know of the
/// moving world.
pub fn put_around(walk: &Artifact, around: &Around, outputs: &mut dyn OutputSink) -> Result<()> {
    artifacts::WALK_ID.put(outputs, &walk.id.to_string())?;
    if artifacts::TRAFFIC.is_in(walk) {
        artifacts::AROUND.put(outputs, around)?;
    }
    link_moving(walk, outputs)
}

/// Bodies around the target of a flight; nobody outside of traffic.
pub fn around(inputs: &Inputs<'_>, artifact: &Artifact) -> Result<Arc<Around>> {
    if !artifacts::AROUND.is_in(artifact) {
        return Ok(Arc::default());
    }
    artifacts::AROUND.shared(inputs, artifact)
}

/// Links the walk's id, the followed body, the bodies around it and the other drones from an input to the output of a task.
pub fn link_moving(artifact: &Artifact, outputs: &mut dyn OutputSink) -> Result<()> {
    let kept = [artifacts::WALK_ID.blob, artifacts::FOLLOWED.blob, artifacts::AROUND.blob, artifacts::DRONES.blob];
    for name in kept {
        if let Some(blob) = artifact.blobs.get(name) {
            outputs.link(name, *blob)?;
        }
    }
    Ok(())
}
