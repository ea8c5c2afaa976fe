//! Shadow maps packed for look-up, and the share of the sun's light at each pixel's place.

use super::lanes::{Block, FOUR, WIDE, get};
use super::pattern::{NoiseTexture, Noises, floor_int, least, lerp, most, one_if, smoothstep};
use super::shadow_frame::DEPTH_M;
use super::shadow_region::Region;
use super::vector::Vec3;
use cosfly_frames::simd_kernel;

/// Texels along a side of the town's map.
pub(super) const SIDE: usize = 1536;
/// Texels along a side of the target's own map.
pub(super) const FIGURE_SIDE: usize = 96;
/// Content of a texel of the town's map.
pub(super) const SOLID: u32 = 0;
pub(super) const LEAVES: u32 = 1;

/// Maps as the kernel reads them. A number holds a texel in its low half and the one to the right in its high half:
/// height above [`LOWEST_M`] below the reference in steps of 1/32 m, times two, plus one for leaves.
pub(super) struct Packed {
    pub(super) town: Box<TownMap>,
    pub(super) tiles: Box<TileMap>,
    /// One for each of a frame's people, and some that wait to be used again.
    pub(super) figures: Vec<FigureShadow>,
    pub(super) places: Places,
}

/// A figure's own map, and where it lies; nowhere without a shadow.
pub(super) struct FigureShadow {
    pub(super) map: Box<FigureMap>,
    /// Number of rows and columns in use.
    pub(super) side: usize,
    pub(super) rows: Option<[[f32; 4]; 2]>,
}

/// Place of the town's map.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Places {
    pub(super) rows: [[f32; 4]; 2],
    pub(super) base_m: f32,
    pub(super) texels_m: [f32; 2],
    pub(super) corner_m: [f32; 2],
    /// Map coordinates within which this frame sees shadows.
    pub(super) low: [f32; 2],
    pub(super) high: [f32; 2],
}

type TownMap = [u32; TOWN_TEXELS];
/// Of each tile of texels, and those right and below of it: the least height in the low half, 0 where leaves are, and the
/// greatest in the high half; steps.
type TileMap = [u32; TILES];
type FigureMap = [u32; FIGURE_TEXELS];

/// Powers of two that hold the maps.
const TOWN_TEXELS: usize = 1 << 22;
const FIGURE_TEXELS: usize = 1 << 14;
const TILES: usize = 1 << (2 * TILES_SHIFT);
/// A row of tiles has room for so many bits of columns.
const TILES_SHIFT: u32 = 8;
/// Bits of a texel's column or row within its tile.
const IN_TILE: u32 = 3;
/// Nothing lower than this below the reference casts a shadow.
pub(super) const LOWEST_M: f64 = 200.0;
/// Steps per metre of packed heights.
const STEPS_PER_M: f32 = 32.0;

simd_kernel! {
    /// Packs a part of a map `side` texels wide.
    pub(super) fn pack(heights: &[f32], classes: &[u32], side: usize, part: &Region, packed: &mut [u32]) {
        let lowest = (DEPTH_M - LOWEST_M) as f32;
        let ([first, top], [end, bottom]) = (part.first, part.end);
        for row in top..bottom {
            let texels = row.wrapping_mul(side).wrapping_add(first)..row.wrapping_mul(side).wrapping_add(end);
            let (Some(heights), Some(classes), Some(packed)) =
                (heights.get(texels.clone()), classes.get(texels.clone()), packed.get_mut(texels))
            else {
                return;
            };
            for ((packed, height_m), class) in packed.iter_mut().zip(heights).zip(classes) {
                // Adding 2^23 leaves the nearest whole number in the low bits.
                let steps = least(most((height_m - lowest) * STEPS_PER_M, 0.0), 32767.0) + 8_388_608.0;
                // Classes count where something stands.
                *packed = ((steps.to_bits() & 0x7fff) << 1) | u32::from((*class == LEAVES) & (*height_m > 0.0));
            }
            for column in 1..packed.len() {
                packed[column.wrapping_sub(1)] |= packed[column] << 16;
            }
        }
    }
}

