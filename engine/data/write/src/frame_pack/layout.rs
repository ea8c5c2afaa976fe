//! The layout of a frame pack: marks, sections, and the parts that each frame has.

use super::header::PackHeader;
use cosfly_domain::Channel;
use cosfly_domain::channels::Element;

pub const MAGIC: &[u8; 8] = b"COSFLYFP";
pub const END_MAGIC: &[u8; 8] = b"COSFLYFE";
/// Raised whenever older readers would misread newer packs.
pub const VERSION: u32 = 3;
pub const ENTRY_BYTES: usize = 20;
pub const FOOTER_BYTES: usize = 32;
pub const MAX_FRAMES: u64 = 1 << 24;
/// Place of one part of one frame, and size and check of a chunk before compression.
#[derive(Clone, Copy, Debug, Default)]
pub struct Section {
    pub offset: u64,
    pub bytes: u64,
    pub crc: u32,
    pub plain_bytes: u32,
    pub plain_crc: u32,
}

/// The first eight bytes of the BLAKE3 hash.
pub fn check_of(bytes: &[u8]) -> [u8; 8] {
    *blake3::hash(bytes).as_bytes().first_chunk().expect("a BLAKE3 hash has 32 bytes")
}

/// A part of a frame; each has a section of the index.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// A channel as an image file.
    File(&'static Channel),
    /// Raw channels of one chunk, with their numbers in the log.
    Chunk(Vec<(u16, &'static Channel)>),
    /// The preview of a channel; empty where previews are switched off.
    Preview(&'static Channel),
}

/// The parts of each frame, in the order of the index: image files, chunks, previews.
pub fn parts(header: &PackHeader) -> Vec<Part> {
    let channels = || header.channels.iter();
    let is_file = |channel: &&Channel| channel.element() == Element::Colour;
    let raw: Vec<(u16, &'static Channel)> = (1..).zip(channels().filter(|channel| !is_file(channel))).collect();
    // Readers of labels mostly read ids, too: both share a chunk.
    let share =
        |a: &(u16, &Channel), b: &(u16, &Channel)| [a.1.element(), b.1.element()] == [Element::Label, Element::Id];
    let files = channels().filter(is_file).map(Part::File);
    let chunks = raw.chunk_by(share).map(|chunk| Part::Chunk(chunk.to_vec()));
    let previews = channels().filter(|channel| channel.has_previews()).map(Part::Preview);
    files.chain(chunks).chain(previews).collect()
}
