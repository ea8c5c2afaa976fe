//! From pixels to quantised coefficients, sixteen neighbouring blocks at a time.
//!
//! Every vector lane is a block: no step but the halving of chroma moves data between lanes, so that compilers vectorise plain loops over lanes.
//! Sums and products of floats in a written order give the same bits on every processor.

use cosfly_frames::simd_kernel;

/// Number of blocks transformed at once.
pub const LANES: usize = 16;
/// Bytes of one row of pixels of all lanes.
pub const ROW_BYTES: usize = 24 * LANES;
/// Eight rows of pixels of [`LANES`] neighbouring blocks, three bytes a pixel.
pub type Strip<'a> = [&'a [u8; ROW_BYTES]; 8];

/// One value per block.
type Lane<T> = [T; LANES];
/// 64 values per block, row by row.
type Blocks = [Lane<f32>; 64];

/// Buffers for the components of a strip: clearing them anew for each would take a tenth of the time.
pub struct Planes([Blocks; 3]);

impl Planes {
    /// Zeroed buffers.
    pub const ZERO: Self = Self([[[0.0; LANES]; 64]; 3]);
}

/// Position in a row-by-row block of each coefficient in zigzag order.
pub const ZIGZAG: [u8; 64] = [
    0, 1, 8, 16, 9, 2, 3, 10, 17, 24, 32, 25, 18, 11, 4, 5, 12, 19, 26, 33, 40, 48, 41, 34, 27, 20, 13, 6, 7, 14, 21,
    28, 35, 42, 49, 56, 57, 50, 43, 36, 29, 22, 15, 23, 30, 37, 44, 51, 58, 59, 52, 45, 38, 31, 39, 46, 53, 60, 61, 54,
    47, 55, 62, 63,
];

/// Quantised coefficients of [`LANES`] blocks of one component.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients {
    /// Coefficients in zigzag order.
    pub values: [Lane<i32>; 64],
    /// Bit k says that coefficient k of a block is not 0; the first 32, then the others.
    occupied: [Lane<u32>; 2],
}

impl Coefficients {
    /// All coefficients 0.
    pub const ZERO: Self = Self { values: [[0; LANES]; 64], occupied: [[0; LANES]; 2] };

    /// Bit k says that coefficient k of block `lane` is not 0.
    #[inline(always)]
    pub fn occupied(&self, lane: usize) -> u64 {
        u64::from(self.occupied[0][lane]) | u64::from(self.occupied[1][lane]) << 32
    }
}

/// Factors of the coefficients of [`forward_dct`], in zigzag order: the quantiser step and the transform's scale.
pub fn factors(steps: &[u8; 64]) -> [f32; 64] {
    // Arai, Agui and Nakajima leave a factor of 2 sqrt(2) cos(k pi / 16) per direction, and 1 for k = 0.
    const SCALES: [f64; 8] = [
        1.0,
        1.387_039_845_322_147_5,
        1.306_562_964_876_376_5,
        1.175_875_602_419_358_6,
        1.0,
        0.785_694_958_387_102_2,
        0.541_196_100_146_197,
        0.275_899_379_282_943_1,
    ];
    core::array::from_fn(|k| {
        let at = usize::from(ZIGZAG[k]);
        (1.0 / (8.0 * SCALES[at / 8] * SCALES[at % 8] * f64::from(steps[k]))) as f32
    })
}

simd_kernel! {
    /// Converts colours, transforms and quantises a strip; `factors` are those of luma and chroma.
    pub fn transform(
        strip: &Strip<'_>,
        factors: &[[f32; 64]; 2],
        planes: &mut Planes,
        coefficients: &mut [Coefficients; 3],
    ) {
        colour(strip, &mut planes.0);
        for component in 0..3 {
            forward_dct(&mut planes.0[component]);
            quantise(&planes.0[component], &factors[component.min(1)], &mut coefficients[component]);
        }
    }
}

