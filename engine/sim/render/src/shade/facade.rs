//! Buildings: facades with floors, windows, shops and doors, and flat roofs, all drawn from the building's seed.

use super::light::Light;
use super::pattern::{NoiseTexture, band, draw, floor_int, hash, smoothstep, stripes, unit};
use super::surface::{Look, SurfacePoint};
use glam::Vec3A as Vec3;

/// Wall colours, linear RGB.
const WALLS: [Vec3; 9] = [
    Vec3::new(0.42, 0.17, 0.11),
    Vec3::new(0.55, 0.42, 0.28),
    Vec3::new(0.52, 0.50, 0.46),
    Vec3::new(0.66, 0.61, 0.52),
    Vec3::new(0.33, 0.33, 0.34),
    Vec3::new(0.50, 0.27, 0.16),
    Vec3::new(0.60, 0.48, 0.36),
    Vec3::new(0.36, 0.40, 0.44),
    Vec3::new(0.70, 0.68, 0.64),
];
/// Shop signs, linear RGB.
const SIGNS: [Vec3; 6] = [
    Vec3::new(0.55, 0.04, 0.03),
    Vec3::new(0.03, 0.12, 0.35),
    Vec3::new(0.02, 0.22, 0.10),
    Vec3::new(0.60, 0.35, 0.03),
    Vec3::new(0.06, 0.06, 0.07),
    Vec3::new(0.45, 0.43, 0.40),
];
const GLASS: Vec3 = Vec3::new(0.035, 0.045, 0.055);

/// What all points of one facade share.
#[derive(Clone, Copy, Debug)]
pub struct Facade {
    seed: u32,
    wall: Vec3,
    trim: Vec3,
    bay_m: f32,
    floor_m: f32,
    floors: f32,
    window: [f32; 2],
    sill: [f32; 2],
    curtain: bool,
    brick: bool,
    shops: bool,
    height_m: f32,
    shift: f32,
}

impl Facade {
    /// The facade of a building `seed` on a face of this size.
    pub fn new(seed: u32, face: u32, width_m: f32, height_m: f32) -> Self {
        let wall = WALLS[(draw(seed, 0) * WALLS.len() as f32) as usize % WALLS.len()] * (0.8 + 0.35 * draw(seed, 1));
        let curtain = height_m > 16.0 && draw(seed, 2) < 0.35;
        let floors = (height_m / (3.0 + 0.7 * draw(seed, 3))).round().max(1.0);
        let wanted_bay = if curtain { 1.5 } else { 2.0 + 1.3 * draw(seed, 4) };
        let bay_m = width_m / (width_m / wanted_bay).round().max(1.0);
        let ribbon = !curtain && draw(seed, 5) < 0.22;
        let share = if curtain {
            0.92
        } else if ribbon {
            1.0
        } else {
            0.36 + 0.26 * draw(seed, 6)
        };
        let low = if curtain { 0.06 } else { 0.26 + 0.08 * draw(seed, 7) };
        let high = if curtain { 0.96 } else { 0.76 + 0.10 * draw(seed, 8) };
        Self {
            seed: hash(seed, face),
            wall: if curtain { Vec3::new(0.22, 0.24, 0.26) } else { wall },
            trim: wall.lerp(Vec3::splat(0.72), 0.65),
            bay_m,
            floor_m: height_m / floors,
            floors,
            window: [0.5 - 0.5 * share, 0.5 + 0.5 * share],
            sill: [low, high],
            curtain,
            brick: draw(seed, 0) * (WALLS.len() as f32) < 1.0 || draw(seed, 9) < 0.2,
            shops: draw(seed, 10) < 0.7 && height_m > 7.0,
            height_m,
            shift: 200.0 * draw(seed, 11),
        }
    }

