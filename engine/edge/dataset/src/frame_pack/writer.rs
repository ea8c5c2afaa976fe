//! Writes a frame pack, one frame at a time, with nothing but the index kept in memory.

use super::image_record::{depth_records, id_records};
use super::{END_MAGIC, InstanceFormat, MAGIC, PackHeader, SECTIONS, Section, VERSION, check_of};
use crate::config::{DepthEncoding, RgbEncoding};
use crate::images::{depth, ids, previews, rgb};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_frames::simd::Level;
use cosfly_render::FrameImages;
use std::io::Write;

/// Level of all zstd sections: higher ones take longer and gain little on rendered depth.
const ZSTD_LEVEL: i32 = 1;
/// Twice the level's own hash table: depth gets a seventh smaller in the same time.
const ZSTD_HASH_LOG: u32 = 15;

/// Writes one pack. Call [`Self::frame`] per frame and [`Self::finish`] at the end; a pack without its end
/// is refused by the reader.
pub struct FramePackWriter<W: Write> {
    output: W,
    position: u64,
    header: PackHeader,
    header_bytes: Vec<u8>,
    sections: Vec<[Section; SECTIONS]>,
    compressor: zstd::bulk::Compressor<'static>,
    /// Records of both chunks, and the last one compressed; kept from frame to frame.
    depth_records: Vec<u8>,
    id_records: Vec<u8>,
    stored: Vec<u8>,
}

impl<W: Write> FramePackWriter<W> {
    /// Begins a pack of images as `header` says.
    pub fn new(output: W, header: &PackHeader) -> Result<Self> {
        header.check()?;
        let header_bytes = serde_json::to_vec(header).expect("a pack header is plain JSON");
        let mut compressor = zstd::bulk::Compressor::new(ZSTD_LEVEL).map_err(write_error)?;
        compressor.set_parameter(zstd::zstd_safe::CParameter::HashLog(ZSTD_HASH_LOG)).map_err(write_error)?;
        let mut writer = Self {
            output,
            position: 0,
            header: header.clone(),
            header_bytes,
            sections: vec![],
            compressor,
            depth_records: vec![],
            id_records: vec![],
            stored: vec![],
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
        let rgb_file = match encoding.rgb {
            RgbEncoding::Jpeg => rgb::jpeg(&images.rgb, width, height, encoding.jpeg_quality)?,
            RgbEncoding::Png => rgb::png(&images.rgb, width, height)?,
        };
        let mut sections = [Section::default(); SECTIONS];
        sections[0] = self.section(&rgb_file)?;
        sections[1] = self.depth_section(images)?;
        sections[2] = self.ids_section(images)?;
        if encoding.previews {
            sections[3] = self.section(&previews::rgb(images)?)?;
            sections[4] = self.section(&previews::depth(images)?)?;
            sections[5] = self.section(&previews::semantic(images)?)?;
        }
        self.sections.push(sections);
        Ok(())
    }

    /// Writes the index and gives the output back.
    pub fn finish(mut self) -> Result<W> {
        let index_offset = self.position;
        let mut index = Vec::with_capacity(self.sections.len() * SECTIONS * super::ENTRY_BYTES);
        for section in self.sections.iter().flatten() {
            index.extend_from_slice(&section.offset.to_le_bytes());
            index.extend_from_slice(&section.bytes.to_le_bytes());
            index.extend_from_slice(&section.check);
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
        let room = chunk.records[0].frame_of(&mut plain);
        let all_are_depths = match self.header.encoding.depth {
            DepthEncoding::Grid => depth::grid_bytes(Level::best(), &images.depth_m, room),
            DepthEncoding::Lossless => depth::lossless_bytes(Level::best(), &images.depth_m, room),
        };
        if let Some(at) = images.depth_m.iter().position(|depth| !all_are_depths && (depth.is_nan() || *depth < 0.0)) {
            return self.refuse(format!("the depth of pixel {at} is `{}`; it must be 0 m or more", images.depth_m[at]));
        }
        let section = self.compressed_section(&plain);
        self.depth_records = plain;
        section
    }

    fn ids_section(&mut self, images: &FrameImages) -> Result<Section> {
        let chunk = id_records(&self.header, self.sections.len());
        let mut plain = core::mem::take(&mut self.id_records);
        plain.resize(chunk.len(), 0);
        let (semantic, instance) = plain.split_at_mut(chunk.records[0].len());
        chunk.records[0].frame_of(semantic).copy_from_slice(&images.semantic);
        let room = chunk.records[1].frame_of(instance);
        match self.header.instance {
            InstanceFormat::U16 => {
                if ids::u16_bytes(Level::best(), &images.instance, room) > u32::from(u16::MAX) {
                    let largest = images.instance.iter().max().copied().unwrap_or(0);
                    return self.refuse(format!("instance id {largest} does not fit the pack's 16 bits"));
                }
            }
            InstanceFormat::U32 => ids::u32_bytes(Level::best(), &images.instance, room),
        }
        let section = self.compressed_section(&plain);
        self.id_records = plain;
        section
    }

    /// Compresses and appends the records of a chunk.
    fn compressed_section(&mut self, plain: &[u8]) -> Result<Section> {
        let mut stored = core::mem::take(&mut self.stored);
        stored.clear();
        stored.reserve(zstd::zstd_safe::compress_bound(plain.len()));
        self.compressor.compress_to_buffer(plain, &mut stored).map_err(write_error)?;
        let section = self.section(&stored)?;
        self.stored = stored;
        Ok(Section { plain_bytes: plain.len() as u32, plain_crc: crc32fast::hash(plain), ..section })
    }

    fn section(&mut self, bytes: &[u8]) -> Result<Section> {
        let section =
            Section { offset: self.position, bytes: bytes.len() as u64, check: check_of(bytes), ..Section::default() };
        self.put(bytes)?;
        Ok(section)
    }

    fn put(&mut self, bytes: &[u8]) -> Result<()> {
        self.output.write_all(bytes).map_err(write_error)?;
        self.position += bytes.len() as u64;
        Ok(())
    }
}

fn write_error(error: std::io::Error) -> Box<Diagnostic> {
    Diagnostic::io("write a frame pack", &error)
}
