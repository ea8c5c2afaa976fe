//! Shadow maps packed for look-up, and the share of the sun's light at each pixel's place.

use cosfly_frames::simd_kernel;
use cosfly_materials::lanes::{Block, FOUR, PixelLane, WIDE, get};
use cosfly_materials::pattern::{NoiseTexture, Noises, floor_int, least, lerp, most, one_if, smoothstep};
use cosfly_materials::vector::Vec3;
use cosfly_raster::shadow_frame::DEPTH_M;
use std::sync::Arc;

/// Sizes of texels.
pub(super) const GRAINS: usize = 4;
/// Tiles along a side of a view's window into the map.
pub(super) const WINDOW_TILES: i32 = 8;
/// Texels along a side of a tile of the town's map, and of its window there.
pub(super) const TILE: usize = 128;
/// Rows of a tile's texels, with the first of the tile below.
pub(super) const PACKED_ROWS: usize = TILE + 1;
/// Squares of texels along a side of a tile whose least and greatest heights are kept.
pub(super) const SUMMARY_SIDE: usize = TILE >> IN_SQUARE;
/// Texels along a side of the map of a body that is large on the screen.
pub(super) const FIGURE_SIDE: usize = 128;
/// Content of a texel of the town's map.
pub(super) const SOLID: u32 = 0;
pub(super) const LEAVES: u32 = 1;

/// A figure's own map.
pub(super) struct FigureShadow {
    pub(super) map: Box<FigureMap>,
    /// Number of rows and columns in use.
    pub(super) side: usize,
    /// Where it lies; nowhere without a shadow.
    pub(super) rows: Option<[[f32; 4]; 2]>,
}

/// Place of the town's map.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Places {
    /// Coordinates of the finest texels, from a corner near the view.
    pub(super) rows: [[f32; 4]; 2],
    pub(super) base_m: f32,
    /// Steps of the heights in a metre.
    pub(super) steps_per_m: f32,
    /// Size of the finest texels, metres.
    pub(super) texel_m: f32,
    /// The corner over the sheared ground, metres.
    pub(super) corner_m: [f32; 2],
    pub(super) grains: [Grain; GRAINS],
    /// [`COVERED`] for places on surfaces that are not in the map, else 0.
    pub(super) hidden_by: u32,
    /// Gaps in crowns, see [`Season::gaps`].
    pub(super) gaps: [f32; 3],
    /// Sizes of texels that this frame reads, from the finest.
    pub(super) used: usize,
}

/// Place of the texels of a size: coordinates of the finest times `scale` plus `shift`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Grain {
    pub(super) scale: [f32; 2],
    pub(super) shift: [f32; 2],
    /// Coordinates within which this frame reads them.
    pub(super) low: [f32; 2],
    pub(super) high: [f32; 2],
}

/// Texels of a tile. A number holds a texel in its low half and the one to the right in its high half: one for leaves, the number
/// of its samples that throw its shadow, less one, times two, and eight times the height above [`LOWEST_M`] below the reference in steps
/// of the sun. In the order of [`in_tile`].
#[repr(align(64))]
pub(super) struct Texels(pub(super) [u32; TILE * TILE]);
/// Windows of all sizes of texels, one after the other: their tiles.
pub(super) type TownMap = [Arc<Texels>; WINDOWS];
/// Tiles of all windows.
pub(super) const WINDOWS: usize = GRAINS * (WINDOW_TILES * WINDOW_TILES) as usize;
/// Summary of each square of texels, and those right and below of it: the least of their floors in the low half, see [`Samples`],
/// and the greatest height in the high half; steps.
pub(super) type SummaryMap = [u32; GRAINS * SQUARES * SQUARES];
pub(super) type SummaryOfTile = [u32; SUMMARY_SIDE * SUMMARY_SIDE];
type FigureMap = [u32; FIGURE_TEXELS];
/// Rows of the fields of [`Samples`].
type SampleRows<'a> = (&'a mut [f32], &'a mut [u32], &'a mut [f32]);

