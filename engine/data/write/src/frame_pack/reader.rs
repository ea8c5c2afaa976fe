//! Reads a frame pack, one frame at a time; truncated and damaged packs are refused.

use super::header::{PackHeader, damaged};
use super::image_record::{ImageRecord, length_of, messages_of, records_of};
use super::layout::{END_MAGIC, ENTRY_BYTES, FOOTER_BYTES, MAGIC, MAX_FRAMES, Part, Section, VERSION, check_of, parts};
use cosfly_diagnose::{Diagnostic, Result, counted};
use cosfly_domain::Channel;
use cosfly_domain::channels::rgb;
use cosfly_schema::record::PreviewStrip;
use foxglove::bytes::Bytes;
use std::io::{Read, Seek, SeekFrom};

/// All images of one frame as they are stored in a log. Parts share one buffer, which the reader uses again once they are
/// dropped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PackedFrame {
    /// JPEG or PNG files, as the header's encoding says.
    pub files: Vec<(&'static Channel, Bytes)>,
    /// Raw images.
    pub chunks: Vec<PackedChunk>,
    /// Small pictures for viewers, 320 pixels wide: JPEG or PNG files; none where previews are switched off.
    pub previews: Vec<(&'static Channel, Bytes)>,
}

/// Message records of a log, compressed with zstd.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PackedChunk {
    /// Bytes as they are stored.
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

/// Reads one pack.
pub struct FramePackReader<R: Read + Seek> {
    input: R,
    header: PackHeader,
    parts: Vec<Part>,
    /// One for each part of each frame.
    sections: Vec<Section>,
    /// The last frame.
    buffer: Bytes,
}

impl<R: Read + Seek> FramePackReader<R> {
    /// Reads and checks header and index. Nothing is allocated by a size that the file cannot hold.
    pub fn new(mut input: R) -> Result<Self> {
        let length = input.seek(SeekFrom::End(0)).map_err(read_error)?;
        let (header_bytes, data_start) = read_header(&mut input, length)?;
        if length < data_start + FOOTER_BYTES as u64 {
            return Err(damaged(format!(
                "it ends after {length}, within its first frame",
                length = counted(length, "byte")
            )));
        }
        let footer_at = length - FOOTER_BYTES as u64;
        let footer: [u8; FOOTER_BYTES] =
            read_at(&mut input, footer_at, FOOTER_BYTES)?.try_into().expect("exact length");
        if footer[24..] != END_MAGIC[..] {
            return Err(damaged("it was cut short: its end mark is missing".into()));
        }
        let (index_offset, frames) = (u64_at(&footer, 0), u64_at(&footer, 8));
        let header: PackHeader =
            serde_json::from_slice(&header_bytes).map_err(|error| damaged(format!("its header: {error}")))?;
        header.check()?;
        let parts = parts(&header);
        let index_bytes = frames.min(MAX_FRAMES + 1) * (parts.len() * ENTRY_BYTES) as u64;
        if frames > MAX_FRAMES || index_offset < data_start || index_offset.checked_add(index_bytes) != Some(footer_at)
        {
            return Err(damaged(format!(
                "its index of {frames} frames does not fit its {length}",
                length = counted(length, "byte")
            )));
        }
        let index = read_at(&mut input, index_offset, index_bytes as usize)?;
        if check_of(&[&header_bytes[..], &index].concat()) != footer[16..24] {
            return Err(damaged("its header or index does not match its check".into()));
        }
        let sections = read_index(&index, data_start, index_offset)?;
        Ok(Self { input, header, parts, sections, buffer: Bytes::new() })
    }

    /// Parts that all frames share.
    pub fn header(&self) -> &PackHeader {
        &self.header
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        self.sections.len() / self.parts.len()
    }

    /// Whether there is no frame.
    pub fn is_empty(&self) -> bool {
        self.sections.is_empty()
    }

    /// All images of frame `frame`.
    ///
    /// # Errors
    /// No such frame, or damage.
    pub fn frame(&mut self, frame: usize) -> Result<PackedFrame> {
        let row = self.row(frame)?.to_vec();
        let bytes: u64 = row.iter().map(|section| section.bytes).sum();
        let mut buffer = core::mem::take(&mut self.buffer).try_into_mut().unwrap_or_default();
        buffer.resize(bytes as usize, 0);
        fill_at(&mut self.input, row[0].offset, &mut buffer)?;
        self.buffer = buffer.freeze();
        let mut left = self.buffer.clone();
        let mut packed = PackedFrame { files: vec![], chunks: vec![], previews: vec![] };
        for (number, (part, section)) in self.parts.iter().zip(&row).enumerate() {
            let bytes = left.split_to(section.bytes as usize);
            section.check(&bytes, frame, number)?;
            match part {
                Part::File(channel) => packed.files.push((*channel, bytes)),
                Part::Chunk(channels) => {
                    let records = records_of(&self.header, channels, frame);
                    packed.chunks.push(section.chunk(bytes, &records, frame)?);
                }
                Part::Preview(channel) if self.header.encoding.previews => packed.previews.push((*channel, bytes)),
                Part::Preview(_) => {}
            }
        }
        Ok(packed)
    }

    /// The colour previews of all frames; empty when previews are off.
    ///
    /// # Errors
    /// Damage.
    pub fn preview_strip(&mut self) -> Result<PreviewStrip> {
        let is_colour = |part: &Part| *part == Part::Preview(&rgb::CHANNEL);
        let Some(part) = self.parts.iter().position(is_colour).filter(|_| self.header.encoding.previews) else {
            return Ok(PreviewStrip::default());
        };
        Ok(PreviewStrip { jpegs: (0..self.len()).map(|frame| self.section(frame, part)).collect::<Result<_>>()? })
    }

    /// The pixels of a frame's raw image of `channel`, decompressed: row-major, little-endian, in the format that the
    /// header gives the channel. Empty for channels that the pack does not have as raw images.
    ///
    /// # Errors
    /// No such frame, or damage.
    pub fn raw_pixels(&mut self, channel: &Channel, frame: usize) -> Result<Vec<u8>> {
        let packed = self.frame(frame)?;
        let chunks = self.parts.iter().filter_map(|part| match part {
            Part::Chunk(channels) => Some(channels),
            _ => None,
        });
        for (channels, chunk) in chunks.zip(&packed.chunks) {
            let records = records_of(&self.header, channels, frame);
            let Some(at) = records.iter().position(|record| record.channel == channel) else { continue };
            let begin = length_of(&records[..at]);
            let place = records[at].pixels();
            return Ok(unpacked(chunk, frame)?[begin + place.start..begin + place.end].to_vec());
        }
        Ok(vec![])
    }

    /// The sections of a frame.
    fn row(&self, frame: usize) -> Result<&[Section]> {
        let parts = self.parts.len();
        let missing = || damaged(format!("it has {}, no frame {frame}", counted(self.len(), "frame")));
        self.sections.chunks_exact(parts).nth(frame).ok_or_else(missing)
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
    fn chunk(&self, stored: Bytes, records: &[ImageRecord], frame: usize) -> Result<PackedChunk> {
        let (plain_bytes, expected) = (u64::from(self.plain_bytes), length_of(records));
        if plain_bytes != expected as u64 {
            return Err(damaged(format!("frame {frame}: images of {plain_bytes} bytes, not {expected}")));
        }
        let messages = messages_of(records);
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
        return Err(damaged(format!("it ends after {length}", length = counted(length, "byte"))));
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
        return Err(damaged(format!("it ends after {length}, within its header", length = counted(length, "byte"))));
    }
    Ok((read_at(input, 16, header_bytes as usize)?, data_start))
}

fn read_index(index: &[u8], data_start: u64, data_end: u64) -> Result<Vec<Section>> {
    let mut sections = vec![];
    let mut offset = data_start;
    for entry in index.chunks_exact(ENTRY_BYTES) {
        let bytes = u64_at(entry, 0);
        let [crc, plain_bytes, plain_crc] = [8, 12, 16].map(|at| u32_at(entry, at));
        let end = offset.checked_add(bytes).filter(|end| *end <= data_end);
        let end = end.ok_or_else(|| damaged(format!("section {} lies outside of it", sections.len())))?;
        sections.push(Section { offset, bytes, crc, plain_bytes, plain_crc });
        offset = end;
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
