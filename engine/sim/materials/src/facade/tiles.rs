//! Pitched roofs: the steps of their boxes drawn as slopes of tiles.

use super::draws;
use crate::lanes::{Block, Shared, WIDE, get, groups, set};
use crate::pattern::{NoiseTexture, Noises, draw, hash, lerp, one_if, stripes, unit};
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
}

impl Tiles {
    /// The upper face of a step of a building `seed` around `center`.
    pub fn top(seed: u32, town: u32, center: Vec3, axes: [Vec3; 2], slope: &TopSlope) -> Self {
        let side = Self::side(seed, town, Vec3::ZERO, slope.pitch);
        Self { center, axes, above_m: slope.above_m, ..side }
    }

    /// An upright face of a step that falls to `outward`.
    pub fn side(seed: u32, town: u32, outward: Vec3, pitch: RoofPitch) -> Self {
        // A town prefers some: squared, the first ones as the town turns the list come most often.
        let place = (draw(seed, draws::TILES) * draw(seed, draws::TILES_AGAIN) * TONES.len() as f32) as usize;
        let turned = place + (hash(town, draws::TILES) % TONES.len() as u32) as usize;
        let tone = TONES[turned % TONES.len()] * (0.85 + 0.3 * draw(seed, draws::TILES_BRIGHTNESS));
        let axes = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
        Self { tone, shift: unit(seed) * 99.0, center: Vec3::ZERO, axes, above_m: [0.0; 4], outward, pitch }
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
        Look::matt(albedo, Vec3::new(falls.x * sine, falls.y * sine, cosine))
    }
}
