//! A baseline JPEG encoder whose bytes are the same on every processor and at every vector level, and a decoder for
//! small pictures.

mod bits;
mod decode;
mod huffman;
mod inverse;
mod transform;

pub use decode::{DecodedJpeg, decode};

use cosfly_frames::simd::Level;
use huffman::{AC, BitWriter, Codes, DC, UNITS, write_blocks, write_units};
use std::sync::LazyLock;
use transform::{Coefficients, LANES, Planes, ROW_BYTES, Strip, ZIGZAG, factors, transform, transform_halved};

/// Largest width and height of a JPEG file.
pub const MAX_SIDE: u32 = 65_535;

/// DC and AC codes of luma, then of chroma.
static CODES: LazyLock<[[Codes; 2]; 2]> =
    LazyLock::new(|| [[Codes::of(&DC[0]), Codes::of(&AC[0])], [Codes::of(&DC[1]), Codes::of(&AC[1])]]);

/// Example steps of the standard (Annex K.1) for quality 50, row by row: luma, chroma.
#[rustfmt::skip]
const STEPS: [[u16; 64]; 2] = [
    [
        16, 11, 10, 16, 24, 40, 51, 61, 12, 12, 14, 19, 26, 58, 60, 55, 14, 13, 16, 24, 40, 57, 69, 56, 14, 17, 22, 29, 51, 87, 80, 62,
        18, 22, 37, 56, 68, 109, 103, 77, 24, 35, 55, 64, 81, 104, 113, 92, 49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99,
    ],
    [
        17, 18, 24, 47, 99, 99, 99, 99, 18, 21, 26, 66, 99, 99, 99, 99, 24, 26, 56, 99, 99, 99, 99, 99, 47, 66, 99, 99, 99, 99, 99, 99,
        99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99, 99,
    ],
];

/// Resolution of the colours of a JPEG file beside that of its brightness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chroma {
    /// Full resolution (4:4:4).
    Full,
    /// Half in both directions (4:2:0).
    Half,
}

/// Fills `file` with a JPEG file of row-major sRGB pixels; `quality` is libjpeg's, 1 to 100.
///
/// `rgb` must hold `3 * width * height` bytes, and both sides must be 1 to [`MAX_SIDE`].
pub fn encode(rgb: &[u8], width: u32, height: u32, quality: u8, chroma: Chroma, file: &mut Vec<u8>) {
    encode_at(Level::best(), rgb, width, height, quality, chroma, file);
}

fn encode_at(level: Level, rgb: &[u8], width: u32, height: u32, quality: u8, chroma: Chroma, file: &mut Vec<u8>) {
    let steps = [0, 1].map(|table| scaled_steps(&STEPS[table], quality));
    let factors = [factors(&steps[0]), factors(&steps[1])];
    file.clear();
    write_head(file, width as u16, height as u16, &steps, chroma);
    let image = Image { rgb, width: width as usize, height: height as usize };
    let mut bits = BitWriter::EMPTY;
    match chroma {
        Chroma::Full => write_full(level, image, &factors, &mut bits, file),
        Chroma::Half => write_halved(level, image, &factors, &mut bits, file),
    }
    bits.finish(file);
    file.extend_from_slice(&[0xff, 0xd9]);
}

/// Row-major pixels.
#[derive(Clone, Copy)]
struct Image<'a> {
    rgb: &'a [u8],
    width: usize,
    height: usize,
}

/// Eight rows of pixels of [`LANES`] blocks.
type Margin = [[u8; ROW_BYTES]; 8];

impl Image<'_> {
    /// The strip of the blocks from block column `first` on and row `top` on; `margin` holds it where it leaves the image, whose last
    /// pixels are repeated there. Part of the strip must be in the image's columns.
    fn strip<'a>(&'a self, top: usize, first: usize, margin: &'a mut Margin) -> Strip<'a> {
        let row_bytes = 3 * self.width;
        let rows: [&[u8]; 8] = core::array::from_fn(|y| {
            let start = row_bytes * (top + y).min(self.height - 1);
            &self.rgb[start..start + row_bytes]
        });
        let inside = 24 * first..24 * first + ROW_BYTES;
        if inside.end > row_bytes {
            margin.iter_mut().zip(rows).for_each(|(row, pixels)| copy_pixels(pixels, inside.start, row));
        }
        let margin = &*margin;
        core::array::from_fn(|y| rows[y].get(inside.clone()).and_then(<[u8]>::first_chunk).unwrap_or(&margin[y]))
    }
}

