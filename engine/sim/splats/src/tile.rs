//! A tile of pixels, through which footprints are blended from near to far: 3D Gaussian Splatting, equation 3.

use crate::cloud::LEAST_ALPHA;
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

/// Numbers of the pixels of a tile.
pub type Pixels = [[f32; SIDE]; SIDE];

/// Pixels of a tile, row by row.
pub struct Tile {
    /// Red, green, blue.
    pub colour: [Pixels; 3],
    /// Share of the light behind that comes through.
    pub transmittance: Pixels,
    /// Depth at which half of the light is gone; infinite before.
    pub depth_m: Pixels,
    /// Sum of depths by their shares of the picture.
    pub weighted_m: Pixels,
    /// Nothing from here on is blended.
    pub limit_m: Pixels,
}

impl Tile {
    /// A tile through which all light comes, without limits.
    pub const CLEAR: Self = Self {
        colour: [[[0.0; SIDE]; SIDE]; 3],
        transmittance: [[1.0; SIDE]; SIDE],
        depth_m: [[f32::INFINITY; SIDE]; SIDE],
        weighted_m: [[0.0; SIDE]; SIDE],
        limit_m: [[f32::INFINITY; SIDE]; SIDE],
    };
}

simd_kernel! {
    /// Blends those of the footprints that `order` names, into a tile whose first column and row are `corner`.
    pub fn blend(footprints: &[Footprint], order: &[u32], corner: [usize; 2], tile: &mut Tile) {
        let mut is_open = [true; SIDE];
        let top = corner[1];
        let mut columns = [0.0f32; SIDE];
        for k in 0..SIDE {
            columns[k] = corner[0] as f32 + k as f32 + 0.5;
        }
        for group in order.chunks(BETWEEN_LOOKS) {
            for number in group {
                let Some(splat) = footprints.get(*number as usize) else { continue };
                let first = (splat.first[1] as usize).saturating_sub(top);
                let last = (splat.last[1] as usize).saturating_sub(top);
                let mut aside = [0.0f32; SIDE];
                for k in 0..SIDE {
                    aside[k] = columns[k] - splat.place[0];
                }
                let last = if last < SIDE - 1 { last } else { SIDE - 1 };
                let mut row = first;
                while row <= last {
                    if is_open[row] {
                        blend_row(splat, &aside, top.wrapping_add(row) as f32 + 0.5, row, tile);
                    }
                    row = row.wrapping_add(1);
                }
            }
            let mut any = false;
            for row in 0..SIDE {
                let mut most = 0.0f32;
                for light in &tile.transmittance[row] {
                    most = if *light > most { *light } else { most };
                }
                is_open[row] = most > LEAST_LIGHT;
                any |= is_open[row];
            }
            if !any {
                return;
            }
        }
    }
}

/// Blends a footprint into a row.
#[inline(always)]
fn blend_row(splat: &Footprint, aside: &[f32; SIDE], y: f32, row: usize, tile: &mut Tile) {
    let below = y - splat.place[1];
    let [xx, xy, yy] = splat.profile;
    let (constant, linear) = (yy * below * below, xy * below);
    let depth_m = splat.depth_m + splat.slope[1] * below;
    let [red, green, blue] = &mut tile.colour;
    let (red, green, blue) = (&mut red[row], &mut green[row], &mut blue[row]);
    let (light, limit_m) = (&mut tile.transmittance[row], &tile.limit_m[row]);
    let (median_m, weighted_m) = (&mut tile.depth_m[row], &mut tile.weighted_m[row]);
    for k in 0..SIDE {
        let x = aside[k];
        let alpha = splat.opacity * power_of_two(constant + x * (linear + xx * x));
        let alpha = if alpha < MOST_ALPHA { alpha } else { MOST_ALPHA };
        let z = depth_m + splat.slope[0] * x;
        let alpha = if (alpha >= LEAST_ALPHA) & (z < limit_m[k]) { alpha } else { 0.0 };
        let before = light[k];
        let share = alpha * before;
        let after = before - share;
        red[k] += share * splat.colour[0];
        green[k] += share * splat.colour[1];
        blue[k] += share * splat.colour[2];
        weighted_m[k] += share * z;
        median_m[k] = if (before >= 0.5) & (after < 0.5) { z } else { median_m[k] };
        light[k] = after;
    }
}
