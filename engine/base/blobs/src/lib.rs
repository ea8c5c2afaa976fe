//! Named bytes: content references, sinks for the files of a result, files read or written once.
//!
//! * [`BlobRef`], [`BlobPart`]: bytes by their digest.
//! * [`OutputSink`]: the files of one result while they are being made.
//! * [`PassingFile`]: a large file that is written or read once, without filling the system's file cache.

mod blob;
mod passing;
mod sink;

pub use blob::{BlobPart, BlobRef};
pub use passing::PassingFile;
pub use sink::{OutputSink, SeekWrite};