simd_kernel! {
    /// Converts colours, transforms and quantises four strips: two below each other, of two neighbouring groups of blocks. Chroma has
    /// half the resolution in both directions: the sixteen blocks of a component cover both groups.
    pub fn transform_halved(
        strips: &[[Strip<'_>; 2]; 2],
        factors: &[[f32; 64]; 2],
        planes: &mut [[Planes; 2]; 2],
        luma: &mut [[Coefficients; 2]; 2],
        chroma: &mut [Coefficients; 2],
    ) {
        for half in 0..2 {
            for group in 0..2 {
                let planes = &mut planes[half][group].0;
                colour(&strips[half][group], planes);
                forward_dct(&mut planes[0]);
                quantise(&planes[0], &factors[0], &mut luma[half][group]);
            }
        }
        for (component, chroma) in chroma.iter_mut().enumerate() {
            let mut blocks = [[0.0; LANES]; 64];
            for (half, groups) in planes.iter().enumerate() {
                for (group, planes) in groups.iter().enumerate() {
                    halve(&planes.0[1 + component], half, group, &mut blocks);
                }
            }
            forward_dct(&mut blocks);
            quantise(&blocks, &factors[1], chroma);
        }
    }
}

/// Fills a quarter of chroma blocks with the means of two by two values of a group of blocks.
#[inline(always)]
fn halve(plane: &Blocks, half: usize, group: usize, blocks: &mut Blocks) {
    for row in 0..4 {
        for column in 0..4 {
            let at = 16 * row + 2 * column;
            let mut means = [0.0; LANES];
            for lane in 0..LANES {
                means[lane] =
                    0.25 * ((plane[at][lane] + plane[at + 1][lane]) + (plane[at + 8][lane] + plane[at + 9][lane]));
            }
            // Two neighbouring blocks become the left and the right side of one.
            for (place, pair) in means.as_chunks::<2>().0.iter().enumerate() {
                let (at, lane) = (8 * (4 * half + row) + column, 8 * group + place);
                blocks[at][lane] = pair[0];
                blocks[at + 4][lane] = pair[1];
            }
        }
    }
}

/// Converts to luma and chroma (ITU-R BT.601, full range), luma shifted to -128..128.
#[inline(always)]
fn colour(strip: &Strip<'_>, planes: &mut [Blocks; 3]) {
    // The rows of all blocks as words, through memory: filling vector registers lane by lane would take far longer.
    let mut words = [[[0u64; LANES]; 3]; 8];
    for (words, bytes) in words.iter_mut().zip(strip) {
        for (lane, pixels) in bytes.as_chunks::<24>().0.iter().enumerate() {
            for (word, eight) in words.iter_mut().zip(pixels.as_chunks::<8>().0) {
                word[lane] = u64::from_le_bytes(*eight);
            }
        }
    }
    for (row, words) in words.iter().enumerate() {
        // Halves: bytes are then taken from words as wide as the floats that they become.
        let mut halves = [[0u32; LANES]; 6];
        for (two, word) in halves.as_chunks_mut::<2>().0.iter_mut().zip(words) {
            for lane in 0..LANES {
                two[0][lane] = word[lane] as u32;
                two[1][lane] = (word[lane] >> 32) as u32;
            }
        }
        pixel_of_row::<0>(&halves, row, planes);
        pixel_of_row::<1>(&halves, row, planes);
        pixel_of_row::<2>(&halves, row, planes);
        pixel_of_row::<3>(&halves, row, planes);
        pixel_of_row::<4>(&halves, row, planes);
        pixel_of_row::<5>(&halves, row, planes);
        pixel_of_row::<6>(&halves, row, planes);
        pixel_of_row::<7>(&halves, row, planes);
    }
}

/// Pixel `X` of a row of every block; the row of a block is 24 bytes in six words.
#[inline(always)]
fn pixel_of_row<const X: usize>(words: &[Lane<u32>; 6], row: usize, planes: &mut [Blocks; 3]) {
    let at = 8 * row + X;
    for lane in 0..LANES {
        let byte = |index: usize| (words[index / 4][lane].wrapping_shr(8 * (index % 4) as u32) & 0xff) as i32 as f32;
        let (r, g, b) = (byte(3 * X), byte(3 * X + 1), byte(3 * X + 2));
        planes[0][at][lane] = 0.299 * r + 0.587 * g + 0.114 * b - 128.0;
        planes[1][at][lane] = 0.5 * b - 0.168_735_89 * r - 0.331_264_1 * g;
        planes[2][at][lane] = 0.5 * r - 0.418_687_6 * g - 0.081_312_41 * b;
    }
}

/// Cosine transform in both directions, up to the scales of [`factors`].
#[expect(clippy::needless_range_loop, reason = "one loop over lanes reads and writes several arrays")]
#[inline(always)]
fn forward_dct(blocks: &mut Blocks) {
    for row in blocks.as_chunks_mut::<8>().0 {
        for lane in 0..LANES {
            let turned = dct_of_eight(core::array::from_fn(|x| row[x][lane]));
            for x in 0..8 {
                row[x][lane] = turned[x];
            }
        }
    }
    for column in 0..8 {
        for lane in 0..LANES {
            let turned = dct_of_eight(core::array::from_fn(|y| blocks[8 * y + column][lane]));
            for y in 0..8 {
                blocks[8 * y + column][lane] = turned[y];
            }
        }
    }
}

/// Arai, Agui, Nakajima 1988: a scaled cosine transform with five products.
#[inline(always)]
fn dct_of_eight(v: [f32; 8]) -> [f32; 8] {
    let (sum07, difference07) = (v[0] + v[7], v[0] - v[7]);
    let (sum16, difference16) = (v[1] + v[6], v[1] - v[6]);
    let (sum25, difference25) = (v[2] + v[5], v[2] - v[5]);
    let (sum34, difference34) = (v[3] + v[4], v[3] - v[4]);
    let (outer, outer_difference) = (sum07 + sum34, sum07 - sum34);
    let (inner, inner_difference) = (sum16 + sum25, sum16 - sum25);
    let turned = (inner_difference + outer_difference) * 0.707_106_77;
    let (a, b, c) = (difference34 + difference25, difference25 + difference16, difference16 + difference07);
    let shared = (a - c) * 0.382_683_43;
    let low = 0.541_196_1 * a + shared;
    let high = 1.306_563 * c + shared;
    let middle = b * 0.707_106_77;
    let (upper, lower) = (difference07 + middle, difference07 - middle);
    [
        outer + inner,
        upper + high,
        outer_difference + turned,
        lower - low,
        outer - inner,
        lower + low,
        outer_difference - turned,
        upper - high,
    ]
}

/// Adding this to a float below 2^22 and taking the bits of the sum rounds it to the nearest integer, ties to even.
const ROUNDER: f32 = 12_582_912.0;

#[inline(always)]
fn quantise(blocks: &Blocks, factors: &[f32; 64], coefficients: &mut Coefficients) {
    for half in 0..2 {
        let mut occupied = [0u32; LANES];
        // A bit that is shifted from coefficient to coefficient keeps compilers from combining sixteen coefficients of
        // one lane, which would need gathers and scatters.
        let mut bit = 1u32;
        for k in 32 * half..32 * half + 32 {
            let (block, factor) = (&blocks[usize::from(ZIGZAG[k])], factors[k]);
            let mut values = [0i32; LANES];
            for lane in 0..LANES {
                let rounded = (block[lane] * factor + ROUNDER).to_bits().wrapping_sub(ROUNDER.to_bits()) as i32;
                values[lane] = rounded;
                occupied[lane] |= u32::from(rounded != 0).wrapping_neg() & bit;
            }
            coefficients.values[k] = values;
            bit = bit.wrapping_shl(1);
        }
        coefficients.occupied[half] = occupied;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::simd::Level;

    fn strip() -> [[u8; ROW_BYTES]; 8] {
        core::array::from_fn(|y| {
            core::array::from_fn(|i| {
                let wave = (i * i + 37 * y * i) % 251;
                if i % 5 == 0 { 255 - wave as u8 } else { wave as u8 }
            })
        })
    }

    #[test]
    fn all_vector_levels_give_the_same_coefficients() {
        let factors = [factors(&[3; 64]), factors(&[7; 64])];
        let run = |level| {
            let mut coefficients = [Coefficients::ZERO; 3];
            let mut planes = Planes::ZERO;
            transform(level, &strip().each_ref(), &factors, &mut planes, &mut coefficients);
            coefficients
        };
        for level in Level::available() {
            assert!(run(level) == run(Level::PLAIN), "{}", level.name());
        }
    }

    #[test]
    fn coefficients_are_those_of_the_textbook_sum() {
        let steps = core::array::from_fn(|k| 1 + (k % 5) as u8);
        let mut coefficients = [Coefficients::ZERO; 3];
        let mut planes = Planes::ZERO;
        transform(Level::PLAIN, &strip().each_ref(), &[factors(&steps); 2], &mut planes, &mut coefficients);
        for lane in [0, 7, 15] {
            let luma = |y: usize, x: usize| {
                let pixel = &strip()[y][24 * lane + 3 * x..][..3];
                0.299 * f64::from(pixel[0]) + 0.587 * f64::from(pixel[1]) + 0.114 * f64::from(pixel[2]) - 128.0
            };
            for k in 0..64 {
                let (v, u) = (usize::from(ZIGZAG[k]) / 8, usize::from(ZIGZAG[k]) % 8);
                let cosine =
                    |x: usize, u: usize| libm::cos((2 * x + 1) as f64 * u as f64 * core::f64::consts::PI / 16.0);
                let norm = |u: usize| if u == 0 { core::f64::consts::FRAC_1_SQRT_2 } else { 1.0 };
                let mut sum = 0.0;
                for y in 0..8 {
                    for x in 0..8 {
                        sum += luma(y, x) * cosine(x, u) * cosine(y, v);
                    }
                }
                let exact = 0.25 * norm(u) * norm(v) * sum / f64::from(steps[k]);
                let got = coefficients[0].values[k][lane];
                assert!((exact - f64::from(got)).abs() < 0.502, "{lane} {k}: {got} {exact}");
                assert_eq!(coefficients[0].occupied(lane) >> k & 1 == 1, got != 0);
            }
        }
    }
}
