//! A reference to bytes by their content.

use cosfly_fingerprint::Digest;
use serde::{Deserialize, Serialize};

/// Some bytes of a blob, with a digest of their own: they are read without the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BlobPart {
    /// Number of bytes before them.
    pub offset: u64,
    /// Number of bytes.
    pub bytes: u32,
    /// BLAKE3 of the bytes.
    pub digest: Digest,
}

/// Content-addressed bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BlobRef {
    /// BLAKE3 of the bytes.
    pub digest: Digest,
    /// Number of bytes.
    pub bytes: u64,
}
