//! Rejected flights: later stages hand their reason on.

use crate::codec;
use crate::ports::FRAMES;
use cosfly_blobs::OutputSink;
use cosfly_diagnose::Result;
use cosfly_schema::Rejection;
use cosfly_stage::{Artifact, Inputs, Produced};

/// Blob of a rejected flight; `index` and `pack` are absent then.
pub const REJECTION: &str = "rejection";

/// True for the artifact of a rejected flight.
pub fn is_rejected(artifact: &Artifact) -> bool {
    artifact.blobs.contains_key(REJECTION)
}

/// Rejection of a flight; `None` where it was not rejected.
pub fn rejection(inputs: &Inputs<'_>, artifact: &Artifact) -> Result<Option<Rejection>> {
    let read = || codec::decode(FRAMES, &inputs.read(artifact, REJECTION)?);
    is_rejected(artifact).then(read).transpose()
}

/// Rejects a flight.
pub fn reject(outputs: &mut dyn OutputSink, rejection: Rejection) -> Result<Produced> {
    outputs.put(REJECTION, &codec::encode(FRAMES, &rejection)?)?;
    Ok(Produced::rejected(rejection.reason))
}

/// Hands the rejection of a flight on; `None` where it was not rejected.
pub fn handed_on(inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, artifact: &Artifact) -> Result<Option<Produced>> {
    let Some(rejection) = rejection(inputs, artifact)? else { return Ok(None) };
    outputs.link(REJECTION, artifact.blobs[REJECTION])?;
    Ok(Some(Produced::rejected(rejection.reason)))
}
