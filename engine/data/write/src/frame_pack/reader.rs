//! Reads a frame pack, one frame at a time; truncated and damaged packs are refused.

use super::image_record::{ChunkRecords, depth_records, id_records};
use super::{
    END_MAGIC, ENTRY_BYTES, FOOTER_BYTES, MAGIC, MAX_FRAMES, PackHeader, SECTIONS, Section, VERSION, check_of, damaged,
};
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_schema::record::PreviewStrip;
use foxglove::bytes::Bytes;
use std::io::{Read, Seek, SeekFrom};

/// All images of one frame as they are stored in a log. Parts share one buffer, which the reader uses again once they are
/// dropped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PackedFrame {
    /// A JPEG or PNG file, as the header's encoding says.
    pub rgb_file: Bytes,
    /// The depth image.
    pub depth: PackedChunk,
    /// Both id images.
    pub ids: PackedChunk,
    /// Previews, unless they are switched off.
    pub previews: Option<Previews>,
}

/// Message records of a log, compressed with zstd.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PackedChunk {
    /// As they are stored.
    pub stored: Bytes,
    /// CRC-32 of them.
    pub stored_crc: u32,
    /// Bytes before compression.
    pub plain_bytes: u64,
    /// CRC-32 of them.
    pub plain_crc: u32,
    /// Channel and offset (before compression) of each message.
    pub messages: Vec<(u16, u64)>,
}

/// Pixels of a frame's raw images.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RawPixels {
    /// Row-major f32, little-endian, metres along the optical axis; infinite for sky.
    pub depth_le: Vec<u8>,
    /// Row-major CARLA label ids.
    pub semantic: Vec<u8>,
    /// Row-major u16 or u32, little-endian, as the header's instance format says.
    pub instance_le: Vec<u8>,
}

/// Small pictures of a frame for viewers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Previews {
    /// JPEG file, 320 pixels wide.
    pub rgb_jpeg: Bytes,
    /// JPEG file, 320 pixels wide, logarithmic colours.
    pub depth_jpeg: Bytes,
    /// PNG file, 320 pixels wide, index = label id, palette = CARLA's colours.
    pub semantic_png: Bytes,
}

/// Reads one pack.
pub struct FramePackReader<R: Read + Seek> {
    input: R,
    header: PackHeader,
    sections: Vec<[Section; SECTIONS]>,
    /// The last frame.
    buffer: Bytes,
}

impl<R: Read + Seek> FramePackReader<R> {
    /// Reads and checks header and index. Nothing is allocated by a size that the file cannot hold.
    pub fn new(mut input: R) -> Result<Self> {
        let length = input.seek(SeekFrom::End(0)).map_err(read_error)?;
        let (header_bytes, data_start) = read_header(&mut input, length)?;
        if length < data_start + FOOTER_BYTES as u64 {
            return Err(damaged(format!("it ends after {length} bytes, within its first frame")));
        }
        let footer_at = length - FOOTER_BYTES as u64;
        let footer: [u8; FOOTER_BYTES] =
            read_at(&mut input, footer_at, FOOTER_BYTES)?.try_into().expect("exact length");
        if footer[24..] != END_MAGIC[..] {
            return Err(damaged("it was cut short: its end mark is missing".into()));
        }
        let (index_offset, frames) = (u64_at(&footer, 0), u64_at(&footer, 8));
        let index_bytes = frames.min(MAX_FRAMES + 1) * (SECTIONS * ENTRY_BYTES) as u64;
        if frames > MAX_FRAMES || index_offset < data_start || index_offset.checked_add(index_bytes) != Some(footer_at)
        {
            return Err(damaged(format!("its index of {frames} frames does not fit its {length} bytes")));
        }
        let index = read_at(&mut input, index_offset, index_bytes as usize)?;
        if check_of(&[&header_bytes[..], &index].concat()) != footer[16..24] {
            return Err(damaged("its header or index does not match its check".into()));
        }
        let header: PackHeader =
            serde_json::from_slice(&header_bytes).map_err(|error| damaged(format!("its header: {error}")))?;
        header.check()?;
        let sections = read_index(&index, data_start, index_offset)?;
        Ok(Self { input, header, sections, buffer: Bytes::new() })
    }

    /// What all frames share.
    pub fn header(&self) -> &PackHeader {
        &self.header
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        self.sections.len()
    }

    /// Whether there is no frame.
    pub fn is_empty(&self) -> bool {
        self.sections.is_empty()
    }

    /// All images of frame `frame`.
    pub fn frame(&mut self, frame: usize) -> Result<PackedFrame> {
        let row = *self.row(frame)?;
        let bytes: u64 = row.iter().map(|section| section.bytes).sum();
        let mut buffer = core::mem::take(&mut self.buffer).try_into_mut().unwrap_or_default();
        buffer.resize(bytes as usize, 0);
        fill_at(&mut self.input, row[0].offset, &mut buffer)?;
        self.buffer = buffer.freeze();
        let mut left = self.buffer.clone();
        let mut parts = [const { Bytes::new() }; SECTIONS];
        for (number, (part, section)) in parts.iter_mut().zip(&row).enumerate() {
            *part = left.split_to(section.bytes as usize);
            section.check(part, frame, number)?;
        }
        let [rgb_file, depth, ids, rgb_jpeg, depth_jpeg, semantic_png] = parts;
        let previews = self.header.encoding.previews;
        Ok(PackedFrame {
            rgb_file,
            depth: row[1].chunk(depth, &depth_records(&self.header, frame), frame)?,
            ids: row[2].chunk(ids, &id_records(&self.header, frame), frame)?,
            previews: previews.then_some(Previews { rgb_jpeg, depth_jpeg, semantic_png }),
        })
    }

