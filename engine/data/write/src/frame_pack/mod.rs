//! The frame pack: all images of one trajectory, encoded, in one file that is written and read frame by frame.
//!
//! ```text
//! "COSFLYFP" | version u32 | header length u32 | header (JSON)
//! per frame: rgb | depth | ids | rgb preview | depth preview | semantic preview
//! index: per frame and section: bytes u64, CRC-32 of them u32, plain bytes u32, CRC-32 of those u32
//! index offset u64 | frames u64 | check of header and index [u8; 8] | "COSFLYFE"
//! ```
//! All numbers are little-endian; a check is the first eight bytes of BLAKE3. Sections lie side by side, in the order of
//! the index. `rgb` and the previews are image files (JPEG or PNG); `depth` and `ids` (labels and instances) are chunks of
//! the log to come, compressed with zstd level 1: message records that go into the log as they are, so that nothing is
//! compressed twice.

mod image_record;
mod reader;
mod writer;

pub use reader::{FramePackReader, PackedChunk, PackedFrame};
pub use writer::{FramePackWriter, chunk_compressor};

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_schema::config::EncodingConfig;
use serde::{Deserialize, Serialize};

/// What all frames of a pack share.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PackHeader {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Size of an instance id.
    pub instance: InstanceFormat,
    /// How the images are stored.
    pub encoding: EncodingConfig,
    /// Time between frames, seconds.
    pub dt_s: f64,
}

impl PackHeader {
    /// The header for images of `width` x `height` pixels, `dt_s` apart, whose instance ids are at most
    /// `largest_instance`.
    pub fn new(width: u32, height: u32, largest_instance: u32, encoding: EncodingConfig, dt_s: f64) -> Self {
        let instance = if largest_instance <= u32::from(u16::MAX) { InstanceFormat::U16 } else { InstanceFormat::U32 };
        Self { width, height, instance, encoding, dt_s }
    }

    /// Pixels of one image.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Refuses sizes that no camera of ours has, before anything is allocated for them.
    fn check(&self) -> Result<()> {
        let sides = 1..=MAX_SIDE;
        if !sides.contains(&self.width) || !sides.contains(&self.height) || self.pixels() > MAX_PIXELS {
            return Err(damaged(format!(
                "images of {} x {} pixels; sides must be 1 to {MAX_SIDE} and the area at most {MAX_PIXELS}",
                self.width, self.height
            )));
        }
        if !(self.dt_s.is_finite() && self.dt_s > 0.0) {
            return Err(damaged(format!("frames {} s apart", self.dt_s)));
        }
        Ok(())
    }
}

/// Size of an instance id in a pack and in the log made from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InstanceFormat {
    /// Two bytes.
    U16,
    /// Four bytes, for towns with more than 65,533 objects.
    U32,
}

impl InstanceFormat {
    /// Bytes of one id.
    pub fn bytes(self) -> usize {
        match self {
            Self::U16 => 2,
            Self::U32 => 4,
        }
    }

    /// The encoding in Foxglove's messages: `16UC1`, or `32UC1` where a town has more objects than 16 bits can name
    /// (not in Foxglove's list of encodings: `step` / `width` = 4 tells the size).
    pub fn encoding(self) -> &'static str {
        match self {
            Self::U16 => "16UC1",
            Self::U32 => "32UC1",
        }
    }
}

const MAGIC: &[u8; 8] = b"COSFLYFP";
const END_MAGIC: &[u8; 8] = b"COSFLYFE";
/// Raised whenever older readers would misread newer packs.
const VERSION: u32 = 3;
const SECTIONS: usize = 6;
const ENTRY_BYTES: usize = 20;
const FOOTER_BYTES: usize = 32;
const MAX_SIDE: u32 = 16_384;
const MAX_PIXELS: usize = 1 << 26;
const MAX_FRAMES: u64 = 1 << 24;

/// Where one image of one frame lies, and for chunks what it is before compression.
#[derive(Clone, Copy, Debug, Default)]
struct Section {
    offset: u64,
    bytes: u64,
    crc: u32,
    plain_bytes: u32,
    plain_crc: u32,
}

fn check_of(bytes: &[u8]) -> [u8; 8] {
    *blake3::hash(bytes).as_bytes().first_chunk().expect("a BLAKE3 hash has 32 bytes")
}

fn damaged(message: String) -> Box<Diagnostic> {
    Diagnostic::new("frame-pack", Fault::Input, format!("the frame pack is not usable: {message}"))
}

#[cfg(test)]
mod tests;
