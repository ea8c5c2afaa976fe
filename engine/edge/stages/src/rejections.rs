//! Flights that there is nothing to show of: later stages hand their reason on.

use crate::codec;
use crate::ports::FRAMES;
use cosfly_dataset::Rejection;
use cosfly_diagnose::Result;
use cosfly_stage::{Artifact, Inputs, OutputSink, Produced};

/// Blob of a flight that there is nothing to render of; `index` and `pack` are absent then.
const REJECTION: &str = "rejection";

/// Whether an artifact is one of a rejected flight.
pub fn is_rejected(artifact: &Artifact) -> bool {
    artifact.blobs.contains_key(REJECTION)
}

/// Why a flight was rejected; `None` when it was not.
pub fn rejection(inputs: &Inputs<'_>, artifact: &Artifact) -> Result<Option<Rejection>> {
    let read = || codec::decode(FRAMES, &inputs.read(artifact, REJECTION)?);
    is_rejected(artifact).then(read).transpose()
}

/// Rejects a flight.
pub fn reject(outputs: &mut dyn OutputSink, rejection: Rejection) -> Result<Produced> {
    outputs.put(REJECTION, &codec::encode(FRAMES, &rejection)?)?;
    Ok(Produced { rejected: Some(rejection.reason), ..Produced::default() })
}

/// What a stage makes of a flight that was rejected before it; `None` when it was not.
pub fn handed_on(inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, artifact: &Artifact) -> Result<Option<Produced>> {
    let Some(rejection) = rejection(inputs, artifact)? else { return Ok(None) };
    outputs.link(REJECTION, artifact.blobs[REJECTION])?;
    Ok(Some(Produced { rejected: Some(rejection.reason), ..Produced::default() }))
}
