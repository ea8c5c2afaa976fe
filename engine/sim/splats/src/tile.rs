//! A tile of pixels, through which footprints are blended from near to far: 3D Gaussian Splatting, equation 3.

use crate::exponential::power_of_two;
use crate::footprint::Footprint;
use cosfly_frames::simd_kernel;

/// Pixels of a tile's row, and its rows.
pub const SIDE: usize = 16;
/// Most opacity of a splat at a pixel.
pub const MOST_ALPHA: f32 = 0.99;
/// Where less light than this comes through, nothing more is blended.
pub const LEAST_LIGHT: f32 = 1e-4;
/// Footprints between two looks at what comes through.
const BETWEEN_LOOKS: usize = 8;

/// Pixels of a block's row, and its rows: a block fills the lanes of a vector, and few of them lie beside a small footprint.
const BLOCK: usize = 4;
/// Blocks of a tile's row.
const BLOCKS: usize = SIDE / BLOCK;
/// Lanes of a block.
const LANES: usize = BLOCK * BLOCK;

/// Numbers of the pixels of a tile, block by block.
pub type Pixels = [[f32; LANES]; BLOCKS * BLOCKS];

/// Block and lane of a pixel of a tile.
pub fn place(row: usize, column: usize) -> [usize; 2] {
    [row / BLOCK * BLOCKS + column / BLOCK, row % BLOCK * BLOCK + column % BLOCK]
}

/// Pixels of a tile.
pub struct Tile {
    /// Red, green, blue.
    pub colour: [Pixels; 3],
    /// Share of the light behind that comes through.
    pub transmittance: Pixels,
    /// Depth of the last splat before which half of the light came through.
    pub depth_m: Pixels,
    /// Nothing from here on is blended.
    pub limit_m: Pixels,
}

impl Tile {
    /// A tile through which all light comes, without limits.
    pub const CLEAR: Self = Self {
        colour: [[[0.0; LANES]; BLOCKS * BLOCKS]; 3],
        transmittance: [[1.0; LANES]; BLOCKS * BLOCKS],
        depth_m: [[f32::INFINITY; LANES]; BLOCKS * BLOCKS],
        limit_m: [[f32::INFINITY; LANES]; BLOCKS * BLOCKS],
    };
}

simd_kernel! {
    /// Blends those of the footprints that `order` names, into a tile whose first column and row are `corner`.
    pub fn blend(footprints: &[Footprint], order: &[u32], corner: [usize; 2], tile: &mut Tile) {
        let mut is_open = [true; BLOCKS * BLOCKS];
        for group in order.chunks(BETWEEN_LOOKS) {
            for number in group {
                let Some(splat) = footprints.get(*number as usize) else { continue };
                let stamp = Stamp::new(splat);
                let [columns, rows] = [0, 1].map(|axis| blocks(splat.first[axis], splat.last[axis], corner[axis]));
                let mut row = rows[0];
                while row <= rows[1] {
                    let mut column = columns[0];
                    while column <= columns[1] {
                        let block = row.wrapping_mul(BLOCKS).wrapping_add(column);
                        if is_open[block % (BLOCKS * BLOCKS)] {
                            let x = corner[0].wrapping_add(column.wrapping_mul(BLOCK)) as f32 + 0.5 - splat.place[0];
                            let y = corner[1].wrapping_add(row.wrapping_mul(BLOCK)) as f32 + 0.5 - splat.place[1];
                            stamp.blend(splat, [x, y], block % (BLOCKS * BLOCKS), tile);
                        }
                        column = column.wrapping_add(1);
                    }
                    row = row.wrapping_add(1);
                }
            }
            let mut any = false;
            for (is_open, light) in is_open.iter_mut().zip(&tile.transmittance) {
                let mut most = 0.0f32;
                for light in light {
                    most = if *light > most { *light } else { most };
                }
                *is_open = most > LEAST_LIGHT;
                any |= *is_open;
            }
            if !any {
                return;
            }
        }
    }
}

/// First and last block of a tile that a footprint reaches.
#[inline(always)]
fn blocks(first: u16, last: u16, corner: usize) -> [usize; 2] {
    let block = |at: u16| {
        let block = (at as usize).saturating_sub(corner) / BLOCK;
        if block < BLOCKS - 1 { block } else { BLOCKS - 1 }
    };
    [block(first), block(last)]
}

/// Columns and rows of the lanes of a block.
const ASIDE: [f32; LANES] = [0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0];
const BELOW: [f32; LANES] = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0, 3.0, 3.0, 3.0, 3.0];

/// A footprint's numbers that are the same in all blocks, by lane.
struct Stamp {
    /// Bend of the profile.
    bend: [f32; LANES],
    /// Rise of the depth, metres.
    rise_m: [f32; LANES],
}

impl Stamp {
    #[inline(always)]
    fn new(splat: &Footprint) -> Self {
        let [xx, xy, yy] = splat.profile;
        let mut stamp = Self { bend: [0.0; LANES], rise_m: [0.0; LANES] };
        for k in 0..LANES {
            let (x, y) = (ASIDE[k], BELOW[k]);
            stamp.bend[k] = xx * (x * x) + xy * (x * y) + yy * (y * y);
            stamp.rise_m[k] = splat.slope[0] * x + splat.slope[1] * y;
        }
        stamp
    }

    /// Blends the footprint into a block whose first pixel lies at (x, y) from its middle.
    #[inline(always)]
    fn blend(&self, splat: &Footprint, [x, y]: [f32; 2], block: usize, tile: &mut Tile) {
        let [xx, xy, yy] = splat.profile;
        let constant = xx * (x * x) + xy * (x * y) + yy * (y * y);
        let (across, down) = (2.0 * xx * x + xy * y, 2.0 * yy * y + xy * x);
        let mut power = [0.0f32; LANES];
        let mut any = 0u32;
        for k in 0..LANES {
            power[k] = constant + self.bend[k] + (across * ASIDE[k] + down * BELOW[k]);
            any |= u32::from(power[k] >= splat.least_power);
        }
        if any == 0 {
            return;
        }
        let depth_m = splat.depth_m + splat.slope[0] * x + splat.slope[1] * y;
        // Copies: the compiler then knows that no two of them are one.
        let (mut red, mut green, mut blue) = (tile.colour[0][block], tile.colour[1][block], tile.colour[2][block]);
        let (mut light, limit_m) = (tile.transmittance[block], tile.limit_m[block]);
        let mut median_m = tile.depth_m[block];
        for k in 0..LANES {
            let alpha = splat.opacity * power_of_two(power[k]);
            let alpha = if alpha < MOST_ALPHA { alpha } else { MOST_ALPHA };
            let z = depth_m + self.rise_m[k];
            let is_seen = (power[k] >= splat.least_power) & (z < limit_m[k]);
            let alpha = if is_seen { alpha } else { 0.0 };
            let before = light[k];
            let share = alpha * before;
            red[k] += share * splat.colour[0];
            green[k] += share * splat.colour[1];
            blue[k] += share * splat.colour[2];
            median_m[k] = if is_seen & (before >= 0.5) { z } else { median_m[k] };
            light[k] = before - share;
        }
        tile.colour[0][block] = red;
        tile.colour[1][block] = green;
        tile.colour[2][block] = blue;
        tile.transmittance[block] = light;
        tile.depth_m[block] = median_m;
    }
}