    /// The look at `along_m` from one edge and `up_m` above the building's foot.
    #[inline(always)]
    pub fn look(&self, point: &SurfacePoint, along_m: f32, up_m: f32, light: &Light, noise: &NoiseTexture) -> Look {
        let (bay, floor) = (along_m / self.bay_m, up_m / self.floor_m);
        let (du, dv) = (point.footprints_m[0] / self.bay_m, point.footprints_m[1] / self.floor_m);
        let size = point.footprint_m;
        let rough = noise.rough(along_m * 14.0 + self.shift, up_m * 14.0, size * 14.0);
        let foot = 1.0 - 0.25 * (1.0 - smoothstep(0.0, 1.6, up_m));
        let mut wall = self.wall * ((0.78 + 0.44 * rough) * foot);
        if self.brick && size < 0.1 {
            let course = stripes(up_m / 0.08, 0.0, 0.17, point.footprints_m[1] / 0.08);
            wall *= 1.0 - 0.25 * course;
        }
        let story = floor_int(floor);
        let ledge = stripes(floor, 0.0, 0.055, dv);
        wall = wall.lerp(self.trim, 0.65 * ledge);
        let crown = band(up_m, self.height_m - 0.55, self.height_m, point.footprints_m[1]);
        wall = wall.lerp(self.trim * 0.9, crown);
        if floor < 1.0 && self.shops {
            return self.shop(point, wall, bay, up_m, du, light);
        }
        let cell = hash(floor_int(bay) as u32, story as u32 ^ self.seed);
        let openings = if floor < self.floors - 0.02 { 1.0 } else { 0.0 };
        let glass = openings
            * stripes(bay, self.window[0], self.window[1], du)
            * stripes(floor, self.sill[0], self.sill[1], dv);
        let rim = 0.035 / (self.window[1] - self.window[0]).max(0.3);
        let framed = openings
            * stripes(bay, (self.window[0] - rim).max(0.0), (self.window[1] + rim).min(1.0), du)
            * stripes(floor, self.sill[0] - 0.035, self.sill[1] + 0.03, dv);
        let frame = (framed - glass).max(0.0);
        // Windows lie back in the wall: the lintel shades their upper edge.
        let recess = stripes(floor, self.sill[1] - 0.07, self.sill[1], dv) * (1.0 - smoothstep(0.4, 1.0, dv));
        let mullion = if self.curtain { 0.0 } else { stripes(bay, 0.488, 0.512, du) };
        let mut look = Look::matt(wall.lerp(self.trim, frame), point.normal);
        self.glaze(
            &mut look,
            glass * (1.0 - 0.8 * mullion),
            cell,
            1.0 - 0.5 * recess,
            smoothstep(0.35, 0.9, du),
            light,
        );
        look
    }

    /// Puts glass of a window over a share of the pixel; `mean` 1 where windows are too small to tell apart.
    #[inline(always)]
    fn glaze(&self, look: &mut Look, share: f32, cell: u32, shade: f32, mean: f32, light: &Light) {
        let curtains = unit(hash(cell, 3));
        let inside = if curtains > 0.62 { Vec3::new(0.32, 0.29, 0.24) * (curtains - 0.35) } else { GLASS };
        let inside = inside.lerp(Vec3::new(0.09, 0.09, 0.085), mean);
        look.albedo = look.albedo.lerp(inside * shade, share);
        look.mirror = share * if self.curtain { 0.55 } else { 0.38 } * shade;
        if light.night > 0.0 {
            let lit = unit(hash(cell, 7));
            let one = if lit < 0.30 { 0.12 + 1.3 * lit } else { 0.0 };
            let strength = one + (0.09 - one) * mean;
            let warm = Vec3::new(1.0, 0.62, 0.26).lerp(Vec3::new(0.80, 0.85, 0.95), unit(hash(cell, 9)) * 0.45);
            look.emission = warm * (strength * share * 0.22 * light.night);
        }
    }

