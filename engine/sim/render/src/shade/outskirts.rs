//! Land around a town: what lies between its last ground and the horizon, and a ring of distant houses and hills.
//!
//! A backdrop behind everything that has a depth: its pixels keep the label and the depth of the sky. It stands still in the
//! world: rings around the town's middle at fixed distances, and a plain at the height of the town's border.

use super::geometry::fast_exp;
use cosfly_domain::Season;
use cosfly_materials::grass::lawn;
use cosfly_materials::grid::LightGrid;
use cosfly_materials::light::Light;
use cosfly_materials::pattern::{
    NoiseTexture, Noises, floor_int, hash, least, lerp, most, one_if, share, smoothstep, stripes, unit,
};
use cosfly_materials::vector::Vec3;

/// Rays that rise faster than this (sine of the angle) pass above all rings.
pub const HIGHEST: f32 = 0.13;
/// Rays that fall faster than this pass below all rings, but near one that the camera is high above.
pub const LOWEST: f32 = -0.40;

/// Width of the belt in which the lawns at the town's border become fields, metres.
const BELT_M: f32 = 260.0;

/// Place and size of the town that the land surrounds.
#[derive(Clone, Copy, Debug)]
pub struct Outskirts {
    center: [f32; 2],
    /// Half its size, metres.
    half_m: [f32; 2],
    /// Half the longer side times the root of 2: the ellipse of these proportions through the corners.
    radius_m: f32,
    /// Factors of x and y that make a circle of that ellipse.
    round: [f32; 2],
    ground_m: f32,
    /// Colours of lawns: fresh and dry.
    lawn: [Vec3; 2],
    /// Colours of woods on the plain, and of the hills.
    wood: Vec3,
    hills: Vec3,
}

/// A ring of houses around the town.
#[derive(Clone, Copy)]
pub struct Ring {
    /// Metres beyond the town's corners.
    beyond_m: f32,
    /// Width of a house, metres.
    house_m: f32,
    /// Height of the lowest and of the highest house, metres.
    heights_m: [f32; 2],
    seed: u32,
}

/// From far to near.
pub const RINGS: [Ring; 3] = [
    Ring { beyond_m: 900.0, house_m: 34.0, heights_m: [14.0, 74.0], seed: 3 },
    Ring { beyond_m: 420.0, house_m: 24.0, heights_m: [8.0, 34.0], seed: 2 },
    Ring { beyond_m: 150.0, house_m: 17.0, heights_m: [4.0, 17.0], seed: 1 },
];
const UP: Vec3 = Vec3::new(0.0, 0.0, 1.0);
/// Distance of the hills beyond the town's corners, metres.
const HILLS_M: f32 = 2600.0;

/// A ray from the camera, with what does not change between pixels.
#[derive(Clone, Copy)]
pub struct Sight {
    /// The camera, metres.
    pub position: Vec3,
    /// Unit length.
    pub direction: Vec3,
    /// Angle of a pixel, radians.
    pub pixel: f32,
    /// Colour that far things fade into.
    pub haze: Vec3,
}