/// A power of two that holds the map.
const FIGURE_TEXELS: usize = 1 << 14;
/// Squares along a side of a window.
const SQUARES: usize = WINDOW_TILES as usize * SUMMARY_SIDE;
/// Bits of a texel's column or row within its square.
const IN_SQUARE: u32 = 2;
/// Nothing lower than this below the reference casts a shadow.
pub(super) const LOWEST_M: f64 = 16.0;
/// Most steps of a town's heights.
pub(super) const MOST_STEPS: f32 = 4095.0;
/// Most steps of a figure's heights, and steps in a metre.
const FIGURE_STEPS: [f32; 2] = [65535.0, 32.0];
/// Samples of a texel.
pub(super) const SAMPLES: usize = 4;
/// Bits of a town's texel below its height, and those of them that hold the number of samples.
const BELOW_HEIGHT: u32 = 4;
const FULL: u32 = 6;
/// The bit that says that the other samples of a texel are covered, too: what is no surface of the map lies in shadow.
pub(super) const COVERED: u32 = 8;

/// Height in steps above the lowest.
#[inline(always)]
fn in_steps(height_m: f32, most_steps: f32, steps_per_m: f32) -> u32 {
    let lowest = (DEPTH_M - LOWEST_M) as f32;
    // Adding 2^23 leaves the nearest whole number in the low bits.
    let steps = least(most((height_m - lowest) * steps_per_m, 0.0), most_steps) + 8_388_608.0;
    steps.to_bits() & 0xffff
}

/// Samples of texels: those near the highest of a texel count, for they throw the shadow whose edge is seen on the next surface.
pub(super) struct Samples {
    /// Sums of the heights of those that count.
    pub(super) sums: Vec<f32>,
    /// How many they are, eight where one of them is leaves, and 16 for each that is covered at all.
    pub(super) seen: Vec<u32>,
    /// The least height of all, 0 where something is open or leaves: everything below is dark.
    pub(super) floors: Vec<f32>,
}

simd_kernel! {
    /// Adds a sample of each texel of a row; `gap_m` lies between heights of two surfaces, of which the lower one does not count:
    /// the shadow's edge on a roof is as exact as on the ground.
    pub(super) fn add_sample(heights: &[f32], classes: &[u32], gap_m: f32, rows: SampleRows<'_>) {
        let (sums, seen, floors) = rows;
        let rest = sums.iter_mut().zip(seen).zip(floors);
        for ((height_m, class), ((sum, seen), floor)) in heights.iter().zip(classes).zip(rest) {
            let is_covered = u32::from(*height_m > 0.0);
            let is_leaves = u32::from(*class == LEAVES);
            let above_m = *height_m - *sum / most((*seen & 7) as i32 as f32, 1.0);
            let is_higher = 0u32.wrapping_sub(is_covered & u32::from(above_m > gap_m));
            let counts = is_covered & u32::from(above_m >= -gap_m);
            *sum = f32::from_bits(sum.to_bits() & !is_higher) + if counts == 1 { *height_m } else { 0.0 };
            *seen = (*seen & (!is_higher | 0xf0)).wrapping_add(counts | is_covered << 4) | (counts & is_leaves) << 3;
            *floor = least(*floor, if is_covered & !is_leaves == 1 { *height_m } else { 0.0 });
        }
    }
}

simd_kernel! {
    /// Packs the first `side` rows and columns of a figure's map.
    pub(super) fn pack_figure(heights: &[f32], side: usize, packed: &mut FigureMap) {
        let rows = heights.chunks_exact(FIGURE_SIDE).zip(packed.chunks_exact_mut(FIGURE_SIDE));
        for (heights, packed) in rows.take(side) {
            for (packed, height_m) in packed.iter_mut().zip(heights).take(side) {
                *packed = in_steps(*height_m, FIGURE_STEPS[0], FIGURE_STEPS[1]);
            }
            for column in 1..side.min(FIGURE_SIDE) {
                packed[column.wrapping_sub(1)] |= packed[column] << 16;
            }
        }
    }
}

