//! A reference to bytes by their content.

use cosfly_fingerprint::Digest;
use serde::{Deserialize, Serialize};

/// Content-addressed bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BlobRef {
    /// BLAKE3 of the bytes.
    pub digest: Digest,
    /// Number of bytes.
    pub bytes: u64,
}