simd_kernel! {
    /// Measures the tiles of a part of the town's packed map.
    pub(super) fn measure_tiles(map: &TownMap, part: &Region, tiles: &mut TileMap) {
        const TEXELS: usize = 1 << IN_TILE;
        for row in part.first[1] / TEXELS..part.end[1].div_ceil(TEXELS) {
            for column in part.first[0] / TEXELS..part.end[0].div_ceil(TEXELS) {
                let (mut least, mut greatest) = ([u32::MAX; TEXELS], [0u32; TEXELS]);
                for below in 0..=TEXELS {
                    let texel = (row * TEXELS + below) * SIDE + column * TEXELS;
                    let Some(texels) = map.get(texel..).and_then(|rest| rest.first_chunk::<TEXELS>()) else { continue };
                    for k in 0..TEXELS {
                        for half in [texels[k] & 0xffff, texels[k] >> 16] {
                            let low = if half & 1 == LEAVES { 0 } else { half >> 1 };
                            least[k] = least[k].min(low);
                            greatest[k] = greatest[k].max(half >> 1);
                        }
                    }
                }
                let least = least.into_iter().fold(0x7fff, u32::min);
                let greatest = greatest.into_iter().fold(0, u32::max);
                tiles[((row << TILES_SHIFT) | column) & (TILES - 1)] = least | greatest << 16;
            }
        }
    }
}

simd_kernel! {
    pub(super) fn town_sunlight(
        blocks: &mut [Block],
        map: &TownMap,
        tiles: &TileMap,
        places: &Places,
        flat: bool,
        noise: &NoiseTexture,
    ) {
        let places = *places;
        for four in blocks.as_chunks_mut::<FOUR>().0 {
            let mut alike = flat;
            // The ends first.
            for (number, pixel) in [0, 3, 1, 2].into_iter().enumerate() {
                if number == 2 && alike {
                    (four[1].sunlight, four[2].sunlight) = (four[0].sunlight, four[0].sunlight);
                    break;
                }
                if !lit_by_tiles(&mut four[pixel], tiles, &places) {
                    alike &= !lit_through_leaves(&mut four[pixel], map, &places, noise);
                }
                if number == 1 {
                    let mut differ = 0u32;
                    for k in 0..WIDE {
                        differ |= u32::from((four[0].sunlight[k] - four[3].sunlight[k]).abs() > 0.01);
                    }
                    alike &= differ == 0;
                }
            }
        }
    }
}

/// Looks a block's sunlight up in whole tiles, which tells the same wherever a tile is all above or all below the
/// places; whether it did for all of them.
#[inline(always)]
fn lit_by_tiles(block: &mut Block, tiles: &TileMap, places: &Places) -> bool {
    let Places { rows: [row_u, row_v], base_m, low, high, .. } = *places;
    let mut unknown = 0u32;
    for k in 0..WIDE {
        let (point, height) = lifted(block, k, base_m);
        let (u, v) = (affine(row_u, point) - 0.5, affine(row_v, point) - 0.5);
        let inside = (u >= low[0]) & (v >= low[1]) & (u < high[0]) & (v < high[1]);
        let (column, row) = (floor_int(u) as u32 >> IN_TILE, floor_int(v) as u32 >> IN_TILE);
        let tile = tiles[(row.wrapping_shl(TILES_SHIFT) | column) as usize & (TILES - 1)];
        let steps = height * STEPS_PER_M;
        let lit = !inside | ((tile >> 16) as i32 as f32 <= steps);
        let dark = (tile & 0xffff) as i32 as f32 > steps;
        block.sunlight[k] = one_if(lit);
        unknown |= u32::from(!(lit | dark));
    }
    unknown == 0
}