fn write_full(level: Level, image: Image<'_>, factors: &[[f32; 64]; 2], bits: &mut BitWriter, file: &mut Vec<u8>) {
    let [luma, chroma] = &*CODES;
    let codes = [luma, chroma, chroma];
    let blocks_across = image.width.div_ceil(8);
    let mut margin = [[0; ROW_BYTES]; 8];
    let mut planes = Planes::ZERO;
    let mut coefficients = [Coefficients::ZERO; 3];
    let mut previous_dc = [0; 3];
    for top in (0..image.height).step_by(8) {
        for first in (0..blocks_across).step_by(LANES) {
            let strip = image.strip(top, first, &mut margin);
            transform(level, &strip, factors, &mut planes, &mut coefficients);
            write_blocks(level, bits, &coefficients, &codes, blocks_across - first, &mut previous_dc);
            bits.flush(file);
        }
    }
}

fn write_halved(level: Level, image: Image<'_>, factors: &[[f32; 64]; 2], bits: &mut BitWriter, file: &mut Vec<u8>) {
    let [luma_codes, chroma_codes] = &*CODES;
    let codes = [luma_codes, chroma_codes];
    let units_across = image.width.div_ceil(16);
    let mut margins = [[[[0; ROW_BYTES]; 8]; 2]; 2];
    let mut planes = [const { [const { Planes::ZERO }; 2] }; 2];
    let mut luma = [const { [const { Coefficients::ZERO }; 2] }; 2];
    let mut chroma = [const { Coefficients::ZERO }; 2];
    let mut previous_dc = [0; 3];
    for top in (0..image.height).step_by(16) {
        for first in (0..units_across).step_by(2 * UNITS) {
            // A second group outside of the image is never written.
            let second = if first + UNITS < units_across { first + UNITS } else { first };
            let [[a, b], [c, d]] = &mut margins;
            let strips = [
                [image.strip(top, 2 * first, a), image.strip(top, 2 * second, b)],
                [image.strip(top + 8, 2 * first, c), image.strip(top + 8, 2 * second, d)],
            ];
            transform_halved(level, &strips, factors, &mut planes, &mut luma, &mut chroma);
            for group in 0..2 {
                let from = UNITS * group;
                let units = from..from + units_across.saturating_sub(first + from).min(UNITS);
                write_units(level, bits, &luma, &chroma, &codes, units, &mut previous_dc);
                bits.flush(file);
            }
        }
    }
}

/// Copies the pixels of `image_row` from `start` on; beyond its end, repeats its last pixel.
fn copy_pixels(image_row: &[u8], start: usize, row: &mut [u8; ROW_BYTES]) {
    let there = &image_row[start..image_row.len().min(start + ROW_BYTES)];
    row[..there.len()].copy_from_slice(there);
    let last = &image_row[image_row.len() - 3..];
    row[there.len()..].chunks_exact_mut(3).for_each(|pixel| pixel.copy_from_slice(last));
}

/// Example steps scaled as in libjpeg, in zigzag order.
fn scaled_steps(steps: &[u16; 64], quality: u8) -> [u8; 64] {
    let quality = u32::from(quality.clamp(1, 100));
    let percent = if quality < 50 { 5000 / quality } else { 200 - 2 * quality };
    core::array::from_fn(|k| {
        let step = u32::from(steps[usize::from(ZIGZAG[k])]);
        ((step * percent + 50) / 100).clamp(1, 255) as u8
    })
}

/// Writes everything before the entropy-coded bits: JFIF, steps, size, code tables, start of scan.
fn write_head(file: &mut Vec<u8>, width: u16, height: u16, steps: &[[u8; 64]; 2], chroma: Chroma) {
    file.extend_from_slice(&[0xff, 0xd8]);
    segment(file, 0xe0, &[b"JFIF\0", &[1, 1, 0, 0, 1, 0, 1, 0, 0]]);
    for (table, steps) in (0u8..).zip(steps) {
        segment(file, 0xdb, &[&[table], steps]);
    }
    let [[h1, h0], [w1, w0]] = [height.to_be_bytes(), width.to_be_bytes()];
    let blocks = if chroma == Chroma::Half { 0x22 } else { 0x11 };
    segment(file, 0xc0, &[&[8, h1, h0, w1, w0, 3], &[1, blocks, 0], &[2, 0x11, 1], &[3, 0x11, 1]]);
    for table in 0..2u8 {
        let (dc, ac) = (&DC[usize::from(table)], &AC[usize::from(table)]);
        segment(file, 0xc4, &[&[table], &dc.counts, dc.symbols]);
        segment(file, 0xc4, &[&[0x10 | table], &ac.counts, ac.symbols]);
    }
    segment(file, 0xda, &[&[3], &[1, 0x00], &[2, 0x11], &[3, 0x11], &[0, 63, 0]]);
}

