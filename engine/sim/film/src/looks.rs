//! Seeds of what walkers look like.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_frames::{Seed, TargetTrack};

/// Kind and version of the hashed bytes; another one gives every walker other clothes.
const HEAD: &[u8] = b"cosfly walk-seed/1\n";

/// Seed of a walker's looks, and of the camera and weather of flights behind them.
///
/// # Errors
/// None for tracks in memory.
pub fn walk_seed(track: &TargetTrack) -> Result<Seed> {
    let bytes = postcard::to_extend(track, HEAD.to_vec())
        .map_err(|error| Diagnostic::new("artifact-encode", Fault::Bug, "could not encode a track").because(error))?;
    Ok(Seed(Digest::of(&bytes).0))
}
