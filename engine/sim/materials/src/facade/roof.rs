//! Flat roofs: roofing, parapets, skylights, machines and their shadows.

use crate::lanes::{Block, Shared, WIDE, groups};
use crate::light::Light;
use crate::pattern::{
    NoiseTexture, Noises, band, draw, floor_int, hash, least, most, one_if, smoothstep, stripes, unit,
};
use crate::surface::{Look, SurfacePoint};
use crate::vector::Vec3;
use cosfly_frames::simd_kernel;

simd_kernel! {
    /// The look of a flat roof.
    pub fn roofs(shared: &[Shared], blocks: &mut [Block], roof: &Roof, light: &Light, noise: &NoiseTexture) {
        let (roof, to_sun) = (*roof, light.to_sun);
        for (shared, four) in groups(shared, blocks) {
            for block in four {
                for k in 0..WIDE {
                    let look = roof.look(&block.point(shared, k), to_sun, noise);
                    block.put(k, &look);
                }
            }
        }
    }
}

/// Farther than any roof reaches, metres.
const FAR_M: f32 = 1.0e4;

/// Properties of a whole roof.
#[derive(Clone, Copy, Debug)]
pub struct Roof {
    seed: u32,
    tone: Vec3,
    shift: f32,
    center: Vec3,
    axes: [Vec3; 2],
    half_m: [f32; 2],
    /// Distances from the middle to the parapets, metres: low x, high x, low y, high y; far where the roof goes on.
    parapets_m: [f32; 4],
}

impl Roof {
    /// The flat roof of a building `seed` around `center`, `half_m` half its size along `axes`; sides on which it `goes_on` over
    /// another box have no parapet.
    pub fn new(seed: u32, center: Vec3, axes: [Vec3; 2], half_m: [f32; 2], goes_on: [bool; 4]) -> Self {
        let tones = [
            Vec3::new(0.20, 0.19, 0.18),
            Vec3::new(0.34, 0.32, 0.29),
            Vec3::new(0.12, 0.12, 0.125),
            Vec3::new(0.44, 0.43, 0.41),
            Vec3::new(0.27, 0.22, 0.18),
            Vec3::new(0.13, 0.16, 0.07),
        ];
        let tone = tones[(draw(seed, 20) * 6.0) as usize % 6];
        let parapet_m = |side: usize| half_m[side / 2] + if goes_on[side] { FAR_M } else { 0.0 };
        let parapets_m = [0, 1, 2, 3].map(parapet_m);
        Self { seed, tone, shift: unit(seed) * 99.0, center, axes, half_m, parapets_m }
    }

    /// Colour without patterns.
    pub fn colour(&self) -> Vec3 {
        self.tone
    }

    #[inline(always)]
    fn look(&self, point: &SurfacePoint, to_sun: Vec3, noise: &NoiseTexture) -> Look {
        let size = point.footprint_m;
        let away = point.world - self.center;
        let (x, y) = (away.dot(self.axes[0]), away.dot(self.axes[1]));
        // Patterns go on from box to box.
        let (across_x, across_y) = (point.world.dot(self.axes[0]), point.world.dot(self.axes[1]));
        let rough = noise.rough(across_x * 10.0 + self.shift, across_y * 10.0, size * 10.0);
        let stain = noise.clumps(across_x * 1.5 + self.shift, across_y * 1.5, size * 1.5);
        // Where water stood: rings around the lowest places.
        let pool = smoothstep(0.60, 0.63, stain) - smoothstep(0.66, 0.72, stain);
        let sheet = stripes(across_x * (1.0 / 3.0), 0.0, 0.03, point.footprints_m[0] * (1.0 / 3.0));
        let across = stripes(across_y * (1.0 / 8.0), 0.0, 0.012, point.footprints_m[1] * (1.0 / 8.0));
        let seam = most(sheet, across);
        let mut albedo = self.tone * ((0.5 + 0.5 * rough + 0.5 * stain) * (1.0 - 0.25 * seam) * (1.0 - 0.25 * pool));
        // Things on a grid: machines, skylights, chimneys, the house of the stairs, each with its shadow.
        let (u, v) = (x * 0.2, y * 0.2);
        let cell = hash(floor_int(u) as u32, floor_int(v) as u32 ^ self.seed);
        let inner = least(self.half_m[0] - x.abs(), self.half_m[1] - y.abs());
        let there = one_if((unit(cell) < 0.30) & (inner > 2.8));
        let (du, dv) = (point.footprints_m[0] * 0.2, point.footprints_m[1] * 0.2);
        let kind = unit(hash(cell, 2));
        let side = 0.05 + 0.20 * unit(hash(cell, 1)) * one_if(kind > 0.25);
        let other = side * (0.5 + unit(hash(cell, 3)));
        let (middle_u, middle_v) = (0.32 + 0.2 * unit(hash(cell, 4)), 0.32 + 0.2 * unit(hash(cell, 5)));
        let tall = (0.5 + 1.3 * unit(hash(cell, 6))) * one_if(kind < 0.80) + 0.1;
        // The shadow lies on the side away from the sun.
        let reach = -tall / most(to_sun.z, 0.3);
        let (aside, along) = (to_sun.dot(self.axes[0]) * reach * 0.2, to_sun.dot(self.axes[1]) * reach * 0.2);
        let shadow = long(u, middle_u, side, aside, du) * long(v, middle_v, other, along, dv);
        let thing = long(u, middle_u, side, 0.0, du) * long(v, middle_v, other, 0.0, dv);
        albedo *= 1.0 - 0.6 * shadow * there;
        let fins = stripes(y * 6.0, 0.0, 0.4, point.footprints_m[1] * 6.0);
        let machine = Vec3::splat(0.46) * (0.8 + 0.3 * rough) * (1.0 - 0.35 * fins * one_if(kind < 0.6));
        let glass = one_if(kind > 0.80);
        let metal = machine.lerp(Vec3::new(0.10, 0.16, 0.22), glass);
        albedo = albedo.lerp(metal, thing * there);
        // The parapet, its coping and the shade inside of it.
        let [low_x, high_x, low_y, high_y] = self.parapets_m;
        let inside = least(least(low_x + x, high_x - x), least(low_y + y, high_y - y));
        let coping = band(inside, -1.0, 0.32, size);
        let shade = band(inside, 0.32, 0.75, size);
        albedo = albedo.lerp(Vec3::splat(0.44) * (0.8 + 0.3 * rough), coping) * (1.0 - 0.4 * shade);
        Look { mirror: 0.25 * glass * thing * there, ..Look::matt(albedo, point.normal) }
    }
}

/// Share of a stripe drawn out by `by` to one side.
#[inline(always)]
fn long(at: f32, middle: f32, half: f32, by: f32, width: f32) -> f32 {
    stripes(at, most(middle - half + least(by, 0.0), 0.0), least(middle + half + most(by, 0.0), 1.0), width)
}
