//! Shadows: heights of what first catches the sun's light, over ground sheared along the light.
//!
//! A point (x, y, z) and every point on its ray towards the sun fall on the same place of the map,
//! `(x, y) - (z - reference) * sun.xy / sun.z`; it is in shadow when the map's height there is above z.

use crate::eye::Eye;
use crate::figure::FigureTriangle;
use crate::frame::TARGET_INSTANCE;
use crate::people::People;
use crate::scene::Scene;
use crate::scene_parts::BOX_FACES;
use crate::shade::lanes::{Block, FOUR, WIDE, get};
use crate::shade::pattern::{NoiseTexture, Noises, fixed_size, floor_int, least, lerp, most, one_if, smoothstep};
use crate::shade::shadow_region::{Region, for_seen_points};
use crate::shade::vector::Vec3;
use crate::visibility::{PlaneOnScreen, Screen, Visibility};
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec2, DVec3, simd_kernel};
use cosfly_maps::ObstacleKind;

/// Texels along a side of the town's map.
const SIDE: usize = 1536;
/// Size of its texels across the sun's direction, metres; along it they grow as the sun sinks.
const TEXEL_M: f64 = 0.2;
/// The town's map moves in steps of this many texels, so that it depends on the frame alone and still is mostly reused.
const STEP_TEXELS: f64 = 128.0;
/// Texels along a side of the target's own map.
const FIGURE_SIDE: usize = 96;
/// People less high than this on the screen throw no shadow, pixels.
const LEAST_FIGURE_PX: f64 = 4.0;
/// Texels along a side of the maps of other people, by their least height on the screen, pixels.
const SIDES_BY_HEIGHT: [(f64, usize); 3] = [(48.0, FIGURE_SIDE), (20.0, 48), (LEAST_FIGURE_PX, 24)];
/// Heights in the maps are above this level below the reference, so that all are positive.
const DEPTH_M: f64 = 1000.0;
/// Posts thinner than this cast the shadow of a post this thick, half width in metres: the map would tear them.
const LEAST_HALF_WIDTH_M: f64 = 0.13;

/// Places this near what the view shows are drawn, too, metres: shading moves points a little.
const MARGIN_M: f64 = 3.0;

/// Content of a texel of the town's map.
const SOLID: u32 = 0;
const LEAVES: u32 = 1;

/// Place of a map. The v axis runs along the sun's direction over the ground, so that upright edges,
/// whose shadows run that way, follow the texels and do not turn into stairs.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Frame {
    /// Sheared ground coordinates of texel (0, 0), along `axes`, metres.
    corner_m: DVec2,
    reference_m: f64,
    shear: DVec2,
    axes: [DVec2; 2],
    texels_m: DVec2,
}

impl Frame {
    /// Sheared ground coordinates along the axes, metres.
    fn sheared(&self, point: DVec3) -> DVec2 {
        let at = point.truncate() - (point.z - self.reference_m) * self.shear;
        DVec2::new(at.dot(self.axes[0]), at.dot(self.axes[1]))
    }

    fn place(&self, point: DVec3) -> [f64; 2] {
        ((self.sheared(point) - self.corner_m) / self.texels_m).to_array()
    }

    /// Whether a box around `center`, `half` its size along the world's axes, casts no shadow into a part of the map.
    fn misses(&self, part: &Region, center: DVec3, half: DVec3) -> bool {
        let at = self.place(center);
        (0..2).any(|k| {
            let axis = self.axes[k] / self.texels_m[k];
            let reach = axis.abs().dot(half.truncate()) + self.shear.dot(axis).abs() * half.z + 1.0;
            !(at[k] + reach > part.first[k] as f64 && at[k] - reach < part.end[k] as f64)
        })
    }

    fn height(&self, point: DVec3) -> f64 {
        point.z - self.reference_m + DEPTH_M
    }

