//! The frame pack: all images of one trajectory, encoded, in one file that is written and read frame by frame.
//!
//! ```text
//! "COSFLYFP" | version u32 | header length u32 | header (JSON)
//! per frame: rgb | depth | semantic | instance | rgb preview | depth preview | semantic preview
//! index: per frame and channel: offset u64, bytes u64, check [u8; 8]
//! index offset u64 | frames u64 | check of header and index [u8; 8] | "COSFLYFE"
//! ```
//! All numbers are little-endian; a check is the first eight bytes of BLAKE3. `rgb` and the previews are
//! image files (JPEG or PNG); `depth` (f32 metres), `semantic` (u8) and `instance` (u16 or u32) are
//! row-major raw pixels behind zstd level 1.

mod reader;
mod writer;

pub use reader::{FramePackReader, PackedFrame};
pub use writer::FramePackWriter;

use crate::config::EncodingConfig;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use serde::{Deserialize, Serialize};

/// What all frames of a pack share.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PackHeader {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Size of an instance id.
    pub instance: InstanceFormat,
    /// How the images are stored.
    pub encoding: EncodingConfig,
}

impl PackHeader {
    /// The header for images of `width` x `height` pixels whose instance ids are at most `largest_instance`.
    pub fn new(width: u32, height: u32, largest_instance: u32, encoding: EncodingConfig) -> Self {
        let instance = if largest_instance <= u32::from(u16::MAX) { InstanceFormat::U16 } else { InstanceFormat::U32 };
        Self { width, height, instance, encoding }
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
}

const MAGIC: &[u8; 8] = b"COSFLYFP";
const END_MAGIC: &[u8; 8] = b"COSFLYFE";
/// Raised whenever older readers would misread newer packs.
const VERSION: u32 = 1;
const CHANNELS: usize = 7;
const ENTRY_BYTES: usize = 24;
const FOOTER_BYTES: usize = 32;
const MAX_SIDE: u32 = 16_384;
const MAX_PIXELS: usize = 1 << 26;
const MAX_FRAMES: u64 = 1 << 24;

/// Where one image of one frame lies.
#[derive(Clone, Copy, Debug, Default)]
struct Section {
    offset: u64,
    bytes: u64,
    check: [u8; 8],
}

fn check_of(bytes: &[u8]) -> [u8; 8] {
    *blake3::hash(bytes).as_bytes().first_chunk().expect("a BLAKE3 hash has 32 bytes")
}

fn damaged(message: String) -> Box<Diagnostic> {
    Diagnostic::new("frame-pack", Fault::Input, format!("the frame pack is not usable: {message}"))
}

#[cfg(test)]
mod tests;