    /// The street floor: shop windows, doors and a sign band.
    #[inline(always)]
    fn shop(&self, point: &SurfacePoint, wall: Vec3, bay: f32, up_m: f32, du: f32, light: &Light) -> Look {
        let dv = point.footprints_m[1];
        let top = self.floor_m;
        let unit_number = floor_int(bay / 3.0);
        let shop = hash(unit_number as u32, self.seed ^ 0x5407);
        let sign = SIGNS[(unit(shop) * SIGNS.len() as f32) as usize % SIGNS.len()];
        let door = floor_int(bay).rem_euclid(3) == (shop % 3) as i32;
        let (left, right, low) = if door { (0.28, 0.72, 0.02) } else { (0.06, 0.94, 0.45) };
        let across = stripes(bay, left, right, du);
        let glass = across * band(up_m, low, top - 1.05, dv);
        let sign_share = band(up_m, top - 0.85, top - 0.25, dv) * stripes(bay / 3.0, 0.02, 0.98, du / 3.0);
        let mut look = Look::matt(wall.lerp(sign, sign_share), point.normal);
        self.glaze(&mut look, glass, hash(shop, 1), 1.0, 0.35, light);
        if door {
            look.albedo = look.albedo.lerp(sign * 0.5, 0.55 * glass);
        }
        if light.night > 0.0 && unit(hash(shop, 5)) < 0.6 {
            look.emission += (sign * 1.2 + Vec3::splat(0.03)) * (sign_share * light.night * 0.12)
                + Vec3::new(0.30, 0.21, 0.11) * (glass * light.night * (0.06 + 0.22 * unit(hash(shop, 6))));
        }
        look
    }
}

/// A flat roof at (`x_m`, `y_m`) from its middle; `half_m` is half its size.
#[inline(always)]
pub fn roof(point: &SurfacePoint, seed: u32, at_m: [f32; 2], half_m: [f32; 2], noise: &NoiseTexture) -> Look {
    let size = point.footprint_m;
    let (x, y) = (at_m[0], at_m[1]);
    let rough = noise.rough(x * 10.0 + unit(seed) * 99.0, y * 10.0, size * 10.0);
    let stain = noise.clumps(x * 1.5 + unit(seed) * 99.0, y * 1.5, size * 1.5);
    let tones = [Vec3::new(0.20, 0.19, 0.18), Vec3::new(0.34, 0.32, 0.29), Vec3::new(0.12, 0.12, 0.125)];
    let tone = tones[(draw(seed, 20) * 3.0) as usize % 3];
    let mut albedo = tone * (0.5 + 0.5 * rough + 0.5 * stain);
    // Seams of the roofing, skylights and machinery on a grid.
    let seam = stripes(x / 3.0, 0.0, 0.03, point.footprints_m[0] / 3.0);
    albedo *= 1.0 - 0.25 * seam;
    let (u, v) = (x / 5.0, y / 5.0);
    let cell = hash(floor_int(u) as u32, floor_int(v) as u32 ^ seed);
    let inner = (half_m[0] - x.abs()).min(half_m[1] - y.abs());
    if unit(cell) < 0.16 && inner > 3.0 {
        let (du, dv) = (point.footprints_m[0] / 5.0, point.footprints_m[1] / 5.0);
        let side = 0.16 + 0.16 * unit(hash(cell, 1));
        let shadow = stripes(u, 0.5 - side, 0.5 + side + 0.05, du) * stripes(v, 0.5 - side, 0.5 + side + 0.07, dv);
        let unit_share = stripes(u, 0.5 - side, 0.5 + side, du) * stripes(v, 0.5 - side, 0.5 + side, dv);
        albedo *= 1.0 - 0.55 * shadow;
        let metal = if unit(hash(cell, 2)) < 0.4 { Vec3::new(0.10, 0.16, 0.22) } else { Vec3::splat(0.46) };
        albedo = albedo.lerp(metal * (0.8 + 0.3 * rough), unit_share);
    }
    let parapet = band(inner, -1.0, 0.35, size) - 0.5 * band(inner, 0.35, 0.6, size);
    albedo = albedo.lerp(Vec3::splat(0.42), parapet.max(0.0)) * (1.0 - 0.4 * (-parapet).max(0.0));
    Look::matt(albedo, point.normal)
}