fn segment(file: &mut Vec<u8>, marker: u8, parts: &[&[u8]]) {
    let length = 2 + parts.iter().map(|part| part.len()).sum::<usize>();
    file.extend_from_slice(&[0xff, marker]);
    file.extend_from_slice(&(length as u16).to_be_bytes());
    parts.iter().for_each(|part| file.extend_from_slice(part));
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::Seed;
    use std::io::Cursor;

    /// Test picture with gradients, edges and noise.
    fn picture(width: u32, height: u32) -> Vec<u8> {
        let mut random = Seed([3; 32]).stream("picture");
        let mut rgb = vec![];
        for y in 0..height {
            for x in 0..width {
                let noise = random.uniform(0.0, 24.0) as u32;
                let wall = if (x / 13 + y / 7) % 3 == 0 { 130 } else { 20 };
                rgb.extend([wall + noise, (x * 200 / width) + noise, (y * 220 / height) + noise].map(|v| v as u8));
            }
        }
        rgb
    }

    fn encoded(level: Level, rgb: &[u8], [width, height]: [u32; 2], quality: u8, chroma: Chroma) -> Vec<u8> {
        let mut file = b"something else".to_vec();
        encode_at(level, rgb, width, height, quality, chroma, &mut file);
        file
    }

    fn decoded(file: &[u8]) -> (Vec<u8>, usize, usize) {
        let mut decoder = zune_jpeg::JpegDecoder::new(Cursor::new(file));
        let pixels = decoder.decode().expect("a readable file");
        let (width, height) = decoder.dimensions().expect("a size");
        (pixels, width, height)
    }

    /// Root mean squared difference.
    fn error(a: &[u8], b: &[u8]) -> f64 {
        assert_eq!(a.len(), b.len());
        let sum: f64 =
            a.iter().zip(b).map(|(a, b)| (f64::from(*a) - f64::from(*b)) * (f64::from(*a) - f64::from(*b))).sum();
        (sum / a.len() as f64).sqrt()
    }

    #[test]
    fn another_library_reads_any_size_as_well_as_its_fellow_would_write_it() {
        use jpeg_encoder::SamplingFactor::{R_4_2_0, R_4_4_4};
        for (width, height) in [(1, 1), (8, 8), (127, 9), (128, 16), (129, 33), (257, 40), (320, 180), (3, 70)] {
            let rgb = picture(width, height);
            let samplings = [(Chroma::Full, R_4_4_4), (Chroma::Half, R_4_2_0)];
            for (quality, (chroma, sampling)) in [50, 95, 100].into_iter().flat_map(|it| samplings.map(|of| (it, of))) {
                let (pixels, w, h) = decoded(&encoded(Level::best(), &rgb, [width, height], quality, chroma));
                assert_eq!((w, h), (width as usize, height as usize));
                let mut other = vec![];
                let mut encoder = jpeg_encoder::Encoder::new(&mut other, quality);
                encoder.set_sampling_factor(sampling);
                encoder.encode(&rgb, width as u16, height as u16, jpeg_encoder::ColorType::Rgb).expect("a file");
                let (ours, theirs) = (error(&pixels, &rgb), error(&decoded(&other).0, &rgb));
                // Encoders differ in how they halve colours at the picture's edge, which is most of a picture of 3 pixels.
                let margin = if chroma == Chroma::Half && width < 8 { 1.06 } else { 1.02 };
                assert!(ours < margin * theirs + 0.3, "{width} x {height} at {quality}: {ours} {theirs}");
            }
        }
    }

    #[test]
    fn all_vector_levels_give_the_same_file() {
        let rgb = picture(210, 60);
        for chroma in [Chroma::Full, Chroma::Half] {
            let plain = encoded(Level::PLAIN, &rgb, [210, 60], 90, chroma);
            for level in Level::available() {
                assert!(encoded(level, &rgb, [210, 60], 90, chroma) == plain, "{}", level.name());
            }
        }
    }
}
