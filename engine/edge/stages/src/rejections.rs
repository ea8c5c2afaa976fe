//! Rejected flights: later stages hand their reason on.

use cosfly_blobs::OutputSink;
use cosfly_diagnose::Result;
use cosfly_experts::artifacts::REJECTION;
use cosfly_schema::Rejection;
use cosfly_stage::{Artifact, Inputs, Produced};

/// True for the artifact of a rejected flight.
pub fn is_rejected(artifact: &Artifact) -> bool {
    REJECTION.is_in(artifact)
}

/// Rejection of a flight; `None` where it was not rejected.
pub fn rejection(inputs: &Inputs<'_>, artifact: &Artifact) -> Result<Option<Rejection>> {
    REJECTION.find(inputs, artifact)
}

/// Rejects a flight.
pub fn reject(outputs: &mut dyn OutputSink, rejection: Rejection) -> Result<Produced> {
    REJECTION.put(outputs, &rejection)?;
    Ok(Produced::rejected(rejection.reason))
}

/// Hands the rejection of a flight on; `None` where it was not rejected.
pub fn handed_on(inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, artifact: &Artifact) -> Result<Option<Produced>> {
    let Some(rejection) = rejection(inputs, artifact)? else { return Ok(None) };
    outputs.link(REJECTION.blob, artifact.blobs[REJECTION.blob])?;
    Ok(Some(Produced::rejected(rejection.reason)))
}