impl Outskirts {
    /// The land around the town of a grid.
    pub fn of(grid: &LightGrid, season: Season) -> Self {
        let [low, high] = grid.bounds_m();
        let half_m = [0.5 * (high[0] - low[0]), 0.5 * (high[1] - low[1])];
        let longer_m = most(half_m[0], half_m[1]);
        let [wood, hills] = cosfly_materials::season::row(season).woods;
        Self {
            center: [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])],
            half_m,
            radius_m: core::f32::consts::SQRT_2 * longer_m,
            // Rings around a long town are not rounder than this: far from its ends they would be thin.
            round: half_m.map(|half| least(longer_m / most(half, 1.0), 4.0)),
            ground_m: grid.border_m(),
            lawn: cosfly_materials::season::row(season).lawn,
            wood,
            hills,
        }
    }

    /// Height of the plain, metres.
    #[inline(always)]
    pub fn ground_m(&self) -> f32 {
        self.ground_m
    }

    /// The hills before `sky`.
    #[inline(always)]
    pub fn hills(&self, sky: Vec3, light: &Light, sight: &Sight, noise: &NoiseTexture) -> Vec3 {
        let ray = Level::of(self, sight);
        let arriving = ray.arriving(light);
        // Hills: one smooth line.
        let far = ray.reach(self.radius_m + HILLS_M);
        let place = ray.place(far, self.radius_m + HILLS_M);
        let line = 0.7 * noise.clumps(place * 24.0, 7.5, 1.0) + 0.3 * noise.clumps(place * 120.0, 90.5, 1.0);
        let height = 20.0 + 130.0 * smoothstep(0.35, 0.85, line);
        let cover = share((height - (ray.above_m + far * ray.slope)) / (far * sight.pixel) + 0.5);
        let rough = noise.clumps(place * 900.0, 20.0 + ray.slope * 900.0, 2.0);
        let wood = self.hills * (0.6 + 0.8 * rough);
        sky.lerp(hazy(wood * arriving, far, light, sight), cover)
    }

    /// The plain before `behind`: woods, fields and roofs, in patches that fade where they are smaller than a pixel.
    #[inline(always)]
    pub fn plain(&self, behind: Vec3, light: &Light, sight: &Sight, noise: &NoiseTexture) -> Vec3 {
        let ray = Level::of(self, sight);
        let down = most(-ray.slope, 1e-5);
        let to_plain = least(ray.above_m / down, 60_000.0);
        let (x, y) = (sight.position.x + to_plain * ray.flat[0], sight.position.y + to_plain * ray.flat[1]);
        let size = sight.pixel * to_plain * least(1.0 / down, 6.0) * 0.4;
        let woods = smoothstep(0.46, 0.56, noise.clumps(x * 0.31, y * 0.31, size * 0.31));
        let roofs = smoothstep(0.55, 0.66, noise.clumps(x * 1.3 + 40.0, y * 1.3, size * 1.3));
        let dry = noise.clumps(x * 0.12 + 9.0, y * 0.12 + 77.0, size * 0.12);
        let field = Vec3::new(0.10, 0.15, 0.045).lerp(Vec3::new(0.22, 0.20, 0.10), smoothstep(0.45, 0.7, dry));
        let built = Vec3::new(0.24, 0.21, 0.19).lerp(Vec3::new(0.30, 0.15, 0.10), one_if(dry > 0.5));
        let plain = field.lerp(built, 0.75 * roofs).lerp(self.wood, 0.8 * woods);
        let plain = plain * (0.55 + 0.9 * noise.rough(x * 3.0, y * 3.0, size * 3.0));
        // The lawns at the border go on into the fields, in bays.
        let [aside, along] = [(x - self.center[0], self.half_m[0]), (y - self.center[1], self.half_m[1])]
            .map(|(from, half)| most(from.abs() - half, 0.0));
        let bays = 0.5 + noise.clumps(x * 0.55, y * 0.55 + 31.0, size * 0.55);
        let wild = smoothstep(0.04, 1.0, (aside * aside + along * along).sqrt() * bays * (1.0 / BELT_M));
        let plain = lawn([x, y], size, self.lawn, noise).lerp(plain, wild);
        let on_plain = light.ambient(UP) * (1.0 - 0.15 * wild) + light.sun * most(light.to_sun.z, 0.0);
        let below = one_if((ray.slope < 0.0) & (ray.above_m > 0.0));
        let lit = plain * on_plain;
        behind.lerp(hazy(lit, to_plain, light, sight), below)
    }

    /// Whether a ray may meet the houses of a ring.
    #[inline(always)]
    pub fn reaches(&self, ring: &Ring, sight: &Sight) -> bool {
        let ray = Level::of(self, sight);
        let far = ray.reach(self.radius_m + ring.beyond_m);
        let (z, pixel_m) = (ray.above_m + far * ray.slope, far * sight.pixel);
        // No tree is as high as the highest house.
        (z > -pixel_m) & (z < ring.heights_m[1] + pixel_m)
    }

    /// The houses and trees of a ring before `behind`.
    #[inline(always)]
    pub fn houses(&self, behind: Vec3, ring: &Ring, light: &Light, sight: &Sight, noise: &NoiseTexture) -> Vec3 {
        let ray = Level::of(self, sight);
        let radius = self.radius_m + ring.beyond_m;
        let far = ray.reach(radius);
        let z = ray.above_m + far * ray.slope;
        let houses = floor_int(core::f32::consts::TAU * radius / ring.house_m) as f32;
        let u = ray.place(far, radius) * houses;
        let house = hash(floor_int(u) as u32, ring.seed);
        let tall = unit(house) * unit(hash(house, 1));
        let trees = one_if(unit(hash(house, 2)) < 0.34);
        let ragged = noise.clumps(u * 40.0, 3.5 + 50.0 * ring.seed as i32 as f32, 1.0);
        let height = lerp(
            ring.heights_m[0] + (ring.heights_m[1] - ring.heights_m[0]) * tall,
            3.0 + 0.5 * ring.heights_m[0] * ragged + 6.0 * ragged,
            trees,
        );
        let pixel_m = far * sight.pixel;
        let cover = share((height - z) / pixel_m + 0.5) * share(z / pixel_m + 1.0);
        let (column, storey, fine) = (u * ring.house_m * (1.0 / 3.1), z * (1.0 / 3.2), pixel_m * (1.0 / 3.1));
        let windows = stripes(column, 0.25, 0.75, fine) * stripes(storey, 0.3, 0.8, fine);
        let grey = 0.16 + 0.34 * unit(hash(house, 4));
        let wall = Vec3::splat(grey).lerp(Vec3::new(grey, 0.72 * grey, 0.55 * grey), unit(hash(house, 5)));
        let wall = wall.lerp(Vec3::splat(0.07), 0.7 * windows);
        let leaves = Vec3::new(0.050, 0.085, 0.030) * (0.5 + ragged);
        let pane = hash(floor_int(column) as u32, floor_int(storey) as u32 ^ house);
        let shines = one_if(unit(pane) < 0.28) * (1.0 - trees) * windows;
        let glow = Vec3::new(1.0, 0.66, 0.32) * (0.10 * light.night * shines);
        let seen = wall.lerp(leaves, trees) * ray.arriving(light) + glow;
        behind.lerp(hazy(seen, far, light, sight), cover)
    }
}

