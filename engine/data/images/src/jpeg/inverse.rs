//! Inverse cosine transforms to blocks of 1, 2, 4 or 8 pixels a side, in integers.
//!
//! The N-point transform of the first N coefficients, s(0) + sqrt(2) sum s(u) cos((2x + 1) u pi / 2N), along rows and
//! columns, divided by 8.

/// Fraction bits of the constants.
const BITS: u32 = 12;

/// A constant in [`BITS`] bits.
const fn fixed(value: f64) -> i32 {
    (value * (1 << BITS) as f64 + if value < 0.0 { -0.5 } else { 0.5 }) as i32
}

/// Fills a block of `side` pixels in `pixels`, whose rows are `stride` apart.
#[inline(always)]
pub fn block(side: usize, coefficients: &[i32; 65], has_more: bool, pixels: &mut [u8], stride: usize) {
    if !has_more || side == 1 {
        let pixel = pixel(coefficients[0]);
        for row in pixels.chunks_mut(stride).take(side) {
            row[..side].fill(pixel);
        }
        return;
    }
    match side {
        2 => square::<2>(coefficients, pixels, stride, |[a, b]| [(a + b) << BITS, (a - b) << BITS]),
        4 => square::<4>(coefficients, pixels, stride, four),
        _ => square::<8>(coefficients, pixels, stride, eight),
    }
}

/// Rows, then columns. Values between the two are rounded back to whole numbers of 1/2^4.
#[inline(always)]
fn square<const N: usize>(
    coefficients: &[i32; 65],
    pixels: &mut [u8],
    stride: usize,
    transform: impl Fn([i32; N]) -> [i32; N],
) {
    const KEPT: u32 = 4;
    let mut columns = [[0; N]; N];
    for (row, line) in coefficients[..64].as_chunks::<8>().0.iter().take(N).enumerate() {
        let Some(line) = line.first_chunk::<N>() else { return };
        if *line == [0; N] {
            continue;
        }
        let values = transform(line.map(limited));
        for (column, value) in columns.iter_mut().zip(values) {
            let kept = (value + (1 << (BITS - KEPT - 1))) >> (BITS - KEPT);
            column[row] = kept.clamp(-65_536, 65_535);
        }
    }
    let mut turned = [[0u8; N]; N];
    for (x, column) in columns.into_iter().enumerate() {
        for (y, value) in transform(column).into_iter().enumerate() {
            turned[y][x] = (((value + (1 << (BITS + KEPT + 2))) >> (BITS + KEPT + 3)) + 128).clamp(0, 255) as u8;
        }
    }
    for (row, values) in pixels.chunks_mut(stride).zip(turned) {
        row[..N].copy_from_slice(&values);
    }
}

/// Coefficients of real pictures are far below; others must not overflow.
#[inline(always)]
fn limited(value: i32) -> i32 {
    value.clamp(-16_384, 16_383)
}

/// The pixel of a block without differences, whose mean is given eightfold.
#[inline(always)]
fn pixel(mean: i32) -> u8 {
    (((limited(mean) + 4) >> 3) + 128).clamp(0, 255) as u8
}

#[inline(always)]
fn four([a, b, c, d]: [i32; 4]) -> [i32; 4] {
    const C1: i32 = fixed(1.306_562_964_876_377);
    const C3: i32 = fixed(0.541_196_100_146_197);
    let (even, odd) = ([(a + c) << BITS, (a - c) << BITS], [C1 * b + C3 * d, C3 * b - C1 * d]);
    [even[0] + odd[0], even[1] + odd[1], even[1] - odd[1], even[0] - odd[0]]
}

#[inline(always)]
fn eight([s0, s1, s2, s3, s4, s5, s6, s7]: [i32; 8]) -> [i32; 8] {
    // sqrt(2) cos(k pi / 16) for k = 1, 2, 3, 5, 6, 7.
    const C1: i32 = fixed(1.387_039_845_322_148);
    const C2: i32 = fixed(1.306_562_964_876_377);
    const C3: i32 = fixed(1.175_875_602_419_359);
    const C5: i32 = fixed(0.785_694_958_387_102);
    const C6: i32 = fixed(0.541_196_100_146_197);
    const C7: i32 = fixed(0.275_899_379_282_943);
    let (sum, difference) = ((s0 + s4) << BITS, (s0 - s4) << BITS);
    let (high, low) = (C2 * s2 + C6 * s6, C6 * s2 - C2 * s6);
    let even = [sum + high, difference + low, difference - low, sum - high];
    let odd = [
        C1 * s1 + C3 * s3 + C5 * s5 + C7 * s7,
        C3 * s1 - C7 * s3 - C1 * s5 - C5 * s7,
        C5 * s1 - C1 * s3 + C7 * s5 + C3 * s7,
        C7 * s1 - C5 * s3 + C3 * s5 - C1 * s7,
    ];
    core::array::from_fn(|x| if x < 4 { even[x] + odd[x] } else { even[7 - x] - odd[7 - x] })
}