simd_kernel! {
    /// Packs a tile from rows `width` apart, with the first row and column of the tiles below and to the right; whether
    /// anything stands there. Heights are the means of the samples: that of a flat face is right in the texel's middle.
    pub(super) fn pack_tile(sums: &[f32], seen: &[u32], width: usize, steps_per_m: f32, packed: &mut [u32]) -> bool {
        let mut anything = 0u32;
        for (row, packed) in packed.chunks_exact_mut(TILE).enumerate().take(PACKED_ROWS) {
            let from = row.wrapping_mul(width);
            let (Some(sums), Some(seen)) = (
                sums.get(from..).and_then(|rest| rest.first_chunk::<PACKED_ROWS>()),
                seen.get(from..).and_then(|rest| rest.first_chunk::<PACKED_ROWS>()),
            ) else {
                return false;
            };
            let mut single = [0u32; PACKED_ROWS];
            for ((single, sum), seen) in single.iter_mut().zip(sums).zip(seen) {
                let covered = seen & 7;
                let steps = in_steps(*sum / most(covered as i32 as f32, 1.0), MOST_STEPS, steps_per_m);
                let others = COVERED * (seen >> 6);
                let texel = steps << BELOW_HEIGHT | others | covered.wrapping_sub(1) << 1 | (seen >> 3) & 1;
                *single = texel & 0u32.wrapping_sub(u32::from(covered > 0));
            }
            for (k, packed) in packed.iter_mut().enumerate().take(TILE) {
                *packed = single[k] | single[k.wrapping_add(1)] << 16;
                anything |= *packed;
            }
        }
        anything != 0
    }
}

impl Texels {
    /// The texels of a packed tile, which come row by row.
    pub(super) fn of(packed: &[u32]) -> Self {
        let mut texels = [0; TILE * TILE];
        for (row, packed) in (0..).zip(packed.chunks_exact(TILE).take(TILE)) {
            for (column, texel) in (0..).zip(packed) {
                texels[in_tile(column, row) as usize] = *texel;
            }
        }
        Self(texels)
    }
}

simd_kernel! {
    /// Measures the squares of a packed tile, whose floors lie in rows `width` apart.
    pub(super) fn measure_tile(packed: &[u32], floors: &[f32], width: usize, steps_per_m: f32, summary: &mut SummaryOfTile) {
        const TEXELS: usize = 1 << IN_SQUARE;
        for row in 0..SUMMARY_SIDE {
            for column in 0..SUMMARY_SIDE {
                let (mut lowest, mut greatest) = ([f32::MAX; TEXELS + 1], [0u32; TEXELS]);
                for below in row * TEXELS..=(row + 1) * TEXELS {
                    let texels = packed.get(below * TILE + column * TEXELS..).and_then(|rest| rest.first_chunk::<TEXELS>());
                    let floors = floors.get(below * width + column * TEXELS..).and_then(|rest| rest.first_chunk());
                    let (Some(texels), Some(floors)) = (texels, floors) else { continue };
                    for k in 0..TEXELS {
                        greatest[k] = greatest[k].max(texels[k] & 0xffff).max(texels[k] >> 16);
                    }
                    for (lowest, floor) in lowest.iter_mut().zip::<&[f32; TEXELS + 1]>(floors) {
                        *lowest = least(*lowest, *floor);
                    }
                }
                let lowest = lowest.into_iter().fold(f32::MAX, least);
                let greatest = greatest.into_iter().fold(0, u32::max) >> BELOW_HEIGHT;
                summary[row * SUMMARY_SIDE + column] = in_steps(lowest, MOST_STEPS, steps_per_m) | greatest << 16;
            }
        }
    }
}

