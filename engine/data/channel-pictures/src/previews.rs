//! Previews of a frame, for viewers and for the `frames` table.

use crate::false_colours::{depth_preview, picture_on_request};
use core::ops::Range;
use cosfly_diagnose::Result;
use cosfly_domain::channels::{ChannelSource, Element};
use cosfly_domain::{Channel, ChannelImage, FrameImages, SemanticLabel};
use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;
use cosfly_images::rgb::{jpeg, palette_png, png};

/// Largest width of a preview, pixels.
const WIDTH: u32 = 320;
const RGB_QUALITY: u8 = 80;
const DEPTH_QUALITY: u8 = 75;

/// Size of a preview with the aspect of the frame, at least one pixel high.
fn size(images: &FrameImages) -> (u32, u32) {
    let width = WIDTH.min(images.width);
    let height = (u64::from(images.height) * u64::from(width) + u64::from(images.width) / 2) / u64::from(images.width);
    (width, (height as u32).clamp(1, images.height))
}

/// Draws previews; reuses its buffers from frame to frame.
#[derive(Default)]
pub struct SmallImages {
    rgb: Vec<u8>,
    row_sums: Vec<u16>,
    depth_m: Vec<f32>,
    labels: Vec<u8>,
}

impl SmallImages {
    /// Fills `file` with the preview of a channel; nothing for ids and for channels that the frame does not have.
    ///
    /// # Errors
    /// The picture cannot be encoded.
    pub fn draw(&mut self, channel: &Channel, images: &FrameImages, file: &mut Vec<u8>) -> Result<()> {
        file.clear();
        match channel.source {
            ChannelSource::Colour => self.rgb(images, file),
            ChannelSource::Depth => self.depth(images, file),
            ChannelSource::Labels => self.semantic(images, file),
            ChannelSource::Ids => Ok(()),
            // On request.
            _ => match images.on_request.iter().find(|image| image.channel == channel) {
                Some(image) => self.on_request(image, images, file),
                None => Ok(()),
            },
        }
    }

    /// Fills `file` with the colour preview: the mean of the middle of each block of pixels (JPEG).
    fn rgb(&mut self, images: &FrameImages, file: &mut Vec<u8>) -> Result<()> {
        let (width, height) = size(images);
        let columns: Vec<_> = (0..width).map(|x| middle_of(block(x, width, images.width))).collect();
        self.rgb.resize(3 * (width * height) as usize, 0);
        self.row_sums.resize(3 * images.width as usize, 0);
        let row_bytes = self.row_sums.len();
        for (y, pixels) in (0..height).zip(self.rgb.chunks_exact_mut(3 * width as usize)) {
            let rows = middle_of(block(y, height, images.height));
            let full_rows = &images.rgb[rows.start * row_bytes..rows.end * row_bytes];
            sum_of_rows(Level::best(), full_rows, &mut self.row_sums);
            if images.width == 4 * width && rows.len() == 2 {
                // The usual size: two of four pixels, two of four rows.
                quarters(Level::best(), &self.row_sums, pixels);
            } else {
                for (pixel, columns) in pixels.as_chunks_mut::<3>().0.iter_mut().zip(&columns) {
                    *pixel = average(&self.row_sums, columns, rows.len());
                }
            }
        }
        jpeg(&self.rgb, width, height, RGB_QUALITY, file)
    }

    /// Fills `file` with the depth preview in colours, stretched over the depths of this frame (JPEG): for viewing, not
    /// as data.
    fn depth(&mut self, images: &FrameImages, file: &mut Vec<u8>) -> Result<()> {
        let (width, height) = size(images);
        nearest(&images.depth_m, images, &mut self.depth_m);
        jpeg(&depth_preview(&self.depth_m), width, height, DEPTH_QUALITY, file)
    }

    /// Fills `file` with the label preview as a palette PNG: index = CARLA's id, palette = CARLA's colours.
    fn semantic(&mut self, images: &FrameImages, file: &mut Vec<u8>) -> Result<()> {
        let (width, height) = size(images);
        let last = SemanticLabel::ALL.len() as u8 - 1;
        nearest(&images.semantic, images, &mut self.labels);
        self.labels.iter_mut().for_each(|index| *index = (*index).min(last));
        let palette = SemanticLabel::ALL.iter().flat_map(|label| label.colour()).collect();
        palette_png(&self.labels, width, height, palette, file)
    }

    /// Numbers in colours as depth is, pairs in those of a wheel, 1 white and 0 black, three bytes as they are.
    fn on_request(&self, image: &ChannelImage, images: &FrameImages, file: &mut Vec<u8>) -> Result<()> {
        let (width, height) = size(images);
        let small = match image.channel.element() {
            Element::Float => sampled(image.bytes.as_chunks::<4>().0, images),
            Element::Flag => sampled(image.bytes.as_chunks::<1>().0, images),
            Element::Pair => sampled(image.bytes.as_chunks::<8>().0, images),
            _ => sampled(image.bytes.as_chunks::<3>().0, images),
        };
        let picture = picture_on_request(image.channel, &small);
        match format(image.channel) {
            "jpeg" => jpeg(&picture, width, height, DEPTH_QUALITY, file),
            _ => png(&picture, width, height, file),
        }
    }
}