/// A ray over the ground, from the town's middle.
#[derive(Clone, Copy)]
struct Level {
    /// Its direction over the ground, unit length, and its rise per metre.
    flat: [f32; 2],
    slope: f32,
    above_m: f32,
    /// Place and direction, stretched so that the rings are circles.
    from: [f32; 2],
    round: [f32; 2],
}

impl Level {
    #[inline(always)]
    fn of(land: &Outskirts, sight: &Sight) -> Self {
        let Vec3 { x, y, z } = sight.direction;
        let level = 1.0 / ((x * x + y * y).sqrt() + 1e-6);
        let flat = [x * level, y * level];
        Self {
            flat,
            slope: z * level,
            above_m: sight.position.z - land.ground_m,
            from: [
                (sight.position.x - land.center[0]) * land.round[0],
                (sight.position.y - land.center[1]) * land.round[1],
            ],
            round: [flat[0] * land.round[0], flat[1] * land.round[1]],
        }
    }

    /// Distance over ground to a ring around the town's middle.
    #[inline(always)]
    fn reach(&self, radius: f32) -> f32 {
        let [x, y] = self.round;
        let stretch = most(x * x + y * y, 1e-6);
        let along = self.from[0] * x + self.from[1] * y;
        let off = self.from[0] * self.from[0] + self.from[1] * self.from[1] - radius * radius;
        most((most(along * along - stretch * off, 0.0).sqrt() - along) / stretch, 1.0)
    }

    /// Where on a ring the ray meets it.
    #[inline(always)]
    fn place(&self, far: f32, radius: f32) -> f32 {
        ring_place(self.from, self.round, far, radius)
    }

    /// Light on upright faces that look back along the ray.
    #[inline(always)]
    fn arriving(&self, light: &Light) -> Vec3 {
        let facing = Vec3::new(-self.flat[0], -self.flat[1], 0.0);
        light.ambient(facing) * 0.9 + light.sun * (0.85 * most(facing.dot(light.to_sun), 0.0))
    }
}

/// A colour as the air shows it from afar.
#[inline(always)]
fn hazy(colour: Vec3, far: f32, light: &Light, sight: &Sight) -> Vec3 {
    sight.haze.lerp(colour, fast_exp(-light.haze_per_m * most(far - light.haze_start_m, 0.0)))
}

/// Where on a circle a ray meets it, 0 to 1 around: not the angle but a function of it that needs no arc.
#[inline(always)]
fn ring_place(from: [f32; 2], flat: [f32; 2], far: f32, radius: f32) -> f32 {
    let (x, y) = ((from[0] + far * flat[0]) / radius, (from[1] + far * flat[1]) / radius);
    let turned = y / most(x.abs() + y.abs(), 1e-6);
    0.25 * (1.0 + if x < 0.0 { 2.0 - turned } else { turned })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_on_a_ring_grow_around_it_once() {
        let places: Vec<f32> = (0..360)
            .map(|degree| {
                let angle = (f64::from(degree) - 89.5).to_radians();
                let (sin, cos) = cosfly_frames::real::sin_cos(angle);
                ring_place([0.0; 2], [cos as f32, sin as f32], 500.0, 500.0)
            })
            .collect();
        assert!(places.windows(2).all(|pair| pair[0] < pair[1]), "{places:?}");
        assert!(places[0] < 0.01 && places[359] > 0.99);
    }
}
