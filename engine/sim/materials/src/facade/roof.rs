//! Flat roofs: roofing, parapets, skylights, machines and their shadows.

use super::draws;
use crate::lanes::{Block, Shared, WIDE, get, groups, set};
use crate::light::Light;
use crate::pattern::{
    NoiseLevel, NoiseLevels, NoiseTexture, Noises, band, draw, floor_int, hash, least, most, one_if, smoothstep,
    stripes, unit,
};
use crate::surface::{Look, SurfacePoint};
use crate::vector::Vec3;
use cosfly_frames::simd_kernel;

simd_kernel! {
    /// The look of a flat roof.
    pub fn roofs(shared: &[Shared], blocks: &mut [Block], roof: &Roof, light: &Light, noise: &NoiseTexture) {
        let (roof, to_sun) = (*roof, light.to_sun);
        for (shared, four) in groups(shared, blocks) {
            let fine = NoiseLevels::of(&shared.footprint_m, ROUGH_PER_M);
            let wide = NoiseLevels::of(&shared.footprint_m, STAINS_PER_M);
            for block in four {
                let mut rough = [0.0f32; WIDE];
                let (mut any_thing, mut at_border) = (0u32, 0u32);
                for (k, rough) in rough.iter_mut().enumerate() {
                    let point = block.point(shared, k);
                    *rough = roof.rough(&point, fine.at(k), noise);
                    let look = Look::matt(roof.covering(&point, *rough, wide.at(k), noise), point.normal);
                    block.put(k, &look);
                    any_thing |= u32::from(roof.has_thing(&point));
                    at_border |= u32::from(roof.inside_m(&point) - point.footprint_m < SHADE_M);
                }
                if any_thing != 0 {
                    for (k, rough) in rough.iter().enumerate() {
                        let point = block.point(shared, k);
                        let look = roof.thing(&block.look(k), &point, *rough, to_sun);
                        block.put(k, &look);
                    }
                }
                if at_border != 0 {
                    for (k, rough) in rough.iter().enumerate() {
                        let albedo = roof.border(get(&block.albedo, k), &block.point(shared, k), *rough);
                        set(&mut block.albedo, k, albedo);
                    }
                }
            }
        }
    }
}

/// Texels of the roofing's grain and of its stains per metre.
const ROUGH_PER_M: f32 = 10.0;
const STAINS_PER_M: f32 = 1.5;
/// Width of a parapet, and of the shade inside of it from the roof's edge, metres.
const COPING_M: f32 = 0.32;
const SHADE_M: f32 = 0.75;
/// Squares that have at most one thing, per metre.
const THINGS_PER_M: f32 = 0.2;

/// Dry plants of a roof, linear RGB.
const STONECROP: Vec3 = Vec3::new(0.112, 0.096, 0.050);

/// Farther than any roof reaches, metres.
const FAR_M: f32 = 1.0e4;