    /// The RGB previews of all frames; empty when previews are off.
    pub fn preview_strip(&mut self) -> Result<PreviewStrip> {
        if !self.header.encoding.previews {
            return Ok(PreviewStrip::default());
        }
        Ok(PreviewStrip { jpegs: (0..self.len()).map(|frame| self.section(frame, 3)).collect::<Result<_>>()? })
    }

    /// The pixels of a frame's raw images, decompressed.
    pub fn raw_pixels(&mut self, frame: usize) -> Result<RawPixels> {
        let (depth, ids) = (depth_records(&self.header, frame), id_records(&self.header, frame));
        let packed = self.frame(frame)?;
        let (depth_bytes, id_bytes) = (unpacked(&packed.depth, frame)?, unpacked(&packed.ids, frame)?);
        let (semantic, instance) = id_bytes.split_at(ids.records[0].len());
        Ok(RawPixels {
            depth_le: depth_bytes[depth.records[0].pixels()].to_vec(),
            semantic: semantic[ids.records[0].pixels()].to_vec(),
            instance_le: instance[ids.records[1].pixels()].to_vec(),
        })
    }

    fn row(&self, frame: usize) -> Result<&[Section; SECTIONS]> {
        let missing = || damaged(format!("it has {} frames, no frame {frame}", self.sections.len()));
        self.sections.get(frame).ok_or_else(missing)
    }

    fn section(&mut self, frame: usize, number: usize) -> Result<Vec<u8>> {
        let section = self.row(frame)?[number];
        let bytes = read_at(&mut self.input, section.offset, section.bytes as usize)?;
        section.check(&bytes, frame, number)?;
        Ok(bytes)
    }
}

impl Section {
    fn check(&self, bytes: &[u8], frame: usize, number: usize) -> Result<()> {
        if crc32fast::hash(bytes) != self.crc {
            return Err(damaged(format!("frame {frame}, section {number} does not match its check")));
        }
        Ok(())
    }

    /// This section, which holds `records`.
    fn chunk<const N: usize>(&self, stored: Bytes, records: &ChunkRecords<N>, frame: usize) -> Result<PackedChunk> {
        let (plain_bytes, expected) = (u64::from(self.plain_bytes), records.len());
        if plain_bytes != expected as u64 {
            return Err(damaged(format!("frame {frame}: images of {plain_bytes} bytes, not {expected}")));
        }
        let messages = records.messages.clone();
        Ok(PackedChunk { stored, stored_crc: self.crc, plain_bytes, plain_crc: self.plain_crc, messages })
    }
}

/// The records of a chunk.
fn unpacked(chunk: &PackedChunk, frame: usize) -> Result<Vec<u8>> {
    let bytes = zstd::bulk::decompress(&chunk.stored, chunk.plain_bytes as usize)
        .map_err(|error| damaged(format!("frame {frame}: {error}")))?;
    if bytes.len() as u64 != chunk.plain_bytes || crc32fast::hash(&bytes) != chunk.plain_crc {
        return Err(damaged(format!("frame {frame}: a chunk is not what its index says")));
    }
    Ok(bytes)
}

/// The header's bytes and where the first frame begins.
fn read_header(input: &mut (impl Read + Seek), length: u64) -> Result<(Vec<u8>, u64)> {
    if length < 16 {
        return Err(damaged(format!("it ends after {length} bytes")));
    }
    let start = read_at(input, 0, 16)?;
    if start[..8] != MAGIC[..] {
        return Err(damaged("these bytes are something else".into()));
    }
    let (version, header_bytes) = (u32_at(&start, 8), u32_at(&start, 12));
    if version != VERSION {
        return Err(damaged(format!("it has version {version}; this cosfly reads version {VERSION}")));
    }
    let data_start = 16 + u64::from(header_bytes);
    if data_start > length {
        return Err(damaged(format!("it ends after {length} bytes, within its header")));
    }
    Ok((read_at(input, 16, header_bytes as usize)?, data_start))
}

fn read_index(index: &[u8], data_start: u64, data_end: u64) -> Result<Vec<[Section; SECTIONS]>> {
    let mut sections = vec![];
    let mut offset = data_start;
    for frame in index.chunks_exact(SECTIONS * ENTRY_BYTES) {
        let mut row = [Section::default(); SECTIONS];
        for (section, entry) in row.iter_mut().zip(frame.chunks_exact(ENTRY_BYTES)) {
            let bytes = u64_at(entry, 0);
            let [crc, plain_bytes, plain_crc] = [8, 12, 16].map(|at| u32_at(entry, at));
            *section = Section { offset, bytes, crc, plain_bytes, plain_crc };
            let end = offset.checked_add(bytes).filter(|end| *end <= data_end);
            offset = end.ok_or_else(|| damaged(format!("frame {} lies outside of it", sections.len())))?;
        }
        sections.push(row);
    }
    if offset != data_end {
        return Err(damaged(format!("its frames end at byte {offset}, its index begins at {data_end}")));
    }
    Ok(sections)
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
}

fn u64_at(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight bytes"))
}

/// `bytes` bytes from `offset`; both were checked against the length of the input.
fn read_at(input: &mut (impl Read + Seek), offset: u64, bytes: usize) -> Result<Vec<u8>> {
    let mut buffer = vec![0; bytes];
    fill_at(input, offset, &mut buffer)?;
    Ok(buffer)
}

fn fill_at(input: &mut (impl Read + Seek), offset: u64, buffer: &mut [u8]) -> Result<()> {
    input.seek(SeekFrom::Start(offset)).map_err(read_error)?;
    input.read_exact(buffer).map_err(read_error)
}

fn read_error(error: std::io::Error) -> Box<Diagnostic> {
    Diagnostic::io("read a frame pack", &error)
}
