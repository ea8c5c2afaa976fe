//! Writes a frame pack, one frame at a time, with nothing but the index kept in memory.

use super::{CHANNELS, END_MAGIC, InstanceFormat, MAGIC, PackHeader, Section, VERSION, check_of};
use crate::config::{DepthEncoding, RgbEncoding};
use crate::images::{depth, previews, rgb};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_render::FrameImages;
use std::io::Write;

/// Level of all zstd sections: higher ones gain nothing on rendered depth.
const ZSTD_LEVEL: i32 = 1;

/// Writes one pack. Call [`Self::frame`] per frame and [`Self::finish`] at the end; a pack without its end
/// is refused by the reader.
pub struct FramePackWriter<W: Write> {
    output: W,
    position: u64,
    header: PackHeader,
    header_bytes: Vec<u8>,
    sections: Vec<[Section; CHANNELS]>,
    compressor: zstd::bulk::Compressor<'static>,
}

impl<W: Write> FramePackWriter<W> {
    /// Begins a pack of images as `header` says.
    pub fn new(output: W, header: &PackHeader) -> Result<Self> {
        header.check()?;
        let header_bytes = serde_json::to_vec(header).expect("a pack header is plain JSON");
        let compressor = zstd::bulk::Compressor::new(ZSTD_LEVEL).map_err(write_error)?;
        let mut writer =
            Self { output, position: 0, header: header.clone(), header_bytes, sections: vec![], compressor };
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
        let depth_bytes = match encoding.depth {
            DepthEncoding::Grid => depth::little_endian(images.depth_m.iter().map(|d| depth::on_grid(*d))),
            DepthEncoding::Lossless => depth::little_endian(images.depth_m.iter().copied()),
        };
        let instance_bytes: Vec<u8> = match self.header.instance {
            InstanceFormat::U16 => images.instance.iter().flat_map(|id| (*id as u16).to_le_bytes()).collect(),
            InstanceFormat::U32 => images.instance.iter().flat_map(|id| id.to_le_bytes()).collect(),
        };
        let mut sections = [Section::default(); CHANNELS];
        sections[0] = self.section(&rgb_file)?;
        sections[1] = self.compressed_section(&depth_bytes)?;
        sections[2] = self.compressed_section(&images.semantic)?;
        sections[3] = self.compressed_section(&instance_bytes)?;
        if encoding.previews {
            sections[4] = self.section(&previews::rgb(images)?)?;
            sections[5] = self.section(&previews::depth(images)?)?;
            sections[6] = self.section(&previews::semantic(images)?)?;
        }
        self.sections.push(sections);
        Ok(())
    }

    /// Writes the index and gives the output back.
    pub fn finish(mut self) -> Result<W> {
        let index_offset = self.position;
        let mut index = Vec::with_capacity(self.sections.len() * CHANNELS * super::ENTRY_BYTES);
        for section in self.sections.iter().flatten() {
            index.extend_from_slice(&section.offset.to_le_bytes());
            index.extend_from_slice(&section.bytes.to_le_bytes());
            index.extend_from_slice(&section.check);
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
        let frame = self.sections.len();
        let refuse =
            |message: String| Err(Diagnostic::new("frame-images", Fault::Bug, format!("frame {frame}: {message}")));
        let pixels = self.header.pixels();
        if (images.width, images.height) != (self.header.width, self.header.height) {
            return refuse(format!(
                "images of {} x {} pixels; the pack has {} x {}",
                images.width, images.height, self.header.width, self.header.height
            ));
        }
        let lengths = [images.rgb.len() / 3, images.depth_m.len(), images.semantic.len(), images.instance.len()];
        if lengths != [pixels; 4] || images.rgb.len() != 3 * pixels {
            return refuse(format!("channels hold {lengths:?} pixels; all must hold {pixels}"));
        }
        if let Some(at) = images.depth_m.iter().position(|depth| depth.is_nan() || *depth < 0.0) {
            return refuse(format!("the depth of pixel {at} is `{}`; it must be 0 m or more", images.depth_m[at]));
        }
        let largest = images.instance.iter().copied().max().unwrap_or(0);
        if self.header.instance == InstanceFormat::U16 && largest > u32::from(u16::MAX) {
            return refuse(format!("instance id {largest} does not fit the pack's 16 bits"));
        }
        Ok(())
    }

    fn compressed_section(&mut self, bytes: &[u8]) -> Result<Section> {
        let compressed = self.compressor.compress(bytes).map_err(write_error)?;
        self.section(&compressed)
    }

    fn section(&mut self, bytes: &[u8]) -> Result<Section> {
        let section = Section { offset: self.position, bytes: bytes.len() as u64, check: check_of(bytes) };
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
