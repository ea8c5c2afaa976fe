//! Pitched roofs: the steps of their boxes drawn as slopes of tiles.

use super::draws;
use crate::lanes::{Block, Shared, WIDE, get, groups, set};
use crate::parts::SceneBox;
use crate::pattern::{NoiseTexture, Noises, band, draw, floor_int, hash, lerp, most, one_if, share, stripes, unit};
use crate::roof_step::{RoofPitch, TopSlope};
use crate::surface::{Look, SurfacePoint};
use crate::vector::Vec3;
use cosfly_frames::simd_kernel;

/// Height above a step at which its sunlight is looked up, metres: no step shades the next one there.
const ABOVE_STEPS_M: f32 = 1.1;
/// Height of a course of tiles along the slope, and width of a tile, metres.
const TILE_M: [f32; 2] = [0.34, 0.24];
/// Colours of tiles, linear RGB: red, brown, dark, slate.
const TONES: [Vec3; 6] = [
    Vec3::new(0.40, 0.16, 0.09),
    Vec3::new(0.34, 0.18, 0.12),
    Vec3::new(0.26, 0.11, 0.08),
    Vec3::new(0.24, 0.16, 0.11),
    Vec3::new(0.15, 0.15, 0.165),
    Vec3::new(0.22, 0.21, 0.20),
];

/// Places for windows in a roof, per metre along the eaves; half the width and length of a window, width of its frame, metres.
const WINDOWS_PER_M: f32 = 1.0 / 3.1;
const WINDOW_M: [f32; 2] = [0.42, 0.62];
const FRAME_M: f32 = 0.07;
/// Nothing lies nearer to the ends of a slope, metres.
const EDGE_M: f32 = 1.3;
/// The lowest roof with windows, metres.
const LEAST_RISE_M: f32 = 2.2;
/// Width and length of a panel for sunlight, metres.
const PANEL_M: [f32; 2] = [1.05, 1.72];
const PANE: Vec3 = Vec3::new(0.085, 0.11, 0.14);
const FRAME: Vec3 = Vec3::new(0.045, 0.045, 0.05);
const PANEL: Vec3 = Vec3::new(0.016, 0.020, 0.034);

simd_kernel! {
    /// Moves places on steps to above all steps, where the sun's light on the slope is that of its surroundings.
    pub fn lift(blocks: &mut [Block]) {
        for block in blocks.iter_mut() {
            for k in 0..WIDE {
                let place = get(&block.world, k);
                set(&mut block.world, k, Vec3::new(place.x, place.y, place.z + ABOVE_STEPS_M));
            }
        }
    }
}

simd_kernel! {
    /// The look of a slope of tiles.
    pub fn tiles(shared: &[Shared], blocks: &mut [Block], slope: &Tiles, noise: &NoiseTexture) {
        let slope = *slope;
        for (shared, four) in groups(shared, blocks) {
            for block in four {
                for k in 0..WIDE {
                    let look = slope.look(&block.point(shared, k), noise);
                    block.put_bent(k, &look);
                }
            }
        }
    }
}

/// A face of a step.
#[derive(Clone, Copy, Debug)]
pub struct Tiles {
    tone: Vec3,
    shift: f32,
    center: Vec3,
    axes: [Vec3; 2],
    above_m: [f32; 4],
    /// Direction in which an upright face falls; zero for upper faces.
    outward: Vec3,
    pitch: RoofPitch,
    /// The building's seed; middle of the box and half its size, heights of the eaves and of the ridge above them, metres.
    seed: u32,
    middle: Vec3,
    half_m: [f32; 2],
    eaves_m: f32,
    rise_m: f32,
    /// Share of the places that have a window, and of panels for sunlight on the southern slopes.
    windows: f32,
    panels: f32,
}

impl Tiles {
    /// The upper face of a step of a building `seed` around `center`.
    pub fn top(seed: u32, town: u32, center: Vec3, axes: [Vec3; 2], slope: &TopSlope) -> Self {
        let outward = slope.falls.map_or(Vec3::ZERO, |[x, y]| Vec3::new(x, y, 0.0));
        let side = Self::side(seed, town, outward, slope.pitch);
        Self { center, axes, above_m: slope.above_m, ..side }
    }

    /// An upright face of a step that falls to `outward`.
    pub fn side(seed: u32, town: u32, outward: Vec3, pitch: RoofPitch) -> Self {
        // A town prefers some: squared, the first ones as the town turns the list come most often.
        let place = (draw(seed, draws::TILES) * draw(seed, draws::TILES_AGAIN) * TONES.len() as f32) as usize;
        let turned = place + (hash(town, draws::TILES) % TONES.len() as u32) as usize;
        let tone = TONES[turned % TONES.len()] * (0.85 + 0.3 * draw(seed, draws::TILES_BRIGHTNESS));
        let axes = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
        Self {
            tone,
            shift: unit(seed) * 99.0,
            center: Vec3::ZERO,
            axes,
            above_m: [0.0; 4],
            outward,
            pitch,
            seed,
            middle: Vec3::ZERO,
            half_m: [0.0; 2],
            eaves_m: 0.0,
            rise_m: 0.0,
            windows: 0.0,
            panels: 0.0,
        }
    }