/// Format of the previews of a channel: `jpeg` or `png`.
pub fn format(channel: &Channel) -> &'static str {
    match channel.element() {
        Element::Colour | Element::Float => "jpeg",
        Element::Label | Element::Id | Element::Flag | Element::Bytes | Element::Pair => "png",
    }
}

simd_kernel! {
    /// Sums of bytes over rows; at most 128 rows are summed, so that 16 bits suffice.
    fn sum_of_rows(rows: &[u8], sums: &mut [u16]) {
        sums.fill(0);
        for row in rows.chunks_exact(sums.len().max(1)) {
            for (sum, value) in sums.iter_mut().zip(row) {
                *sum = sum.wrapping_add(u16::from(*value));
            }
        }
    }
}

simd_kernel! {
    /// Mean of the middle two of four neighbouring pixels, each a sum of two rows.
    fn quarters(row_sums: &[u16], pixels: &mut [u8]) {
        for (pixel, four) in pixels.as_chunks_mut::<3>().0.iter_mut().zip(row_sums.as_chunks::<12>().0) {
            for channel in 0..3 {
                let sum = four[3 + channel].wrapping_add(four[6 + channel]);
                pixel[channel] = (sum.wrapping_add(2) >> 2) as u8;
            }
        }
    }
}

/// Mean colour of a range of pixels of summed rows.
fn average(row_sums: &[u16], columns: &Range<usize>, rows: usize) -> [u8; 3] {
    let mut total = [0u32; 3];
    for pixel in row_sums[3 * columns.start..3 * columns.end].as_chunks::<3>().0 {
        total.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += u32::from(*value));
    }
    let count = (rows * columns.len()) as u32;
    total.map(|sum| ((sum + count / 2) / count) as u8)
}

/// Range of the pixels of block `index` when `total` pixels are divided into `count` blocks; never empty.
fn block(index: u32, count: u32, total: u32) -> Range<usize> {
    let edge = |i: u32| (u64::from(i) * u64::from(total) / u64::from(count)) as usize;
    edge(index)..edge(index + 1)
}

/// Middle half of a block that is at least four pixels wide: a quarter of its pixels represents all.
fn middle_of(block: Range<usize>) -> Range<usize> {
    let margin = block.len() / 4;
    block.start + margin..block.end - margin
}

/// Fills `small` with the full-size value in the middle of each preview pixel, row by row.
fn nearest<T: Copy>(values: &[T], images: &FrameImages, small: &mut Vec<T>) {
    let (width, height) = size(images);
    let middle = |i: u32, count: u32, total: u32| (2 * i as usize + 1) * total as usize / (2 * count as usize);
    let columns: Vec<usize> = (0..width).map(|x| middle(x, width, images.width)).collect();
    small.clear();
    for y in 0..height {
        let start = middle(y, height, images.height) * images.width as usize;
        let row = &values[start..start + images.width as usize];
        small.extend(columns.iter().map(|column| row[*column]));
    }
}

/// The bytes of the pixels that [`nearest`] takes.
fn sampled<const N: usize>(pixels: &[[u8; N]], images: &FrameImages) -> Vec<u8> {
    let mut small = vec![];
    nearest(pixels, images, &mut small);
    small.into_flattened()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_of_the_size_is_averaged_like_any_other() {
        let (width, height) = (1280, 720);
        let rgb: Vec<u8> = (0..3 * width * height).map(|i: u32| (i.wrapping_mul(i) / 7 + i / 3840) as u8).collect();
        let images = FrameImages { width, height, rgb, ..FrameImages::default() };
        let mut small = SmallImages::default();
        small.rgb(&images, &mut vec![]).unwrap();
        for (x, y) in [(0, 0), (319, 0), (17, 91), (319, 179)] {
            let expected: [u8; 3] = core::array::from_fn(|c| {
                let at = |dx: usize, dy: usize| u32::from(images.rgb[3 * (1280 * (4 * y + dy) + 4 * x + dx) + c]);
                ((at(1, 1) + at(2, 1) + at(1, 2) + at(2, 2) + 2) / 4) as u8
            });
            assert_eq!(small.rgb[3 * (320 * y + x)..][..3], expected, "{x} {y}");
        }
    }

    #[test]
    fn previews_keep_the_aspect_and_never_grow() {
        let frame = |width, height| FrameImages { width, height, ..FrameImages::default() };
        assert_eq!(size(&frame(1280, 720)), (320, 180));
        assert_eq!(size(&frame(64, 48)), (64, 48));
        assert_eq!(size(&frame(4000, 1)), (320, 1));
    }
}