/// Looks a block's sunlight up; whether leaves shade some of it.
#[inline(always)]
fn lit_through_leaves(block: &mut Block, map: &TownMap, places: &Places, noise: &NoiseTexture) -> bool {
    let Places { rows: [row_u, row_v], base_m, texels_m, corner_m, low, high } = *places;
    let mut under_leaves = [0.0f32; WIDE];
    let mut flecks = 0u32;
    for (k, under) in under_leaves.iter_mut().enumerate() {
        let (point, height) = lifted(block, k, base_m);
        let (u, v) = (affine(row_u, point), affine(row_v, point));
        let (dark, leaves) = darkness(map, SIDE, [low, high], u, v, height);
        block.sunlight[k] = 1.0 - dark;
        *under = dark * leaves;
        flecks |= u32::from(dark * leaves > 0.0);
    }
    if flecks != 0 {
        // Sun flecks: gaps between the leaves.
        for (k, under) in under_leaves.iter().enumerate() {
            let (point, _) = lifted(block, k, base_m);
            let u = (affine(row_u, point) - 0.5) * texels_m[0] + corner_m[0];
            let v = (affine(row_v, point) - 0.5) * texels_m[1] + corner_m[1];
            let gap = smoothstep(0.52, 0.70, noise.clumps(u * 18.0, v * 18.0, 1.5));
            block.sunlight[k] += under * (0.75 * gap);
        }
    }
    flecks != 0
}

simd_kernel! {
    pub(super) fn figure_shadow(blocks: &mut [Block], map: &FigureMap, side: usize, base_m: f32, rows: &[[f32; 4]; 2]) {
        let [row_u, row_v] = *rows;
        let limit = side as u32 as f32;
        for four in blocks.as_chunks_mut::<FOUR>().0 {
            let mut inside = 0u32;
            for block in [&four[0], &four[3]] {
                for k in 0..WIDE {
                    let (point, _) = lifted(block, k, base_m);
                    let (u, v) = (affine(row_u, point), affine(row_v, point));
                    inside |= u32::from((u > 0.0) & (v > 0.0) & (u < limit) & (v < limit));
                }
            }
            if inside != 0 {
                for block in four {
                    for k in 0..WIDE {
                        let (point, height) = lifted(block, k, base_m);
                        let (u, v) = (affine(row_u, point), affine(row_v, point));
                        let (dark, _) = darkness(map, FIGURE_SIDE, [[0.0; 2], [limit - 2.0; 2]], u, v, height + 0.04);
                        let lit = 1.0 - dark;
                        block.sunlight[k] = if lit < block.sunlight[k] { lit } else { block.sunlight[k] };
                    }
                }
            }
        }
    }
}

/// A pixel's place off its surface, so that a face does not shade itself where the map is coarse, and its height there.
#[inline(always)]
fn lifted(block: &Block, k: usize, base_m: f32) -> (Vec3, f32) {
    let normal = get(&block.normal, k);
    let lift = 0.05 + 0.30 * (1.0 - most(normal.z, 0.0));
    let point = get(&block.world, k) + normal * lift;
    (point, point.z + base_m + 0.05)
}

#[inline(always)]
fn affine(row: [f32; 4], point: Vec3) -> f32 {
    row[0] * point.x + row[1] * point.y + row[2] * point.z + row[3]
}

/// Share of a texel's size around a place that is above the height, and 1 when leaves are there; none outside of
/// `low`..`high`.
#[inline(always)]
fn darkness<const N: usize>(
    map: &[u32; N],
    side: usize,
    [low, high]: [[f32; 2]; 2],
    u: f32,
    v: f32,
    height_m: f32,
) -> (f32, f32) {
    let (u, v) = (u - 0.5, v - 0.5);
    let inside = (u >= low[0]) & (v >= low[1]) & (u < high[0]) & (v < high[1]);
    let (column, row) = (floor_int(u), floor_int(v));
    let (fx, fy) = (u - column as f32, v - row as f32);
    let at = (row as u32).wrapping_mul(side as u32).wrapping_add(column as u32);
    let upper = map[at as usize & (N - 1)];
    let lower = map[at.wrapping_add(side as u32) as usize & (N - 1)];
    let steps = height_m * STEPS_PER_M;
    let above = |texel: u32| one_if((texel >> 1) as i32 as f32 > steps);
    let dark = lerp(
        lerp(above(upper & 0xffff), above(upper >> 16), fx),
        lerp(above(lower & 0xffff), above(lower >> 16), fx),
        fy,
    );
    let leaves = (upper & 1) as i32 as f32;
    (if inside { dark } else { 0.0 }, leaves)
}
