//! Canonical hashing of configs and inputs: BLAKE3 digests and the canonical JSON they are taken over.

mod digest;
pub mod sha256;

pub use digest::{Digest, DigestOfPieces, canonical_json};