    /// `place` as an affine map in f32: rows of (x, y, z, 1).
    fn rows(&self) -> [[f32; 4]; 2] {
        [0, 1].map(|k| {
            let axis = self.axes[k] / self.texels_m[k];
            let slope = -self.shear.dot(axis);
            let constant = -slope * self.reference_m - self.corner_m[k] / self.texels_m[k];
            [axis.x as f32, axis.y as f32, slope as f32, constant as f32]
        })
    }
}

/// The town's shadows and the figures'.
pub struct Shadows {
    town: Visibility,
    /// The scene and the place of the map that is drawn, and which part of it.
    town_drawn: Option<(u64, Frame, Region)>,
    /// A scene and the height of its lowest place, metres.
    lowest_m: Option<(u64, f64)>,
    figure: Visibility,
    packed: Packed,
}

/// Maps as the kernel reads them. A number holds a texel in its low half and the one to the right in its high half:
/// height above [`LOWEST_M`] below the reference in steps of 1/32 m, times two, plus one for leaves.
struct Packed {
    town: Box<TownMap>,
    tiles: Box<TileMap>,
    /// One for each of a frame's people, and some that wait to be used again.
    figures: Vec<FigureShadow>,
    places: Places,
}

/// A figure's own map, and where it lies; nowhere without a shadow.
struct FigureShadow {
    map: Box<FigureMap>,
    /// Number of rows and columns in use.
    side: usize,
    rows: Option<[[f32; 4]; 2]>,
}

