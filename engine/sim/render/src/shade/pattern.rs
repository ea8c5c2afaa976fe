//! Patterns without files: integer hashes, a seeded noise texture with coarser levels, and box-filtered stripes.

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

/// 0 below `low`, 1 above `high`, smooth between.
#[inline(always)]
pub fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    // The reciprocal of constant limits is computed once, by the compiler.
    let t = ((x - low) * (1.0 / (high - low))).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Share of the interval of width `width` around `x` that lies in a stripe [`low`, `high`] repeated with period 1
/// (0 <= low <= high <= 1). Far away this tends to the stripe's mean, so patterns fade instead of shimmering.
#[inline(always)]
pub fn stripes(x: f32, low: f32, high: f32, width: f32) -> f32 {
    if width >= 1.0 {
        return high - low;
    }
    let width = width.max(1e-4);
    let at = x - floor_int(x) as f32;
    let (from, to) = (at - 0.5 * width, at + 0.5 * width);
    let overlap = |shift: f32| (to.min(high + shift) - from.max(low + shift)).max(0.0);
    ((overlap(-1.0) + overlap(0.0) + overlap(1.0)) / width).min(1.0)
}

/// Share of the interval of width `width` around `x` that lies in [`low`, `high`].
#[inline(always)]
pub fn band(x: f32, low: f32, high: f32, width: f32) -> f32 {
    let half = 0.5 * width.max(1e-4);
    (((x + half).min(high) - (x - half).max(low)) / (2.0 * half)).clamp(0.0, 1.0)
}

/// Tileable noises of mean one half: `grain` (single texels), `clumps` (many sizes), and `rough`, a blend of both.
pub struct NoiseTexture {
    grain: Vec<u8>,
    clumps: Vec<u8>,
    rough: Vec<u8>,
    starts: [usize; LEVELS],
}

impl NoiseTexture {
    /// Noise from a seed.
    pub fn new(seed: u32) -> Self {
        let grain = finest(&[(SIDE, 0.6), (SIDE / 2, 0.4)], hash(seed, 1));
        let clumps =
            finest(&[(4, 0.25), (8, 0.25), (16, 0.2), (32, 0.15), (64, 0.1), (128, 0.06), (256, 0.04)], hash(seed, 2));
        let mut starts = [0; LEVELS];
        for level in 1..LEVELS {
            starts[level] = starts[level - 1] + (SIDE >> (level - 1)).pow(2);
        }
        let rough = grain
            .iter()
            .zip(finest(&[(8, 0.3), (16, 0.3), (32, 0.25), (64, 0.15)], hash(seed, 3)))
            .map(|(grain, clump)| ((2 * u32::from(*grain) + 3 * u32::from(clump)) / 5) as u8)
            .collect();
        Self { grain: pyramid(grain), clumps: pyramid(clumps), rough: pyramid(rough), starts }
    }

    /// Single-texel noise in [0, 1] at texel coordinates, averaged over about `footprint` texels.
    #[inline(always)]
    pub fn grain(&self, x: f32, y: f32, footprint: f32) -> f32 {
        self.sample(&self.grain, x, y, footprint)
    }

    /// Noise of many sizes in [0, 1] at texel coordinates, averaged over about `footprint` texels.
    #[inline(always)]
    pub fn clumps(&self, x: f32, y: f32, footprint: f32) -> f32 {
        self.sample(&self.clumps, x, y, footprint)
    }

    /// Grain over clumps in [0, 1] at texel coordinates, averaged over about `footprint` texels.
    #[inline(always)]
    pub fn rough(&self, x: f32, y: f32, footprint: f32) -> f32 {
        self.sample(&self.rough, x, y, footprint)
    }

    #[inline(always)]
    fn sample(&self, texels: &[u8], x: f32, y: f32, footprint: f32) -> f32 {
        // The exponent of the footprint: level with texels at least about as large.
        let level = (((footprint * 1.4).to_bits() >> 23) as i32 - 127).clamp(0, LEVELS as i32 - 1) as usize;
        let side = SIDE >> level;
        let scale = side as f32 * (1.0 / SIDE as f32);
        let (x, y) = (x * scale - 0.5, y * scale - 0.5);
        let (column, row) = (floor_int(x), floor_int(y));
        let (fx, fy) = (x - column as f32, y - row as f32);
        let mask = side as i32 - 1;
        let start = self.starts[level];
        let (c0, c1) = ((column & mask) as usize, (column.wrapping_add(1) & mask) as usize);
        let (r0, r1) = ((row & mask) as usize * side + start, (row.wrapping_add(1) & mask) as usize * side + start);
        let upper = lerp(f32::from(texels[r0 + c0]), f32::from(texels[r0 + c1]), fx);
        let lower = lerp(f32::from(texels[r1 + c0]), f32::from(texels[r1 + c1]), fx);
        lerp(upper, lower, fy) * (1.0 / 255.0)
    }
}

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
fn pyramid(finest: Vec<u8>) -> Vec<u8> {
    let mut all = finest.clone();
    let mut level = finest;
    let mut side = SIDE;
    while side > 1 {
        let half = side / 2;
        level = (0..half * half)
            .map(|i| {
                let at = 2 * (i / half) * side + 2 * (i % half);
                let sum = [level[at], level[at + 1], level[at + side], level[at + side + 1]].map(u32::from);
                ((sum.iter().sum::<u32>() + 2) / 4) as u8
            })
            .collect();
        all.extend_from_slice(&level);
        side = half;
    }
    all
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
        let noise = NoiseTexture::new(5);
        assert!((noise.clumps(3.2, 9.1, 1.0) - noise.clumps(3.2 + 256.0, 9.1 - 256.0, 1.0)).abs() < 1e-3);
        assert!((noise.clumps(77.0, 12.0, 1e6) - 0.5).abs() < 0.02);
    }
}
