//! Sinks that the files of a result are written to.

use crate::BlobRef;
use cosfly_diagnose::Result;
use std::io::{Seek, Write};

/// A file open for writing.
pub trait SeekWrite: Write + Seek + Send {}

impl<T: Write + Seek + Send> SeekWrite for T {}

/// Files of one result. None is visible before the whole result is finished.
///
/// Names are relative paths with `/`, each used once.
pub trait OutputSink {
    /// Adds a small file with the content `bytes`.
    fn put(&mut self, name: &str, bytes: &[u8]) -> Result<()>;

    /// Adds a large file, written piece by piece. A write error of the disk is returned even where `write` ignores it.
    fn stream(&mut self, name: &str, write: &mut dyn FnMut(&mut dyn SeekWrite) -> Result<()>) -> Result<BlobRef>;

    /// Adds bytes that are already stored, without copying them.
    fn link(&mut self, name: &str, blob: BlobRef) -> Result<()>;
}