/// Place of the town's map.
#[derive(Clone, Copy, Debug, Default)]
struct Places {
    rows: [[f32; 4]; 2],
    base_m: f32,
    texels_m: [f32; 2],
    corner_m: [f32; 2],
    /// Map coordinates within which this frame sees shadows.
    low: [f32; 2],
    high: [f32; 2],
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
const LOWEST_M: f64 = 200.0;
/// Steps per metre of packed heights.
const STEPS_PER_M: f32 = 32.0;

simd_kernel! {
    /// Packs a part of a map `side` texels wide.
    fn pack(heights: &[f32], classes: &[u32], side: usize, part: &Region, packed: &mut [u32]) {
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
    fn measure_tiles(map: &TownMap, part: &Region, tiles: &mut TileMap) {
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

impl Shadows {
    /// Empty maps.
    pub fn new() -> Self {
        Self {
            town: Visibility::new(SIDE, SIDE),
            town_drawn: None,
            lowest_m: None,
            figure: Visibility::new(FIGURE_SIDE, FIGURE_SIDE),
            packed: Packed {
                town: fixed_size(vec![]),
                tiles: fixed_size(vec![]),
                figures: Vec::new(),
                places: Places::default(),
            },
        }
    }

    /// Makes the maps right for a frame; draws the town's only when the view or the sun moved enough.
    pub(crate) fn prepare(
        &mut self,
        level: Level,
        scene: &Scene,
        (eye, screen): (&Eye, &Screen),
        to_sun: Vec3,
        people: &People,
    ) {
        let flat = DVec2::new(f64::from(to_sun.x), f64::from(to_sun.y));
        let shear = flat / f64::from(to_sun.z);
        let along = if flat.length() > 1e-6 { flat.normalize() } else { DVec2::Y };
        let axes = [DVec2::new(-along.y, along.x), along];
        let texels_m = TEXEL_M * DVec2::new(1.0, shear.length().clamp(1.0, 3.0));
        let ahead = eye.position_in_world + 90.0 * eye.world_from_body.x_axis;
        let ground = f64::from(scene.grid.sample(ahead.x as f32, ahead.y as f32).ground_m);
        let reference_m = (ground / 8.0).round() * 8.0;
        let mut frame = Frame { corner_m: DVec2::ZERO, reference_m, shear, axes, texels_m };
        let middle = frame.sheared(DVec3::new(ahead.x, ahead.y, reference_m));
        let step = STEP_TEXELS * texels_m;
        frame.corner_m = (middle / step).round() * step - 0.5 * SIDE as f64 * texels_m;
        let region = self.region_seen(scene, eye, screen, &frame);
        let drawn = self.town_drawn.filter(|(id, drawn, _)| (*id, *drawn) == (scene.identity, frame));
        let wanted = drawn.map_or(region, |(.., drawn)| drawn.with(region));
        if drawn.is_none_or(|(.., drawn)| drawn != wanted) {
            self.town_drawn = Some((scene.identity, frame, wanted));
            self.draw_town(level, scene, &frame, to_sun, wanted);
        }
        for (position, person) in people.members.iter().enumerate() {
            if self.packed.figures.len() <= position {
                self.packed.figures.push(FigureShadow { map: fixed_size(vec![]), side: 0, rows: None });
            }
            let by_height = SIDES_BY_HEIGHT.iter().find(|(least_px, _)| person.height_px >= *least_px);
            let side = match person.instance {
                TARGET_INSTANCE => FIGURE_SIDE,
                _ => by_height.map_or(0, |(_, side)| *side),
            };
            let triangles = &people.triangles[person.triangles.clone()];
            let drawn = if side > 0 { self.draw_figure(&frame, to_sun, triangles, side) } else { None };
            let figure = &mut self.packed.figures[position];
            (figure.side, figure.rows) = (side, drawn.map(|frame| frame.rows()));
            if figure.rows.is_some() {
                let (heights, classes) = (&self.figure.inverse_depth, &self.figure.face);
                let whole = Region { first: [0; 2], end: [side; 2] };
                pack(level, heights, classes, FIGURE_SIDE, &whole, &mut *figure.map);
            }
        }
        self.packed.places = Places {
            rows: frame.rows(),
            base_m: (LOWEST_M - reference_m) as f32,
            texels_m: texels_m.as_vec2().to_array(),
            corner_m: frame.corner_m.as_vec2().to_array(),
            low: region.first.map(|texel| texel as f32 + 0.5),
            high: region.end.map(|texel| texel as f32 - 2.0),
        };
    }

    /// The part of the town's map that a view may need, in whole steps: it depends on the frame alone.
    fn region_seen(&mut self, scene: &Scene, eye: &Eye, screen: &Screen, frame: &Frame) -> Region {
        let lowest_m = match self.lowest_m {
            Some((id, lowest_m)) if id == scene.identity => lowest_m,
            _ => lowest_place_m(scene),
        };
        self.lowest_m = Some((scene.identity, lowest_m));
        let margin = MARGIN_M / frame.texels_m;
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for_seen_points(eye, screen, lowest_m, |point| {
            let place = DVec2::from_array(frame.place(point));
            low = low.min(place - margin);
            high = high.max(place + margin);
        });
        Region::around(low, high, SIDE, STEP_TEXELS as usize)
    }

    fn draw_town(&mut self, level: Level, scene: &Scene, frame: &Frame, to_sun: Vec3, part: Region) {
        self.town.clear_part(part.first, part.end);
        let to_sun = DVec3::new(f64::from(to_sun.x), f64::from(to_sun.y), f64::from(to_sun.z));
        for b in &scene.boxes {
            let class = if b.kind == ObstacleKind::TreeCrown { LEAVES } else { SOLID };
            let thin = f64::from(b.half_extents_m.x.min(b.half_extents_m.y));
            let grow = (LEAST_HALF_WIDTH_M / thin.max(0.01)).clamp(1.0, 8.0);
            let upright = b.half_extents_m.z > b.half_extents_m.x.max(b.half_extents_m.y);
            let wide = if upright { DVec3::new(grow, grow, 1.0) } else { DVec3::ONE };
            if frame.misses(&part, b.center_in_world, wide * b.half_bounds_m) {
                continue;
            }
            for (face, (_, _, around)) in BOX_FACES.iter().enumerate() {
                let normal = b.normal_in_world(face);
                if normal.dot(to_sun) > 1e-6 {
                    let corners = around
                        .map(|corner| b.center_in_world + wide * (b.corners_in_world[corner] - b.center_in_world));
                    draw(&mut self.town, (frame, part), to_sun, normal, &corners, class);
                }
            }
        }
        pack(level, &self.town.inverse_depth, &self.town.face, SIDE, &part, &mut *self.packed.town);
        measure_tiles(level, &self.packed.town, &part, &mut self.packed.tiles);
    }

    /// Draws a figure's shadow into the first `side` rows and columns of the scratch map; says where they lie.
    fn draw_figure(
        &mut self,
        town_frame: &Frame,
        to_sun: Vec3,
        triangles: &[FigureTriangle],
        side: usize,
    ) -> Option<Frame> {
        self.figure.clear_part([0; 2], [side; 2]);
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for corner in triangles.iter().flat_map(|triangle| triangle.corners_in_world) {
            let at = town_frame.sheared(corner);
            low = low.min(at);
            high = high.max(at);
        }
        let size = high - low;
        if !size.is_finite() || size.min_element() <= 0.0 || size.max_element() > 100.0 {
            return None;
        }
        let texels_m = size / (side as f64 - 4.0);
        let whole = Region { first: [0; 2], end: [side; 2] };
        let frame = Frame { corner_m: low - 2.0 * texels_m, texels_m, ..*town_frame };
        let to_sun = DVec3::new(f64::from(to_sun.x), f64::from(to_sun.y), f64::from(to_sun.z));
        for triangle in triangles.iter().filter(|triangle| triangle.normal_in_world.dot(to_sun) > 1e-6) {
            let normal = triangle.normal_in_world;
            draw(&mut self.figure, (&frame, whole), to_sun, normal, &triangle.corners_in_world, SOLID);
        }
        Some(frame)
    }

    /// Fills in which share of the sun's light reaches each pixel's place. On flat surfaces, the pixels between the ends
    /// of a four that are lit alike are lit like them. Of people, only those numbered in `near` count.
    pub fn sunlight(&self, level: Level, blocks: &mut [Block], flat: bool, noise: &NoiseTexture, near: &[u32]) {
        let Packed { town, tiles, places, .. } = &self.packed;
        town_sunlight(level, blocks, town, tiles, places, flat, noise);
        for figure in near.iter().filter_map(|person| self.packed.figures.get(*person as usize)) {
            if let Some(rows) = &figure.rows {
                figure_shadow(level, blocks, &figure.map, figure.side, self.packed.places.base_m, rows);
            }
        }
    }
}

simd_kernel! {
    fn town_sunlight(
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
    fn figure_shadow(blocks: &mut [Block], map: &FigureMap, side: usize, base_m: f32, rows: &[[f32; 4]; 2]) {
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

/// Height of the lowest box or ground.
fn lowest_place_m(scene: &Scene) -> f64 {
    let boxes = scene.boxes.iter().map(|b| b.center_in_world.z - b.half_bounds_m.z);
    let ground = scene.clusters.iter().map(|cluster| cluster.center_in_world.z - cluster.half_bounds_m.z);
    boxes.chain(ground).fold(f64::INFINITY, f64::min)
}

/// Draws a face that the sun shines on, where a part of the map needs it: its height is affine over the sheared ground.
fn draw(
    map: &mut Visibility,
    (frame, part): (&Frame, Region),
    to_sun: DVec3,
    normal: DVec3,
    corners: &[DVec3],
    class: u32,
) {
    let mut points = [[0.0; 2]; 4];
    for (point, corner) in points.iter_mut().zip(corners) {
        *point = frame.place(*corner);
    }
    let points = &points[..corners.len().min(4)];
    let Some(rows) = map.rows_within(points, part.first, part.end) else { return };
    // Along the map's x axis the face's point moves by (1, 0, 0) + slope * sun / sun.z with no way along the normal.
    let facing = normal.dot(to_sun) / to_sun.z;
    let slope = -normal.truncate() / facing;
    let across = slope.dot(frame.axes[0]) * frame.texels_m.x;
    let down = slope.dot(frame.axes[1]) * frame.texels_m.y;
    let constant = frame.height(corners[0]) - across * points[0][0] - down * points[0][1];
    map.draw_rows(points, rows, &PlaneOnScreen { constant, across, down }, class);
}
