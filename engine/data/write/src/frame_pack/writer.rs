//! Writes a frame pack, one frame at a time, with nothing but the index kept in memory.

use super::header::PackHeader;
use super::image_record::{length_of, records_of};
use super::layout::{END_MAGIC, ENTRY_BYTES, MAGIC, Part, Section, VERSION, check_of, parts};
use super::pixels;
use cosfly_channel_pictures::previews::SmallImages;
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_domain::{Channel, FrameImages};
use cosfly_images::jpeg::Chroma;
use cosfly_images::rgb;
use cosfly_schema::config::{JpegChroma, RgbEncoding};
use std::io::Write;

/// Level of all zstd sections: higher ones take longer and gain little on rendered depth.
const ZSTD_LEVEL: i32 = 1;
/// Twice the level's own hash table still fits the nearest cache: depth gets an eighth smaller in the same time. Four
/// times as much would save a twentieth more and take a tenth longer.
const ZSTD_HASH_LOG: u32 = 14;

/// Writes one pack. Call [`Self::frame`] per frame and [`Self::finish`] at the end; a pack without its end
/// is refused by the reader.
pub struct FramePackWriter<W: Write> {
    output: W,
    position: u64,
    header: PackHeader,
    header_bytes: Vec<u8>,
    parts: Vec<Part>,
    /// One for each part of each frame.
    sections: Vec<Section>,
    compressor: zstd::bulk::Compressor<'static>,
    /// Records of the last chunk, the same compressed, and the last image file; kept from frame to frame.
    plain: Vec<u8>,
    stored: Vec<u8>,
    file: Vec<u8>,
    small: SmallImages,
}

impl<W: Write> FramePackWriter<W> {
    /// Begins a pack of images as `header` says.
    pub fn new(output: W, header: &PackHeader) -> Result<Self> {
        header.check()?;
        let header_bytes = serde_json::to_vec(header).expect("a pack header is plain JSON");
        let mut writer = Self {
            output,
            position: 0,
            header: header.clone(),
            header_bytes,
            parts: parts(header),
            sections: vec![],
            compressor: chunk_compressor()?,
            plain: vec![],
            stored: vec![],
            file: vec![],
            small: SmallImages::default(),
        };
        let mut start = Vec::from(MAGIC);
        start.extend_from_slice(&VERSION.to_le_bytes());
        start.extend_from_slice(&(writer.header_bytes.len() as u32).to_le_bytes());
        start.extend_from_slice(&writer.header_bytes);
        writer.put(&start)?;
        Ok(writer)
    }

    /// Encodes and appends one frame. Image sizes, depths (no NaN, not negative) and instance ids must fit the
    /// header.
    pub fn frame(&mut self, images: &FrameImages) -> Result<()> {
        self.check_images(images)?;
        for part in 0..self.parts.len() {
            let section = match self.parts[part].clone() {
                Part::File(_) => self.colour_section(images)?,
                Part::Chunk(channels) => self.chunk_section(&channels, images)?,
                Part::Preview(channel) if self.header.encoding.previews => {
                    self.file_section(|small, file| small.draw(channel, images, file))?
                }
                // No bytes: every part has its place in the index.
                Part::Preview(_) => Section::default(),
            };
            self.sections.push(section);
        }
        Ok(())
    }

    /// Writes the index and gives the output back.
    pub fn finish(mut self) -> Result<W> {
        let index_offset = self.position;
        let mut index = Vec::with_capacity(self.sections.len() * ENTRY_BYTES);
        for section in &self.sections {
            index.extend_from_slice(&section.bytes.to_le_bytes());
            index.extend_from_slice(&section.crc.to_le_bytes());
            index.extend_from_slice(&section.plain_bytes.to_le_bytes());
            index.extend_from_slice(&section.plain_crc.to_le_bytes());
        }
        let check = check_of(&[&self.header_bytes[..], &index].concat());
        index.extend_from_slice(&index_offset.to_le_bytes());
        index.extend_from_slice(&(self.frames() as u64).to_le_bytes());
        index.extend_from_slice(&check);
        index.extend_from_slice(END_MAGIC);
        self.put(&index)?;
        self.output.flush().map_err(write_error)?;
        Ok(self.output)
    }