/// Properties of a whole roof.
#[derive(Clone, Copy, Debug)]
pub struct Roof {
    seed: u32,
    tone: Vec3,
    /// 1 where plants grow on it.
    planted: f32,
    /// Share of the squares of its grid that have a thing.
    things: f32,
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
            Vec3::new(0.085, 0.095, 0.042),
        ];
        let kind = (draw(seed, draws::FLAT_ROOF) * 6.0) as usize % 6;
        let (tone, planted) = (tones[kind], if kind == 5 { 1.0 } else { 0.0 });
        let parapet_m = |side: usize| half_m[side / 2] + if goes_on[side] { FAR_M } else { 0.0 };
        let parapets_m = [0, 1, 2, 3].map(parapet_m);
        Self { seed, tone, planted, things: 0.30, shift: unit(seed) * 99.0, center, axes, half_m, parapets_m }
    }

    /// The top of a tank: plain sheet.
    pub fn of_sheet(self) -> Self {
        Self { tone: Vec3::new(0.44, 0.43, 0.41), planted: 0.0, things: 0.0, ..self }
    }

    /// Colour without patterns.
    pub fn colour(&self) -> Vec3 {
        self.tone
    }

    /// Place along the roof's axes, metres from its middle.
    #[inline(always)]
    fn place(&self, point: &SurfacePoint) -> [f32; 2] {
        let away = point.world - self.center;
        [away.dot(self.axes[0]), away.dot(self.axes[1])]
    }

    /// Place along the roof's axes, metres: patterns go on from box to box.
    #[inline(always)]
    fn across(&self, point: &SurfacePoint) -> [f32; 2] {
        [point.world.dot(self.axes[0]), point.world.dot(self.axes[1])]
    }

    /// Grain of the roofing.
    #[inline(always)]
    fn rough(&self, point: &SurfacePoint, fine: NoiseLevel, noise: &NoiseTexture) -> f32 {
        let [x, y] = self.across(point);
        noise.rough_at(x * ROUGH_PER_M + self.shift, y * ROUGH_PER_M, fine)
    }

    /// Roofing with stains and seams.
    #[inline(always)]
    fn covering(&self, point: &SurfacePoint, rough: f32, wide: NoiseLevel, noise: &NoiseTexture) -> Vec3 {
        let [x, y] = self.across(point);
        let stain = noise.clumps_at(x * STAINS_PER_M + self.shift, y * STAINS_PER_M, wide);
        // Where water stood: rings around the lowest places.
        let pool = smoothstep(0.60, 0.63, stain) - smoothstep(0.66, 0.72, stain);
        let sheet = stripes(x * (1.0 / 3.0), 0.0, 0.03, point.footprints_m[0] * (1.0 / 3.0));
        let across = stripes(y * (1.0 / 8.0), 0.0, 0.012, point.footprints_m[1] * (1.0 / 8.0));
        let seam = most(sheet, across) * (1.0 - self.planted);
        // Stonecrop is red and brown in patches.
        let tone = self.tone.lerp(STONECROP, self.planted * smoothstep(0.42, 0.62, stain));
        tone * ((0.5 + 0.5 * rough + 0.5 * stain) * (1.0 - 0.25 * seam) * (1.0 - 0.25 * pool))
    }

    /// Random bits of the square of the grid of things that a place lies in.
    #[inline(always)]
    fn square(&self, [x, y]: [f32; 2]) -> u32 {
        hash(floor_int(x * THINGS_PER_M) as u32, floor_int(y * THINGS_PER_M) as u32 ^ self.seed)
    }

    /// Whether the place's square has a thing.
    #[inline(always)]
    fn has_thing(&self, point: &SurfacePoint) -> bool {
        let place = self.place(point);
        let inner = least(self.half_m[0] - place[0].abs(), self.half_m[1] - place[1].abs());
        (unit(self.square(place)) < self.things) & (inner > 2.8)
    }

    /// Things on a grid: machines, skylights, chimneys, the house of the stairs, each with its shadow.
    #[inline(always)]
    fn thing(&self, bare: &Look, point: &SurfacePoint, rough: f32, to_sun: Vec3) -> Look {
        let there = one_if(self.has_thing(point));
        let [x, y] = self.place(point);
        let cell = self.square([x, y]);
        let (u, v) = (x * THINGS_PER_M, y * THINGS_PER_M);
        let (du, dv) = (point.footprints_m[0] * THINGS_PER_M, point.footprints_m[1] * THINGS_PER_M);
        let kind = unit(hash(cell, draws::THING_KIND));
        let side = 0.05 + 0.20 * unit(hash(cell, draws::THING_LENGTH)) * one_if(kind > 0.25);
        let other = side * (0.5 + unit(hash(cell, draws::THING_WIDTH)));
        let (middle_u, middle_v) =
            (0.32 + 0.2 * unit(hash(cell, draws::THING_U)), 0.32 + 0.2 * unit(hash(cell, draws::THING_V)));
        let tall = (0.5 + 1.3 * unit(hash(cell, draws::THING_HEIGHT))) * one_if(kind < 0.80) + 0.1;
        // The shadow lies on the side away from the sun.
        let reach = -tall / most(to_sun.z, 0.3);
        let aside = to_sun.dot(self.axes[0]) * reach * THINGS_PER_M;
        let along = to_sun.dot(self.axes[1]) * reach * THINGS_PER_M;
        let shadow = long(u, middle_u, side, aside, du) * long(v, middle_v, other, along, dv);
        let thing = long(u, middle_u, side, 0.0, du) * long(v, middle_v, other, 0.0, dv);
        let fins = stripes(y * 6.0, 0.0, 0.4, point.footprints_m[1] * 6.0);
        let machine = Vec3::splat(0.46) * (0.8 + 0.3 * rough) * (1.0 - 0.35 * fins * one_if(kind < 0.6));
        let glass = one_if(kind > 0.80);
        let metal = machine.lerp(Vec3::new(0.10, 0.16, 0.22), glass);
        let albedo = (bare.albedo * (1.0 - 0.6 * shadow * there)).lerp(metal, thing * there);
        Look { albedo, mirror: 0.25 * glass * thing * there, ..*bare }
    }

    /// Distance from the nearest parapet's outer side, metres.
    #[inline(always)]
    fn inside_m(&self, point: &SurfacePoint) -> f32 {
        let [x, y] = self.place(point);
        let [low_x, high_x, low_y, high_y] = self.parapets_m;
        least(least(low_x + x, high_x - x), least(low_y + y, high_y - y))
    }

    /// The parapet, its coping and the shade inside of it.
    #[inline(always)]
    fn border(&self, roofing: Vec3, point: &SurfacePoint, rough: f32) -> Vec3 {
        let inside = self.inside_m(point);
        let coping = band(inside, -1.0, COPING_M, point.footprint_m);
        let shade = band(inside, COPING_M, SHADE_M, point.footprint_m);
        roofing.lerp(Vec3::splat(0.44) * (0.8 + 0.3 * rough), coping) * (1.0 - 0.4 * shade)
    }
}

/// Share of a stripe drawn out by `by` to one side.
#[inline(always)]
fn long(at: f32, middle: f32, half: f32, by: f32, width: f32) -> f32 {
    stripes(at, most(middle - half + least(by, 0.0), 0.0), least(middle + half + most(by, 0.0), 1.0), width)
}
