//! The frame pack: all images of one trajectory, encoded, in one file that is written and read frame by frame.
//!
//! ```text
//! "COSFLYFP" | version u32 | header length u32 | header (JSON)
//! per frame: image files | chunks | previews: rgb | depth | ids | rgb preview | depth preview | semantic preview
//! index: per frame and section: bytes u64, CRC-32 of them u32, plain bytes u32, CRC-32 of those u32
//! index offset u64 | frames u64 | check of header and index [u8; 8] | "COSFLYFE"
//! ```
//! All numbers are little-endian; a check is the first eight bytes of BLAKE3. Sections lie side by side, in the order of
//! the index. `rgb` and the previews are image files (JPEG or PNG); `depth`, `ids` (labels and instances) and each channel on
//! request are chunks of the log to come, compressed with zstd level 1: message records that go into the log as they are,
//! so that nothing is compressed twice.

mod header;
mod image_record;
mod layout;
mod pixels;
mod reader;
mod writer;

pub use header::{InstanceFormat, PackHeader};
pub use reader::{FramePackReader, PackedChunk, PackedFrame};
pub use writer::{FramePackWriter, chunk_compressor};

#[cfg(test)]
mod tests;
