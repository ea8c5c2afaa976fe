//! Reads a frame pack, one frame at a time; truncated and damaged packs are refused.

use super::image_record::{ChunkRecords, depth_records, id_records};
use super::{
    END_MAGIC, ENTRY_BYTES, FOOTER_BYTES, MAGIC, MAX_FRAMES, PackHeader, SECTIONS, Section, VERSION, check_of, damaged,
};
use crate::record::PreviewStrip;
use cosfly_diagnose::{Diagnostic, Result};
use std::io::{Read, Seek, SeekFrom};

/// All images of one frame as they are stored in a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PackedFrame {
    /// A JPEG or PNG file, as the header's encoding says.
    pub rgb_file: Vec<u8>,
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
    pub stored: Vec<u8>,
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
    pub rgb_jpeg: Vec<u8>,
    /// JPEG file, 320 pixels wide, logarithmic colours.
    pub depth_jpeg: Vec<u8>,
    /// PNG file, 320 pixels wide, index = label id, palette = CARLA's colours.
    pub semantic_png: Vec<u8>,
}

/// Reads one pack.
pub struct FramePackReader<R: Read + Seek> {
    input: R,
    header: PackHeader,
    sections: Vec<[Section; SECTIONS]>,
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
        Ok(Self { input, header, sections })
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
        let previews = if self.header.encoding.previews {
            Some(Previews {
                rgb_jpeg: self.section(frame, 3)?,
                depth_jpeg: self.section(frame, 4)?,
                semantic_png: self.section(frame, 5)?,
            })
        } else {
            None
        };
        Ok(PackedFrame {
            rgb_file: self.section(frame, 0)?,
            depth: self.chunk(frame, 1, &depth_records(&self.header, frame))?,
            ids: self.chunk(frame, 2, &id_records(&self.header, frame))?,
            previews,
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
        let depth_bytes = unpacked(&self.chunk(frame, 1, &depth)?, frame)?;
        let id_bytes = unpacked(&self.chunk(frame, 2, &ids)?, frame)?;
        let (semantic, instance) = id_bytes.split_at(ids.records[0].len());
        Ok(RawPixels {
            depth_le: depth_bytes[depth.records[0].pixels()].to_vec(),
            semantic: semantic[ids.records[0].pixels()].to_vec(),
            instance_le: instance[ids.records[1].pixels()].to_vec(),
        })
    }

    /// Section `number`, which holds `records`.
    fn chunk<const N: usize>(&mut self, frame: usize, number: usize, records: &ChunkRecords<N>) -> Result<PackedChunk> {
        let stored = self.section(frame, number)?;
        let Section { plain_bytes, plain_crc, .. } = self.sections[frame][number];
        let (plain_bytes, expected) = (u64::from(plain_bytes), records.len());
        if plain_bytes != expected as u64 {
            return Err(damaged(format!("frame {frame}, section {number}: {plain_bytes} bytes, not {expected}")));
        }
        Ok(PackedChunk { stored, plain_bytes, plain_crc, messages: records.messages.clone() })
    }

    fn section(&mut self, frame: usize, number: usize) -> Result<Vec<u8>> {
        let section = self
            .sections
            .get(frame)
            .ok_or_else(|| damaged(format!("it has {} frames, no frame {frame}", self.sections.len())))?[number];
        let bytes = read_at(&mut self.input, section.offset, section.bytes as usize)?;
        if check_of(&bytes) != section.check {
            return Err(damaged(format!("frame {frame}, section {number} does not match its check")));
        }
        Ok(bytes)
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
    let number = |at: usize| u32::from_le_bytes(start[at..at + 4].try_into().expect("four bytes"));
    if number(8) != VERSION {
        return Err(damaged(format!("it has version {}; this cosfly reads version {VERSION}", number(8))));
    }
    let data_start = 16 + u64::from(number(12));
    if data_start > length {
        return Err(damaged(format!("it ends after {length} bytes, within its header")));
    }
    Ok((read_at(input, 16, number(12) as usize)?, data_start))
}

fn read_index(index: &[u8], data_start: u64, data_end: u64) -> Result<Vec<[Section; SECTIONS]>> {
    let mut sections = vec![];
    for frame in index.chunks_exact(SECTIONS * ENTRY_BYTES) {
        let mut row = [Section::default(); SECTIONS];
        for (section, entry) in row.iter_mut().zip(frame.chunks_exact(ENTRY_BYTES)) {
            *section = Section {
                offset: u64_at(entry, 0),
                bytes: u64_at(entry, 8),
                check: u64_at(entry, 16).to_le_bytes(),
                plain_bytes: u64_at(entry, 24) as u32,
                plain_crc: (u64_at(entry, 24) >> 32) as u32,
            };
            let absent = section.bytes == 0 && section.offset == 0;
            let inside = section.offset >= data_start
                && section.offset.checked_add(section.bytes).is_some_and(|end| end <= data_end);
            if !absent && !inside {
                return Err(damaged(format!("frame {} lies outside of it", sections.len())));
            }
        }
        sections.push(row);
    }
    Ok(sections)
}

fn u64_at(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight bytes"))
}

/// `bytes` bytes from `offset`; both were checked against the length of the input.
fn read_at(input: &mut (impl Read + Seek), offset: u64, bytes: usize) -> Result<Vec<u8>> {
    let mut buffer = vec![0; bytes];
    input.seek(SeekFrom::Start(offset)).map_err(read_error)?;
    input.read_exact(&mut buffer).map_err(read_error)?;
    Ok(buffer)
}

fn read_error(error: std::io::Error) -> Box<Diagnostic> {
    Diagnostic::io("read a frame pack", &error)
}
