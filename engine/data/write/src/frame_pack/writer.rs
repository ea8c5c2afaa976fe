//! Writes a frame pack, one frame at a time, with nothing but the index kept in memory.

use super::image_record::{depth_records, id_records};
use super::{END_MAGIC, InstanceFormat, MAGIC, PackHeader, SECTIONS, Section, VERSION, check_of};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_frames::simd::Level;
use cosfly_images::previews::SmallImages;
use cosfly_images::{depth, ids, rgb};
use cosfly_render::FrameImages;
use cosfly_schema::config::{DepthEncoding, RgbEncoding};
use std::io::Write;

/// Level of all zstd sections: higher ones take longer and gain little on rendered depth.
const ZSTD_LEVEL: i32 = 1;
/// Twice the level's own hash table still fits the nearest cache: depth gets an eighth smaller in the same time. Four
/// times as much would save a twentieth more and take a tenth longer.
const ZSTD_HASH_LOG: u32 = 14;
/// Pixels that are converted and checked together, while they are in the nearest caches.
const PIECE_PIXELS: usize = 1 << 13;

/// Writes one pack. Call [`Self::frame`] per frame and [`Self::finish`] at the end; a pack without its end
/// is refused by the reader.
pub struct FramePackWriter<W: Write> {
    output: W,
    position: u64,
    header: PackHeader,
    header_bytes: Vec<u8>,
    sections: Vec<[Section; SECTIONS]>,
    compressor: zstd::bulk::Compressor<'static>,
    /// Records of both chunks, the last one compressed, and the last image file; kept from frame to frame.
    depth_records: Vec<u8>,
    id_records: Vec<u8>,
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
            sections: vec![],
            compressor: chunk_compressor()?,
            depth_records: vec![],
            id_records: vec![],
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
        let encoding = self.header.encoding;
        let (width, height) = (images.width, images.height);
        let rgb = |_: &mut SmallImages, file: &mut Vec<u8>| match encoding.rgb {
            RgbEncoding::Jpeg => rgb::jpeg(&images.rgb, width, height, encoding.jpeg_quality, file),
            RgbEncoding::Png => rgb::png(&images.rgb, width, height, file),
        };
        let mut sections = [Section::default(); SECTIONS];
        sections[0] = self.file_section(rgb)?;
        sections[1] = self.depth_section(images)?;
        sections[2] = self.ids_section(images)?;
        if encoding.previews {
            sections[3] = self.file_section(|small, file| small.rgb(images, file))?;
            sections[4] = self.file_section(|small, file| small.depth(images, file))?;
            sections[5] = self.file_section(|small, file| small.semantic(images, file))?;
        }
        self.sections.push(sections);
        Ok(())
    }

    /// Writes the index and gives the output back.
    pub fn finish(mut self) -> Result<W> {
        let index_offset = self.position;
        let mut index = Vec::with_capacity(self.sections.len() * SECTIONS * super::ENTRY_BYTES);
        for section in self.sections.iter().flatten() {
            index.extend_from_slice(&section.bytes.to_le_bytes());
            index.extend_from_slice(&section.crc.to_le_bytes());
            index.extend_from_slice(&section.plain_bytes.to_le_bytes());
            index.extend_from_slice(&section.plain_crc.to_le_bytes());
        }
        let check = check_of(&[&self.header_bytes[..], &index].concat());
        index.extend_from_slice(&index_offset.to_le_bytes());
        index.extend_from_slice(&(self.sections.len() as u64).to_le_bytes());
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
        let lengths = [images.rgb.len() / 3, images.depth_m.len(), images.semantic.len(), images.instance.len()];
        if lengths != [pixels; 4] || images.rgb.len() != 3 * pixels {
            return self.refuse(format!("channels hold {lengths:?} pixels; all must hold {pixels}"));
        }
        Ok(())
    }

    fn refuse<T>(&self, message: String) -> Result<T> {
        let frame = self.sections.len();
        Err(Diagnostic::new("frame-images", Fault::Bug, format!("frame {frame}: {message}")))
    }

    fn depth_section(&mut self, images: &FrameImages) -> Result<Section> {
        let chunk = depth_records(&self.header, self.sections.len());
        let mut plain = core::mem::take(&mut self.depth_records);
        plain.resize(chunk.len(), 0);
        chunk.records[0].frame_of(&mut plain);
        let to_bytes = match self.header.encoding.depth {
            DepthEncoding::Grid => depth::grid_bytes,
            DepthEncoding::Lossless => depth::lossless_bytes,
        };
        let mut all_are_depths = true;
        let crc = crc_while_written(&mut plain, chunk.records[0].pixels(), &images.depth_m, 4, |depths, bytes| {
            all_are_depths &= to_bytes(Level::best(), depths, bytes);
        });
        if !all_are_depths {
            let at = images.depth_m.iter().position(|depth| depth.is_nan() || *depth < 0.0).unwrap_or(0);
            return self.refuse(format!("the depth of pixel {at} is `{}`; it must be 0 m or more", images.depth_m[at]));
        }
        let section = self.compressed_section(&plain, crc.finalize());
        self.depth_records = plain;
        section
    }

    fn ids_section(&mut self, images: &FrameImages) -> Result<Section> {
        let chunk = id_records(&self.header, self.sections.len());
        let mut plain = core::mem::take(&mut self.id_records);
        plain.resize(chunk.len(), 0);
        let (semantic, instance) = plain.split_at_mut(chunk.records[0].len());
        chunk.records[0].frame_of(semantic);
        let mut crc = crc_while_written(semantic, chunk.records[0].pixels(), &images.semantic, 1, |ids, bytes| {
            bytes.copy_from_slice(ids);
        });
        chunk.records[1].frame_of(instance);
        let (format, mut seen) = (self.header.instance, 0);
        let id_bytes = format.bytes();
        let rest =
            crc_while_written(
                instance,
                chunk.records[1].pixels(),
                &images.instance,
                id_bytes,
                |ids, bytes| match format {
                    InstanceFormat::U16 => seen |= ids::u16_bytes(Level::best(), ids, bytes),
                    InstanceFormat::U32 => ids::u32_bytes(Level::best(), ids, bytes),
                },
            );
        if seen > u32::from(u16::MAX) {
            let largest = images.instance.iter().max().copied().unwrap_or(0);
            return self.refuse(format!("instance id {largest} does not fit the pack's 16 bits"));
        }
        crc.combine(&rest);
        let section = self.compressed_section(&plain, crc.finalize());
        self.id_records = plain;
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

/// Writes the pixels of `record` piece by piece, `pixel_bytes` each; gives the CRC-32 of the whole record.
fn crc_while_written<T>(
    record: &mut [u8],
    place: core::ops::Range<usize>,
    pixels: &[T],
    pixel_bytes: usize,
    mut write: impl FnMut(&[T], &mut [u8]),
) -> crc32fast::Hasher {
    let mut crc = crc32fast::Hasher::new();
    crc.update(&record[..place.start]);
    let pieces = record[place.clone()].chunks_mut(pixel_bytes * PIECE_PIXELS);
    for (pixels, bytes) in pixels.chunks(PIECE_PIXELS).zip(pieces) {
        write(pixels, bytes);
        crc.update(bytes);
    }
    crc.update(&record[place.end..]);
    crc
}

/// The compressor of depth and ids.
pub fn chunk_compressor() -> Result<zstd::bulk::Compressor<'static>> {
    let mut compressor = zstd::bulk::Compressor::new(ZSTD_LEVEL).map_err(write_error)?;
    compressor.set_parameter(zstd::zstd_safe::CParameter::HashLog(ZSTD_HASH_LOG)).map_err(write_error)?;
    Ok(compressor)
}

fn write_error(error: std::io::Error) -> Box<Diagnostic> {
    Diagnostic::io("write a frame pack", &error)
}