    fn check_images(&self, images: &FrameImages) -> Result<()> {
        let pixels = self.header.pixels();
        if (images.width, images.height) != (self.header.width, self.header.height) {
            return self.refuse(format!(
                "images of {} x {} pixels; the pack has {} x {}",
                images.width, images.height, self.header.width, self.header.height
            ));
        }
        let on_request = |channel: &&Channel| channel.is_on_request();
        let mut asked_for = self.header.channels.iter().filter(on_request);
        let has = |channel: &Channel| {
            let bytes = channel.bytes_on_request() * pixels;
            images.on_request.iter().any(|image| image.channel == channel && image.bytes.len() == bytes)
        };
        if let Some(missing) = asked_for.find(|channel| !has(channel)) {
            return self.refuse(format!(
                "channel `{}` does not hold {pixels}",
                missing.name,
                pixels = counted(pixels, "pixel")
            ));
        }
        let lengths = [images.rgb.len() / 3, images.depth_m.len(), images.semantic.len(), images.instance.len()];
        if lengths != [pixels; 4] || images.rgb.len() != 3 * pixels {
            return self.refuse(format!("channels hold {lengths:?} pixels; all must hold {pixels}"));
        }
        Ok(())
    }

    /// Frames that are complete; within a frame, its number.
    fn frames(&self) -> usize {
        self.sections.len() / self.parts.len()
    }

    fn refuse<T>(&self, message: String) -> Result<T> {
        let frame = self.frames();
        Err(Diagnostic::new("frame-images", Fault::Bug, format!("frame {frame}: {message}")))
    }

    /// The chunk of some raw channels.
    fn chunk_section(&mut self, channels: &[(u16, &'static Channel)], images: &FrameImages) -> Result<Section> {
        let records = records_of(&self.header, channels, self.frames());
        let mut plain = core::mem::take(&mut self.plain);
        plain.resize(length_of(&records), 0);
        let (mut left, mut crc) = (&mut plain[..], crc32fast::Hasher::new());
        for record in &records {
            let (bytes, rest) = left.split_at_mut(record.len());
            match pixels::write(record, bytes, images, &self.header) {
                Ok(of_record) => crc.combine(&of_record),
                Err(message) => return self.refuse(message),
            }
            left = rest;
        }
        let section = self.compressed_section(&plain, crc.finalize());
        self.plain = plain;
        section
    }

    /// Compresses and appends the records of a chunk; `plain_crc` is their CRC-32.
    fn compressed_section(&mut self, plain: &[u8], plain_crc: u32) -> Result<Section> {
        let mut stored = core::mem::take(&mut self.stored);
        stored.clear();
        stored.reserve(zstd::zstd_safe::compress_bound(plain.len()));
        self.compressor.compress_to_buffer(plain, &mut stored).map_err(write_error)?;
        let section = self.section(&stored)?;
        self.stored = stored;
        Ok(Section { plain_bytes: plain.len() as u32, plain_crc, ..section })
    }

    /// The colour image as a file.
    fn colour_section(&mut self, images: &FrameImages) -> Result<Section> {
        let FrameImages { width, height, rgb: pixels, .. } = images;
        let encoding = self.header.encoding;
        self.file_section(|_, file| match encoding.rgb {
            RgbEncoding::Jpeg => {
                let chroma = match encoding.jpeg_chroma {
                    JpegChroma::Full => Chroma::Full,
                    JpegChroma::Half => Chroma::Half,
                };
                rgb::jpeg_with(pixels, *width, *height, encoding.jpeg_quality, chroma, file)
            }
            RgbEncoding::Png => rgb::png(pixels, *width, *height, file),
        })
    }

    /// Encodes and appends an image file.
    fn file_section(&mut self, encode: impl FnOnce(&mut SmallImages, &mut Vec<u8>) -> Result<()>) -> Result<Section> {
        let mut file = core::mem::take(&mut self.file);
        encode(&mut self.small, &mut file)?;
        let section = self.section(&file)?;
        self.file = file;
        Ok(section)
    }

    fn section(&mut self, bytes: &[u8]) -> Result<Section> {
        let section = Section {
            offset: self.position,
            bytes: bytes.len() as u64,
            crc: crc32fast::hash(bytes),
            ..Section::default()
        };
        self.put(bytes)?;
        Ok(section)
    }

    fn put(&mut self, bytes: &[u8]) -> Result<()> {
        self.output.write_all(bytes).map_err(write_error)?;
        self.position += bytes.len() as u64;
        Ok(())
    }
}

/// The compressor of raw images.
pub fn chunk_compressor() -> Result<zstd::bulk::Compressor<'static>> {
    let mut compressor = zstd::bulk::Compressor::new(ZSTD_LEVEL).map_err(write_error)?;
    compressor.set_parameter(zstd::zstd_safe::CParameter::HashLog(ZSTD_HASH_LOG)).map_err(write_error)?;
    Ok(compressor)
}

fn write_error(error: std::io::Error) -> Box<Diagnostic> {
    Diagnostic::io("write a frame pack", &error)
}
