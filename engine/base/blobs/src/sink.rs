//! Sinks that makers write files to.

use crate::BlobRef;
use cosfly_diagnose::Result;
use std::io::{Seek, Write};

/// A file that is being written.
pub trait SeekWrite: Write + Seek + Send {}

impl<T: Write + Seek + Send> SeekWrite for T {}

/// Files of one result. Nobody sees any of them until the whole result is finished.
///
/// Names are relative paths with `/`, each used once.
pub trait OutputSink {
    /// Adds a small file, given whole.
    fn put(&mut self, name: &str, bytes: &[u8]) -> Result<()>;

    /// Adds a large file, written piece by piece. Where the disk refuses a write, that refusal is returned, whatever
    /// `write` makes of it.
    fn stream(&mut self, name: &str, write: &mut dyn FnMut(&mut dyn SeekWrite) -> Result<()>) -> Result<BlobRef>;

    /// Adds bytes that are stored already, without copying them.
    fn link(&mut self, name: &str, blob: BlobRef) -> Result<()>;
}