simd_kernel! {
    pub(super) fn town_sunlight(
        blocks: &mut [Block],
        map: &TownMap,
        summary: &SummaryMap,
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
                let (spots, sunlight) = (spots(&four[pixel], &places), &mut four[pixel].sunlight);
                let unknown = lit_by_squares(sunlight, &spots, summary, places.steps_per_m);
                if unknown != [0; WIDE] {
                    alike &= !lit_through_leaves(sunlight, &unknown, &spots, map, &places, noise);
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

/// Places of sixteen pixels in the town's map, each among the finest texels that a frame has there.
struct Spots {
    /// Coordinates of the finest texels.
    finest: [PixelLane; 2],
    /// Heights over the map's lowest, metres.
    height_m: PixelLane,
    u: PixelLane,
    v: PixelLane,
    /// Number of the size of texels, from the finest.
    grain: [u32; WIDE],
    /// 1 where the map tells of the place.
    known: [u32; WIDE],
}

/// Finds a block's places. Sizes of texels are the outer loop: the inner one becomes vector code.
#[inline(always)]
fn spots(block: &Block, places: &Places) -> Spots {
    let mut spots = Spots {
        finest: [[0.0; WIDE]; 2],
        height_m: [0.0; WIDE],
        u: [0.0; WIDE],
        v: [0.0; WIDE],
        grain: [0; WIDE],
        known: [0; WIDE],
    };
    for k in 0..WIDE {
        let (point, height_m) = lifted(block, k, places.base_m);
        spots.finest[0][k] = affine(places.rows[0], point);
        spots.finest[1][k] = affine(places.rows[1], point);
        spots.height_m[k] = height_m;
    }
    for (number, grain) in places.grains.iter().enumerate().take(places.used) {
        let mut all_known = 1;
        for k in 0..WIDE {
            let u = spots.finest[0][k] * grain.scale[0] + grain.shift[0];
            let v = spots.finest[1][k] * grain.scale[1] + grain.shift[1];
            let inside = (u >= grain.low[0]) & (v >= grain.low[1]) & (u < grain.high[0]) & (v < grain.high[1]);
            // What finer texels told stays. Bits are added to none: a choice would become masked stores, which are slow.
            let new = 0u32.wrapping_sub(u32::from(inside & (spots.known[k] == 0)));
            spots.u[k] = f32::from_bits(spots.u[k].to_bits() | (u.to_bits() & new));
            spots.v[k] = f32::from_bits(spots.v[k].to_bits() | (v.to_bits() & new));
            spots.grain[k] |= number as u32 & new;
            spots.known[k] |= u32::from(inside);
            all_known &= spots.known[k];
        }
        if all_known != 0 {
            break;
        }
    }
    spots
}

/// Looks a block's sunlight up in whole squares, which tells the same wherever a square is all above or all below the
/// places; 1 for those of which it does not tell.
#[inline(always)]
fn lit_by_squares(sunlight: &mut PixelLane, spots: &Spots, summary: &SummaryMap, steps_per_m: f32) -> [u32; WIDE] {
    const BITS: u32 = SQUARES.trailing_zeros();
    const MASK: u32 = SQUARES as u32 - 1;
    let mut unknown = [0u32; WIDE];
    for (k, sunlight) in sunlight.iter_mut().enumerate() {
        let column = floor_int(spots.u[k] - 0.5) as u32 >> IN_SQUARE;
        let row = floor_int(spots.v[k] - 0.5) as u32 >> IN_SQUARE;
        let at = (spots.grain[k] << (2 * BITS)) | ((row & MASK) << BITS) | (column & MASK);
        let square = summary[at as usize & (GRAINS * SQUARES * SQUARES - 1)];
        let steps = spots.height_m[k] * steps_per_m;
        let lit = (spots.known[k] == 0) | ((square >> 16) as i32 as f32 <= steps);
        let dark = (square & 0xffff) as i32 as f32 > steps;
        *sunlight = one_if(lit);
        unknown[k] = u32::from(!(lit | dark));
    }
    unknown
}

/// Looks the sunlight of a block's unknown places up; whether leaves shade some of them. Texels are scattered over memory: they are
/// loaded one after the other, between vector code.
#[inline(always)]
fn lit_through_leaves(
    sunlight: &mut PixelLane,
    unknown: &[u32; WIDE],
    spots: &Spots,
    map: &TownMap,
    places: &Places,
    noise: &NoiseTexture,
) -> bool {
    let (mut tiles, mut texels) = ([[0u32; WIDE]; 2], [[0u32; WIDE]; 2]);
    for k in 0..WIDE {
        let (column, row) = (floor_int(spots.u[k] - 0.5) as u32, floor_int(spots.v[k] - 0.5) as u32);
        // The first texel serves those that are known.
        let taken = 0u32.wrapping_sub(unknown[k]);
        for below in 0..2 {
            let (tile, at) = place_of(spots.grain[k], column, row.wrapping_add(below as u32));
            (tiles[below][k], texels[below][k]) = (tile & taken, at & taken);
        }
    }
    let mut found = [[0u32; WIDE]; 2];
    for below in 0..2 {
        for k in 0..WIDE {
            let tile = &map[tiles[below][k] as usize & (WINDOWS - 1)].0;
            found[below][k] = tile[texels[below][k] as usize & (TILE * TILE - 1)];
        }
    }
    let mut under_leaves = [0.0f32; WIDE];
    let mut flecks = 0u32;
    for k in 0..WIDE {
        let (u, v) = (spots.u[k] - 0.5, spots.v[k] - 0.5);
        let (fx, fy) = (u - floor_int(u) as f32, v - floor_int(v) as f32);
        // Texels from this on are higher.
        let higher = floor_int(spots.height_m[k] * places.steps_per_m).wrapping_add(1) << BELOW_HEIGHT;
        let dark = between(found[0][k], found[1][k], [fx, fy], |texel| {
            let covered = (texel & FULL) as i32 as f32 * (0.5 / SAMPLES as f32) + 1.0 / SAMPLES as f32;
            let covered = if texel & places.hidden_by == 0 { covered } else { 1.0 };
            if texel as i32 >= higher { covered } else { 0.0 }
        });
        let either = found[0][k] | found[1][k];
        // Leaves at one of the four: no dark line around the flecks.
        let leaves = ((either | (either >> 16)) & 1) as i32 as f32;
        let is_unknown = unknown[k] as i32 as f32;
        // Nothing so far where it is unknown.
        sunlight[k] += is_unknown * (1.0 - dark);
        under_leaves[k] = is_unknown * dark * leaves;
        flecks |= u32::from(under_leaves[k] > 0.0);
    }
    if flecks != 0 {
        let [from, to, light] = places.gaps;
        // Sun flecks: gaps between the leaves.
        for (k, under) in under_leaves.iter().enumerate() {
            let u = spots.finest[0][k] * places.texel_m + places.corner_m[0];
            let v = spots.finest[1][k] * places.texel_m + places.corner_m[1];
            let gap = smoothstep(from, to, noise.clumps(u * 18.0, v * 18.0, 1.5));
            sunlight[k] += under * (light * gap);
        }
    }
    flecks != 0
}

/// Number of a texel's tile among those of all windows, and of the texel in it, by its place modulo the window.
#[inline(always)]
fn place_of(grain: u32, column: u32, row: u32) -> (u32, u32) {
    const BITS: u32 = TILE.trailing_zeros();
    const ACROSS: u32 = (WINDOW_TILES as u32).trailing_zeros();
    let tile_of = |place: u32| (place >> BITS) & (WINDOW_TILES as u32 - 1);
    let tile = (((grain << ACROSS) | tile_of(row)) << ACROSS) | tile_of(column);
    (tile, in_tile(column & (TILE as u32 - 1), row & (TILE as u32 - 1)))
}

/// Number of a texel in its tile: squares of texels lie one after the other, each in a line of the cache.
#[inline(always)]
fn in_tile(column: u32, row: u32) -> u32 {
    const WITHIN: u32 = (1 << IN_SQUARE) - 1;
    let square = (row >> IN_SQUARE) << (TILE.trailing_zeros() - IN_SQUARE) | column >> IN_SQUARE;
    square << (2 * IN_SQUARE) | (row & WITHIN) << IN_SQUARE | column & WITHIN
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
                        let lit = 1.0 - figure_darkness(map, limit - 2.0, u, v, height + 0.04);
                        block.sunlight[k] -= most(block.sunlight[k] - lit, 0.0);
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

/// Share of a texel's size around a place of a figure's map that is above the height; none outside of it.
#[inline(always)]
fn figure_darkness(map: &FigureMap, limit: f32, u: f32, v: f32, height_m: f32) -> f32 {
    let (u, v) = (u - 0.5, v - 0.5);
    let inside = (u >= 0.0) & (v >= 0.0) & (u < limit) & (v < limit);
    let (column, row) = (floor_int(u), floor_int(v));
    let at = (row as u32).wrapping_mul(FIGURE_SIDE as u32).wrapping_add(column as u32);
    let upper = map[at as usize & (FIGURE_TEXELS - 1)];
    let lower = map[at.wrapping_add(FIGURE_SIDE as u32) as usize & (FIGURE_TEXELS - 1)];
    let steps = height_m * FIGURE_STEPS[1];
    let dark = between(upper, lower, [u - column as f32, v - row as f32], |texel| one_if(texel as i32 as f32 > steps));
    if inside { dark } else { 0.0 }
}

/// The share of four texels that is `dark`, at a place between them.
#[inline(always)]
fn between(upper: u32, lower: u32, [fx, fy]: [f32; 2], dark: impl Fn(u32) -> f32) -> f32 {
    lerp(lerp(dark(upper & 0xffff), dark(upper >> 16), fx), lerp(dark(lower & 0xffff), dark(lower >> 16), fx), fy)
}
