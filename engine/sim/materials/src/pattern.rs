//! Patterns without files: integer hashes, a seeded noise texture with coarser levels, and box-filtered stripes.

use super::lanes::{PixelLane, WIDE};

/// Side of the noise texture's finest level, texels.
const SIDE: usize = 256;
const LEVELS: usize = 9;

/// A well-mixed number from two.
#[inline(always)]
pub fn hash(a: u32, b: u32) -> u32 {
    let mut h = a.wrapping_mul(0x9e37_79b1) ^ b.wrapping_mul(0x85eb_ca77).rotate_left(13);
    h ^= h >> 16;
    h = h.wrapping_mul(0x7feb_352d);
    h ^= h >> 15;
    h = h.wrapping_mul(0x846c_a68b);
    h ^ (h >> 16)
}

/// A hash as a number in [0, 1).
#[inline(always)]
pub fn unit(h: u32) -> f32 {
    (h >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// The `index`-th independent number in [0, 1) of a seed.
#[inline(always)]
pub fn draw(seed: u32, index: u32) -> f32 {
    unit(hash(seed, index.wrapping_add(0x51ed)))
}

/// The integer at or next below `x`, for |x| < 4e6 (a whole x may give x - 1; anything else gives some integer).
/// Adding 1.5 * 2^23 leaves the rounded number in the low bits: cheaper than a saturating cast.
#[inline(always)]
pub fn floor_int(x: f32) -> i32 {
    (((x - 0.5) + 12_582_912.0).to_bits() as i32).wrapping_sub(0x4b40_0000)
}

/// The nearest index to a number in 0..4e6.
#[inline(always)]
pub fn nearest_index(x: f32) -> usize {
    ((x + 12_582_912.0).to_bits() & 0x003f_ffff) as usize
}

/// The smaller one; `b` when either is not a number. One instruction, unlike `f32::min`.
#[inline(always)]
pub fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger one; `b` when either is not a number.
#[inline(always)]
pub fn most(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Into 0..=1; what is not a number becomes 0.
#[inline(always)]
pub fn share(x: f32) -> f32 {
    least(most(x, 0.0), 1.0)
}

/// 1 when true.
#[inline(always)]
pub fn one_if(condition: bool) -> f32 {
    if condition { 1.0 } else { 0.0 }
}

/// 0 below `low`, 1 above `high`, smooth between.
#[inline(always)]
pub fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    // The reciprocal of constant limits is computed once, by the compiler.
    let t = share((x - low) * (1.0 / (high - low)));
    t * t * (3.0 - 2.0 * t)
}

/// Share of the interval of width `width` around `x` that lies in a stripe [`low`, `high`] repeated with period 1
/// (0 <= low <= high <= 1). Far away this tends to the stripe's mean, so patterns fade instead of shimmering.
#[inline(always)]
pub fn stripes(x: f32, low: f32, high: f32, width: f32) -> f32 {
    // An interval of width 1 holds exactly the mean.
    let width = least(most(width, 1e-4), 1.0);
    // From the middle of the nearest stripe; the next one is as far away as the rest of the period.
    let shifted = x + (0.5 - 0.5 * (low + high));
    let away = (shifted - floor_int(shifted) as f32 - 0.5).abs();
    let (reach, most_of_it) = (0.5 * (high - low + width), least(high - low, width));
    let overlap = |away: f32| least(most(reach - away, 0.0), most_of_it);
    // One reciprocal serves all stripes of a width.
    least((overlap(away) + overlap(1.0 - away)) * (1.0 / width), 1.0)
}

/// Share of the interval of width `width` around `x` that lies in [`low`, `high`].
#[inline(always)]
pub fn band(x: f32, low: f32, high: f32, width: f32) -> f32 {
    let width = most(width, 1e-4);
    let half = 0.5 * width;
    share((least(x + half, high) - most(x - half, low)) * (1.0 / width))
}

/// Tileable noises of mean one half, see [`Noises`]. A bare array, so that compilers see that kernels' results lie
/// elsewhere.
pub type NoiseTexture = [u32; 4 * TEXELS];

/// A power of two that holds all levels of one kind.
const TEXELS: usize = 2 * SIDE * SIDE;

/// Kinds of noise: `grain` (single texels), `clumps` (many sizes), and `rough`, a blend of both.
///
/// Each kind's levels lie one after the other. A number holds its texel in the lowest byte, then the one to the right,
/// the one below, and the one below to the right: what a blended sample needs comes with one load.
pub trait Noises {
    /// Single-texel noise in [0, 1] at texel coordinates, averaged over about `footprint` texels.
    fn grain(&self, x: f32, y: f32, footprint: f32) -> f32;
    /// Noise of many sizes in [0, 1] at texel coordinates, averaged over about `footprint` texels.
    fn clumps(&self, x: f32, y: f32, footprint: f32) -> f32;
    /// Grain over clumps in [0, 1] at texel coordinates, averaged over about `footprint` texels.
    fn rough(&self, x: f32, y: f32, footprint: f32) -> f32;
    /// Noise of many sizes from a level.
    fn clumps_at(&self, x: f32, y: f32, level: NoiseLevel) -> f32;
    /// Grain over clumps from a level.
    fn rough_at(&self, x: f32, y: f32, level: NoiseLevel) -> f32;
}

impl Noises for NoiseTexture {
    #[inline(always)]
    fn grain(&self, x: f32, y: f32, footprint: f32) -> f32 {
        sample(self, 0, x, y, NoiseLevel::of(footprint))
    }

    #[inline(always)]
    fn clumps(&self, x: f32, y: f32, footprint: f32) -> f32 {
        sample(self, 1, x, y, NoiseLevel::of(footprint))
    }

    #[inline(always)]
    fn rough(&self, x: f32, y: f32, footprint: f32) -> f32 {
        sample(self, 2, x, y, NoiseLevel::of(footprint))
    }

    #[inline(always)]
    fn clumps_at(&self, x: f32, y: f32, level: NoiseLevel) -> f32 {
        sample(self, 1, x, y, level)
    }

    #[inline(always)]
    fn rough_at(&self, x: f32, y: f32, level: NoiseLevel) -> f32 {
        sample(self, 2, x, y, level)
    }
}

/// Noise from a seed.
pub fn noise_texture(seed: u32) -> Box<NoiseTexture> {
    let grain = finest(&[(SIDE, 0.6), (SIDE / 2, 0.4)], hash(seed, 1));
    let clumps =
        finest(&[(4, 0.25), (8, 0.25), (16, 0.2), (32, 0.15), (64, 0.1), (128, 0.06), (256, 0.04)], hash(seed, 2));
    let rough = grain
        .iter()
        .zip(finest(&[(8, 0.3), (16, 0.3), (32, 0.25), (64, 0.15)], hash(seed, 3)))
        .map(|(grain, clump)| ((2 * u32::from(*grain) + 3 * u32::from(clump)) / 5) as u8)
        .collect();
    let mut all = Vec::with_capacity(4 * TEXELS);
    for finest in [grain, clumps, rough] {
        all.extend(pyramid(finest));
    }
    fixed_size(all)
}

/// A level of the noise texture: how its texels are found.
#[derive(Clone, Copy)]
pub struct NoiseLevel {
    /// Texels of the level per texel of the finest one.
    scale: f32,
    /// Its side less one, texels.
    mask: u32,
    /// Its first texel.
    start: u32,
    /// Binary digits of its side.
    digits: u32,
}

impl NoiseLevel {
    /// The level whose texels are at least about as large as `footprint` texels of the finest.
    #[inline(always)]
    pub fn of(footprint: f32) -> Self {
        let exponent = ((footprint * 1.4).to_bits() >> 23) as i32;
        let level = exponent.wrapping_sub(127).clamp(0, LEVELS as i32 - 1) as u32;
        Self {
            // 2^-level from its exponent.
            scale: f32::from_bits(127u32.wrapping_sub(level) << 23),
            mask: (SIDE as u32).wrapping_shr(level).wrapping_sub(1),
            // Texels of all finer levels: 4^8 + 4^7 + ... = (4^9 - 4^(9 - level)) / 3.
            start: ALL_TEXELS.wrapping_sub(ALL_TEXELS.wrapping_shr(level << 1)),
            digits: 8u32.wrapping_sub(level),
        }
    }
}

/// Levels of the noise texture for sixteen fours, worked out once for all of their pixels.
pub struct NoiseLevels {
    scale: PixelLane,
    mask: [u32; WIDE],
    start: [u32; WIDE],
    digits: [u32; WIDE],
}

impl NoiseLevels {
    /// Levels for pixels of these sizes where the finest texel is `1 / texels_per_m` wide.
    #[inline(always)]
    pub fn of(footprint_m: &PixelLane, texels_per_m: f32) -> Self {
        let mut levels = Self { scale: [0.0; WIDE], mask: [0; WIDE], start: [0; WIDE], digits: [0; WIDE] };
        for (k, footprint_m) in footprint_m.iter().enumerate() {
            let level = NoiseLevel::of(footprint_m * texels_per_m);
            (levels.scale[k], levels.mask[k]) = (level.scale, level.mask);
            (levels.start[k], levels.digits[k]) = (level.start, level.digits);
        }
        levels
    }

    /// The level of four `k`.
    #[inline(always)]
    pub fn at(&self, k: usize) -> NoiseLevel {
        NoiseLevel { scale: self.scale[k], mask: self.mask[k], start: self.start[k], digits: self.digits[k] }
    }
}

#[inline(always)]
fn sample(texels: &NoiseTexture, kind: usize, x: f32, y: f32, level: NoiseLevel) -> f32 {
    let (x, y) = (x * level.scale - 0.5, y * level.scale - 0.5);
    let (column, row) = (floor_int(x), floor_int(y));
    let (fx, fy) = (x - column as f32, y - row as f32);
    let in_row = (row as u32 & level.mask).wrapping_shl(level.digits);
    let at = level.start.wrapping_add(in_row).wrapping_add(column as u32 & level.mask);
    let four = texels[kind * TEXELS + (at as usize & (TEXELS - 1))];
    blend(four, fx, fy) * (1.0 / 255.0)
}

/// Texels of all levels.
const ALL_TEXELS: u32 = 87_381;

/// The blend of four bytes (here, right, below, below right) between which a place lies.
#[inline(always)]
pub fn blend(four: u32, fx: f32, fy: f32) -> f32 {
    let byte = |shift: u32| ((four >> shift) & 0xff) as i32 as f32;
    lerp(lerp(byte(0), byte(8), fx), lerp(byte(16), byte(24), fx), fy)
}

/// Four bytes in one number.
pub fn four_bytes(bytes: [u8; 4]) -> u32 {
    u32::from_le_bytes(bytes)
}

/// From `a` to `b` as `t` goes from 0 to 1.
#[inline(always)]
pub fn lerp(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// Sum of smooth value noises with the given numbers of cells per side, stretched to use the whole range.
fn finest(octaves: &[(usize, f32)], seed: u32) -> Vec<u8> {
    let mut sum = vec![0.0f32; SIDE * SIDE];
    for &(cells, weight) in octaves {
        let value = |column: usize, row: usize| {
            unit(hash(hash((column % cells) as u32, (row % cells) as u32), seed ^ cells as u32))
        };
        for row in 0..SIDE {
            for column in 0..SIDE {
                let (x, y) = ((column * cells) as f32 / SIDE as f32, (row * cells) as f32 / SIDE as f32);
                let (cx, cy) = (x as usize, y as usize);
                let (fx, fy) = (smoothstep(0.0, 1.0, x - cx as f32), smoothstep(0.0, 1.0, y - cy as f32));
                let upper = lerp(value(cx, cy), value(cx + 1, cy), fx);
                let lower = lerp(value(cx, cy + 1), value(cx + 1, cy + 1), fx);
                sum[row * SIDE + column] += weight * lerp(upper, lower, fy);
            }
        }
    }
    let mean = sum.iter().sum::<f32>() / sum.len() as f32;
    let reach = sum.iter().map(|value| (value - mean).abs()).fold(1e-6, f32::max);
    sum.iter().map(|value| (127.5 + 127.5 * (value - mean) / reach) as u8).collect()
}

/// All levels one after the other, each the 2 x 2 means of the one before.
fn pyramid(finest: Vec<u8>) -> Vec<u32> {
    let mut all = Vec::with_capacity(TEXELS);
    let mut level = finest;
    let mut side = SIDE;
    loop {
        for i in 0..side * side {
            let (column, row) = (i % side, i / side);
            let (right, below) = ((column + 1) % side, (row + 1) % side * side);
            let here = row * side;
            all.push(four_bytes([
                level[here + column],
                level[here + right],
                level[below + column],
                level[below + right],
            ]));
        }
        if side == 1 {
            break;
        }
        let half = side / 2;
        level = (0..half * half)
            .map(|i| {
                let at = 2 * (i / half) * side + 2 * (i % half);
                let sum = [level[at], level[at + 1], level[at + side], level[at + side + 1]].map(u32::from);
                ((sum.iter().sum::<u32>() + 2) / 4) as u8
            })
            .collect();
        side = half;
    }
    all.resize(TEXELS, 0);
    all
}

/// A table whose size is known, so that masked places in it need no check.
pub fn fixed_size<const N: usize>(mut table: Vec<u32>) -> Box<[u32; N]> {
    table.resize(N, 0);
    table.into_boxed_slice().try_into().unwrap_or_else(|_| Box::new([0; N]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stripes_fade_to_their_mean_and_are_sharp_up_close() {
        assert!((stripes(3.5, 0.25, 0.75, 1e-4) - 1.0).abs() < 1e-3);
        assert!(stripes(-7.1, 0.0, 0.5, 1e-4) < 1e-6);
        for x in [-3.3, 0.1, 0.77, 12.0] {
            assert!((stripes(x, 0.2, 0.5, 1.0) - 0.3).abs() < 1e-5, "{x}");
        }
    }

    #[test]
    fn noise_tiles_and_its_coarsest_level_is_its_mean() {
        let noise = noise_texture(5);
        assert!((noise.clumps(3.2, 9.1, 1.0) - noise.clumps(3.2 + 256.0, 9.1 - 256.0, 1.0)).abs() < 1e-3);
        assert!((noise.clumps(77.0, 12.0, 1e6) - 0.5).abs() < 0.02);
    }
}
