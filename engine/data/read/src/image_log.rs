//! Random access to the images of a log: one channel of one frame is read and unpacked, and nothing else.
//!
//! A frame is found through the log's chunk index and its message indexes: two small reads, and one for the image, or
//! for its chunk where that is compressed. Memory per open log: about 100 bytes per chunk.

use super::damage::damaged;
use super::log::summary;
use super::records::RECORD_LIMIT;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::Channel;
use cosfly_domain::channels::Element;
use cosfly_schema::log::{FrameTimes, formats, topic};
use foxglove::messages;
use prost::Message;
use prost::bytes::Bytes;
use std::fs::File;
use std::path::{Path, PathBuf};

const MESSAGE: u8 = 0x05;
const MESSAGE_INDEX: u8 = 0x07;
/// Bytes of a record's opcode and length.
const RECORD_HEADER: usize = 9;
/// Bytes of a message before its data: channel, sequence, time of logging and of publication.
const MESSAGE_HEADER: usize = 22;

/// An open log.
pub struct ImageLog {
    file: File,
    bytes: u64,
    path: PathBuf,
    times: FrameTimes,
    /// Channel numbers of the file by the names of our channels.
    channels: Vec<(&'static str, u16)>,
    /// By first time.
    chunks: Vec<Chunk>,
}

/// A chunk of messages.
struct Chunk {
    first_ns: u64,
    last_ns: u64,
    /// First byte of the messages, compressed or not.
    start: u64,
    stored_bytes: u64,
    bytes: u64,
    is_compressed: bool,
    /// Places of the message indexes of the channels in `ImageLog::channels`.
    indexes: Vec<(u16, u64)>,
}

/// An image as the log stores it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StoredImage {
    /// A whole image file, and its format: `jpeg` or `png`.
    File(Bytes, String),
    /// Row-major little-endian pixels of some bytes each.
    Raw {
        /// Pixels.
        data: Bytes,
        /// Width, pixels.
        width: u32,
        /// Height, pixels.
        height: u32,
        /// Bytes per pixel.
        pixel_bytes: usize,
    },
}

impl ImageLog {
    /// Reads the index of the log at `path`, whose frames are `dt_s` apart.
    ///
    /// # Errors
    /// The file cannot be opened, or is no log with an index.
    pub fn open(path: &Path, times: FrameTimes) -> Result<Self> {
        let (file, summary) = summary(path)?;
        let channel = |number: &u16| topic::channel_of(&summary.channels.get(number)?.topic).map(|it| it.name);
        let mut channels: Vec<_> =
            summary.channels.keys().filter_map(|number| Some((channel(number)?, *number))).collect();
        channels.sort_unstable();
        let is_image = |number: u16| channels.iter().any(|(_, known)| *known == number);
        let chunks = summary.chunk_indexes.iter().map(|index| Chunk {
            first_ns: index.message_start_time,
            last_ns: index.message_end_time,
            // After start, end, size (8 bytes each), CRC (4), the compression's name and the size of the records.
            start: index
                .chunk_start_offset
                .saturating_add((RECORD_HEADER + 8 + 8 + 8 + 4 + 4 + index.compression.len() + 8) as u64),
            stored_bytes: index.compressed_size,
            bytes: index.uncompressed_size,
            is_compressed: !index.compression.is_empty(),
            indexes: index.message_index_offsets.iter().map(|(a, b)| (*a, *b)).filter(|it| is_image(it.0)).collect(),
        });
        let mut chunks: Vec<Chunk> = chunks.filter(|chunk| !chunk.indexes.is_empty()).collect();
        chunks.sort_by_key(|chunk| (chunk.first_ns, chunk.start));
        let bytes =
            file.metadata().map_err(|error| Diagnostic::io(format!("read `{}`", path.display()), &error))?.len();
        Ok(Self { file, bytes, path: path.to_owned(), times, channels, chunks })
    }

    /// Names of the channels with images.
    pub fn channels(&self) -> impl Iterator<Item = &'static str> + '_ {
        self.channels.iter().map(|(name, _)| *name)
    }

    /// The image of `channel` in frame `frame`.
    ///
    /// # Errors
    /// The log has no such channel (`dataset-channel`) or image, or is damaged there.
    pub fn image(&self, channel: &Channel, frame: usize) -> Result<StoredImage> {
        let time = self.times.ns(frame);
        let absent = || damaged(&self.path, "an image is missing", format!("`{}` of frame {frame}", channel.name));
        let (_, number) = self.channels.iter().find(|it| it.0 == channel.name).ok_or_else(|| self.without(channel))?;
        // Chunks before the first one that begins later; those that end earlier do not count.
        let end = self.chunks.partition_point(|chunk| chunk.first_ns <= time);
        for chunk in self.chunks[..end].iter().rev().filter(|chunk| chunk.last_ns >= time) {
            let Some((_, index)) = chunk.indexes.iter().find(|(known, _)| known == number) else { continue };
            if let Some(place) = self.place_in_chunk(*index, time)? {
                return self.unpack(channel, self.message(chunk, place, *number, time)?);
            }
        }
        Err(absent())
    }

    /// The error of a channel that was not filmed.
    fn without(&self, channel: &Channel) -> Box<Diagnostic> {
        let message = format!("`{}` has no channel `{}`", self.path.display(), channel.name);
        let known: Vec<&str> = self.channels().collect();
        Diagnostic::new("dataset-channel", Fault::Recipe, message)
            .hint(format!("it has {}; `channels` of the stage `render` asks for others", known.join(", ")))
    }