    /// The face as part of a whole roof above a wall: windows and panels have their places on it.
    pub fn of_roof(self, b: &SceneBox, wall_m: [f64; 2]) -> Self {
        let eaves_m = (wall_m[0] + wall_m[1]) as f32;
        let rise_m = b.whole[0].z + b.whole[1].z - eaves_m;
        let (has_room, drawn) = (one_if(rise_m > LEAST_RISE_M), draw(self.seed, draws::ROOF_WINDOWS));
        Self {
            axes: b.axes_in_world.map(Vec3::from),
            middle: b.center_in_world.into(),
            half_m: [b.half_extents_m.x, b.half_extents_m.y],
            eaves_m,
            rise_m,
            // Four of ten roofs have none.
            windows: has_room * most(drawn - 0.4, 0.0),
            panels: has_room * one_if(draw(self.seed, draws::PANELS) < 0.12),
            ..self
        }
    }

    /// Windows and panels on the tiles: their colour and share of a pixel. `aside` is the place along the eaves, metres.
    #[inline(always)]
    fn openings(&self, point: &SurfacePoint, falls: Vec3, aside: f32) -> (Vec3, f32) {
        let size = point.footprint_m;
        let along = Vec3::new(falls.y, -falls.x, 0.0);
        let [x, y] = self.axes.map(|axis| axis.dot(along).abs());
        let (middle, reach) = (self.middle.dot(along), x * self.half_m[0] + y * self.half_m[1] - EDGE_M);
        let up_m = (point.world.z - self.eaves_m) / most(self.pitch[0], 0.1);
        let length_m = self.rise_m / most(self.pitch[0], 0.1);
        // A row of windows, below the middle of the slope.
        let number = floor_int(aside * WINDOWS_PER_M);
        let place = (number as f32 + 0.5) / WINDOWS_PER_M;
        let is_inside = one_if((place - middle).abs() + WINDOW_M[0] < reach);
        let bits = hash(number as u32, self.seed ^ one_if(falls.x + 0.3 * falls.y > 0.0).to_bits());
        let has = is_inside * one_if(unit(bits) < self.windows);
        let (u, v) = (aside - place, up_m - 0.46 * length_m);
        let within = |inset_m: f32| {
            let [wide_m, long_m] = WINDOW_M.map(|half_m| half_m - inset_m);
            band(u, -wide_m, wide_m, size) * band(v, -long_m, long_m, size)
        };
        let window = has * within(0.0);
        let colour = FRAME.lerp(PANE, within(FRAME_M));
        // A field of panels.
        let southern = one_if(0.6 * falls.x + 0.8 * falls.y > 0.0);
        let whole = floor_int(reach * (1.0 / PANEL_M[0])) as f32 * PANEL_M[0];
        let field = self.panels
            * southern
            * band(aside - middle, -whole, whole, size)
            * band(up_m, 0.18 * length_m, 0.18 * length_m + 2.0 * PANEL_M[1], size)
            * one_if(0.82 * length_m > 0.18 * length_m + 2.0 * PANEL_M[1]);
        let gap = most(
            stripes((aside - middle) / PANEL_M[0], 0.0, 0.04, size / PANEL_M[0]),
            stripes((up_m - 0.18 * length_m) / PANEL_M[1], 0.0, 0.03, size / PANEL_M[1]),
        );
        let panel = PANEL.lerp(Vec3::splat(0.16), gap);
        (colour.lerp(panel, field), share(window + field))
    }

    /// Colour without patterns.
    pub fn colour(&self) -> Vec3 {
        self.tone
    }

    /// Direction over the ground in which the slope falls.
    #[inline(always)]
    fn falls(&self, world: Vec3) -> Vec3 {
        let away = world - self.center;
        let [middle_x, middle_y, half_x, half_y] = self.above_m;
        let (x, y) = (away.dot(self.axes[0]) - middle_x, away.dot(self.axes[1]) - middle_y);
        let along_x = one_if(x.abs() - half_x > y.abs() - half_y);
        let across = self.axes[0] * (along_x * (2.0 * one_if(x > 0.0) - 1.0));
        let along = self.axes[1] * ((1.0 - along_x) * (2.0 * one_if(y > 0.0) - 1.0));
        let is_side = one_if(self.outward.dot(self.outward) > 0.5);
        (across + along).lerp(self.outward, is_side)
    }

    #[inline(always)]
    fn look(&self, point: &SurfacePoint, noise: &NoiseTexture) -> Look {
        let size = point.footprint_m;
        let falls = self.falls(point.world);
        let [sine, cosine] = self.pitch;
        // Places on steps as if they lay on the slope: along it, and across.
        let down = point.world.dot(falls) * cosine - point.world.z * sine;
        let aside = point.world.x * falls.y - point.world.y * falls.x;
        let rough = noise.rough(aside * 6.0 + self.shift, down * 6.0, size * 6.0);
        let patch = noise.clumps(aside * 1.1 + self.shift, down * 1.1, size * 1.1);
        let (course, tile) = (down * (1.0 / TILE_M[0]), aside * (1.0 / TILE_M[1]));
        let shade = stripes(course, 0.0, 0.22, size * (1.0 / TILE_M[0]));
        let joint = stripes(tile, 0.0, 0.18, size * (1.0 / TILE_M[1]));
        let albedo = self.tone * ((0.62 + 0.42 * rough + 0.34 * patch) * (1.0 - 0.34 * shade) * (1.0 - 0.14 * joint));
        let moss = lerp(0.0, 0.30, one_if(patch > 0.66));
        let albedo = albedo.lerp(Vec3::new(0.10, 0.11, 0.06), moss);
        let (colour, opening) = self.openings(point, falls, aside);
        let albedo = albedo.lerp(colour, opening);
        Look::matt(albedo, Vec3::new(falls.x * sine, falls.y * sine, cosine))
    }
}
