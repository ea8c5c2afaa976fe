//! Small pictures of a frame, for viewers and for the `frames` table.

use super::rgb::{jpeg, palette_png};
use cosfly_diagnose::Result;
use cosfly_frames::simd::Level;
use cosfly_frames::simd_kernel;
use cosfly_maps::SemanticLabel;
use cosfly_render::FrameImages;
use cosfly_render::preview::depth_preview;

/// Previews are at most this wide.
const WIDTH: u32 = 320;
const RGB_QUALITY: u8 = 80;
const DEPTH_QUALITY: u8 = 75;

/// Size of a preview with the aspect of the frame, at least one pixel high.
fn size(images: &FrameImages) -> (u32, u32) {
    let width = WIDTH.min(images.width);
    let height = (u64::from(images.height) * u64::from(width) + u64::from(images.width) / 2) / u64::from(images.width);
    (width, (height as u32).clamp(1, images.height))
}

/// The colour image, averaged over the middle of blocks of pixels.
pub fn rgb(images: &FrameImages) -> Result<Vec<u8>> {
    let (width, height) = size(images);
    let columns: Vec<_> = (0..width).map(|x| middle_of(block(x, width, images.width))).collect();
    let mut pixels = Vec::with_capacity(3 * (width * height) as usize);
    let mut sums = vec![0u16; 3 * images.width as usize];
    for y in 0..height {
        let rows = middle_of(block(y, height, images.height));
        let row_bytes = sums.len();
        sum_of_rows(Level::best(), &images.rgb[rows.start * row_bytes..rows.end * row_bytes], &mut sums);
        for columns in &columns {
            let mut total = [0u32; 3];
            for pixel in sums[3 * columns.start..3 * columns.end].as_chunks::<3>().0 {
                total.iter_mut().zip(pixel).for_each(|(sum, value)| *sum += u32::from(*value));
            }
            let count = (rows.len() * columns.len()) as u32;
            pixels.extend_from_slice(&total.map(|sum| ((sum + count / 2) / count) as u8));
        }
    }
    jpeg(&pixels, width, height, RGB_QUALITY)
}

simd_kernel! {
    /// Sums of bytes over rows; previews take at most 128 rows together, so that 16 bits suffice.
    fn sum_of_rows(rows: &[u8], sums: &mut [u16]) {
        sums.fill(0);
        for row in rows.chunks_exact(sums.len().max(1)) {
            for (sum, value) in sums.iter_mut().zip(row) {
                *sum = sum.wrapping_add(u16::from(*value));
            }
        }
    }
}

/// The depth image in colours, stretched over the depths of this frame: a picture, not data.
pub fn depth(images: &FrameImages) -> Result<Vec<u8>> {
    let (width, height) = size(images);
    let depths = nearest(&images.depth_m, images, width, height);
    jpeg(&depth_preview(&depths), width, height, DEPTH_QUALITY)
}

/// The label image as a palette PNG: index = CARLA's id, palette = CARLA's colours.
pub fn semantic(images: &FrameImages) -> Result<Vec<u8>> {
    let (width, height) = size(images);
    let last = SemanticLabel::ALL.len() as u8 - 1;
    let mut indices = nearest(&images.semantic, images, width, height);
    indices.iter_mut().for_each(|index| *index = (*index).min(last));
    let palette = SemanticLabel::ALL.iter().flat_map(|label| label.colour()).collect();
    palette_png(&indices, width, height, palette)
}

/// The `count` blocks of `total` pixels: the range that belongs to block `index`, never empty.
fn block(index: u32, count: u32, total: u32) -> std::ops::Range<usize> {
    let edge = |i: u32| (u64::from(i) * u64::from(total) / u64::from(count)) as usize;
    edge(index)..edge(index + 1)
}

/// The middle half of a block that is at least four wide: a quarter of its pixels shows what all of them would.
fn middle_of(block: std::ops::Range<usize>) -> std::ops::Range<usize> {
    let margin = block.len() / 4;
    block.start + margin..block.end - margin
}

/// The full-size value in the middle of each preview pixel, row by row.
fn nearest<T: Copy>(values: &[T], images: &FrameImages, width: u32, height: u32) -> Vec<T> {
    let middle = |i: u32, count: u32, total: u32| (2 * i as usize + 1) * total as usize / (2 * count as usize);
    let columns: Vec<usize> = (0..width).map(|x| middle(x, width, images.width)).collect();
    let mut small = Vec::with_capacity((width * height) as usize);
    for y in 0..height {
        let start = middle(y, height, images.height) * images.width as usize;
        let row = &values[start..start + images.width as usize];
        small.extend(columns.iter().map(|column| row[*column]));
    }
    small
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn previews_keep_the_aspect_and_never_grow() {
        let frame = |width, height| FrameImages {
            width,
            height,
            rgb: vec![],
            depth_m: vec![],
            semantic: vec![],
            instance: vec![],
        };
        assert_eq!(size(&frame(1280, 720)), (320, 180));
        assert_eq!(size(&frame(64, 48)), (64, 48));
        assert_eq!(size(&frame(4000, 1)), (320, 1));
    }
}