    /// Place of the message of a time, from the start of the chunk's messages.
    fn place_in_chunk(&self, index: u64, time: u64) -> Result<Option<u64>> {
        let header = self.read(index, RECORD_HEADER + 6)?;
        let bytes = u32_at(&header, RECORD_HEADER + 2) as usize;
        if header[0] != MESSAGE_INDEX || bytes > RECORD_LIMIT {
            return Err(self.damaged("a message index is not where it should be"));
        }
        let entries = self.read(index + header.len() as u64, bytes)?;
        let entries = entries.as_chunks::<16>().0;
        Ok(entries.iter().find(|entry| u64_at(&entry[..], 0) == time).map(|entry| u64_at(&entry[..], 8)))
    }

    /// Data of the message at `place` of a chunk.
    fn message(&self, chunk: &Chunk, place: u64, number: u16, time: u64) -> Result<Bytes> {
        let wrong = || self.damaged("a message is not where its index says");
        let (messages, at) = if chunk.is_compressed {
            let size = usize::try_from(chunk.bytes).ok().filter(|size| *size <= RECORD_LIMIT).ok_or_else(wrong)?;
            let stored = usize::try_from(chunk.stored_bytes).ok().filter(|size| *size <= RECORD_LIMIT);
            let stored = self.read(chunk.start, stored.ok_or_else(wrong)?)?;
            let unpacked = zstd::bulk::decompress(&stored, size);
            (unpacked.map_err(|error| damaged(&self.path, "a chunk cannot be unpacked", error))?, place)
        } else {
            let start = chunk.start.checked_add(place).ok_or_else(wrong)?;
            let header = self.read(start, RECORD_HEADER)?;
            let size = usize::try_from(u64_at(&header, 1)).ok().filter(|size| *size <= RECORD_LIMIT);
            (self.read(start, RECORD_HEADER + size.ok_or_else(wrong)?)?, 0)
        };
        let at = usize::try_from(at).ok().filter(|at| at.saturating_add(RECORD_HEADER) <= messages.len());
        let at = at.ok_or_else(wrong)?;
        let size = usize::try_from(u64_at(&messages, at + 1)).unwrap_or(usize::MAX);
        let record = at + RECORD_HEADER..at.saturating_add(RECORD_HEADER).saturating_add(size);
        let body = messages.get(record.clone()).filter(|body| body.len() >= MESSAGE_HEADER).ok_or_else(wrong)?;
        let is_wanted = messages[at] == MESSAGE && body[..2] == number.to_le_bytes() && u64_at(body, 6) == time;
        if !is_wanted {
            return Err(wrong());
        }
        Ok(Bytes::from(messages).slice(record.start + MESSAGE_HEADER..record.end))
    }

    fn unpack(&self, channel: &Channel, data: Bytes) -> Result<StoredImage> {
        let unreadable = |error: prost::DecodeError| damaged(&self.path, "an image cannot be read", error);
        if channel.element() == Element::Colour {
            let image = messages::CompressedImage::decode(data).map_err(unreadable)?;
            return Ok(StoredImage::File(image.data, image.format));
        }
        let image = messages::RawImage::decode(data).map_err(unreadable)?;
        let format = formats(channel).iter().find(|format| format.encoding == image.encoding);
        let format = format.ok_or_else(|| self.damaged("an image has an encoding that its channel does not have"))?;
        let (width, height, pixel_bytes) = (image.width, image.height, format.pixel_bytes);
        let expected = (width as usize).checked_mul(height as usize).and_then(|it| it.checked_mul(pixel_bytes));
        if expected != Some(image.data.len()) || image.data.is_empty() {
            return Err(self.damaged("an image does not have the bytes of its size"));
        }
        Ok(StoredImage::Raw { data: image.data, width, height, pixel_bytes })
    }

    fn read(&self, at: u64, bytes: usize) -> Result<Vec<u8>> {
        if at.saturating_add(bytes as u64) > self.bytes {
            return Err(self.damaged("the file ends too early"));
        }
        let mut buffer = vec![0; bytes];
        read_at(&self.file, &mut buffer, at).map_err(|error| match error.kind() {
            std::io::ErrorKind::UnexpectedEof => self.damaged("the file ends too early"),
            _ => Diagnostic::io(format!("read `{}`", self.path.display()), &error),
        })?;
        Ok(buffer)
    }

    fn damaged(&self, what: &str) -> Box<Diagnostic> {
        damaged(&self.path, what, "it was changed, or written incompletely")
    }
}

/// Reads at a place without moving a shared position, so that threads share the file.
#[cfg(unix)]
fn read_at(file: &File, buffer: &mut [u8], at: u64) -> std::io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, buffer, at)
}

/// Reads at a place; the position of the file is not used elsewhere. Windows reads less than asked for at the end of a file alone.
#[cfg(windows)]
fn read_at(file: &File, buffer: &mut [u8], at: u64) -> std::io::Result<()> {
    let read = std::os::windows::fs::FileExt::seek_read(file, buffer, at)?;
    if read == buffer.len() { Ok(()) } else { Err(std::io::ErrorKind::UnexpectedEof.into()) }
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    bytes.get(at..at + 4).and_then(|four| four.try_into().ok()).map_or(0, u32::from_le_bytes)
}

fn u64_at(bytes: &[u8], at: usize) -> u64 {
    bytes.get(at..at + 8).and_then(|eight| eight.try_into().ok()).map_or(0, u64::from_le_bytes)
}
