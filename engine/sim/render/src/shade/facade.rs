//! Buildings: facades with floors, windows, shops and doors, and flat roofs, all drawn from the building's seed.

use super::lanes::{Block, Shared, WIDE, groups};
use super::pattern::{
    NoiseTexture, Noises, band, draw, floor_int, hash, least, lerp, most, one_if, smoothstep, stripes, unit,
};
use super::surface::{Look, SurfacePoint};
use super::vector::Vec3;
use cosfly_frames::simd_kernel;

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
const SIGNS: [Vec3; 8] = [
    Vec3::new(0.55, 0.04, 0.03),
    Vec3::new(0.03, 0.12, 0.35),
    Vec3::new(0.02, 0.22, 0.10),
    Vec3::new(0.60, 0.35, 0.03),
    Vec3::new(0.06, 0.06, 0.07),
    Vec3::new(0.45, 0.43, 0.40),
    Vec3::new(0.16, 0.07, 0.03),
    Vec3::new(0.05, 0.25, 0.32),
];
const GLASS: Vec3 = Vec3::new(0.035, 0.045, 0.055);

/// Properties of a whole facade.
#[derive(Clone, Copy, Debug)]
pub struct Facade {
    seed: u32,
    wall: Vec3,
    trim: Vec3,
    bays_per_m: f32,
    floors_per_m: f32,
    floor_m: f32,
    floors: f32,
    window: [f32; 2],
    frame: [f32; 2],
    sill: [f32; 2],
    /// Share of a mirror in the glass.
    gloss: f32,
    /// 1 where windows have a bar in the middle.
    mullions: f32,
    /// 1 for walls of bricks.
    brick: f32,
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
        let rim = 0.035 / share.max(0.3);
        Self {
            seed: hash(seed, face),
            wall: if curtain { Vec3::new(0.22, 0.24, 0.26) } else { wall },
            trim: wall.lerp(Vec3::splat(0.72), 0.65),
            bays_per_m: 1.0 / bay_m,
            floors_per_m: floors / height_m,
            floor_m: height_m / floors,
            floors,
            window: [0.5 - 0.5 * share, 0.5 + 0.5 * share],
            frame: [(0.5 - 0.5 * share - rim).max(0.0), (0.5 + 0.5 * share + rim).min(1.0)],
            sill: [low, high],
            gloss: if curtain { 0.55 } else { 0.38 },
            mullions: if curtain { 0.0 } else { 1.0 },
            brick: one_if(draw(seed, 0) * (WALLS.len() as f32) < 1.0 || draw(seed, 9) < 0.2),
            shops: draw(seed, 10) < 0.7 && height_m > 7.0,
            height_m,
            shift: 200.0 * draw(seed, 11),
        }
    }

    /// The colour of its wall.
    #[inline(always)]
    pub fn wall_colour(&self) -> Vec3 {
        self.wall
    }

    /// Share of glass at a point, and 1 where the window there is lit at night.
    #[inline(always)]
    pub fn pane(&self, place: &BoxFace, point: &SurfacePoint) -> (f32, f32) {
        let bay = place.along_m(point) * self.bays_per_m;
        let floor = (point.world.z - place.foot_m) * self.floors_per_m;
        let (du, dv) = (point.footprints_m[0] * self.bays_per_m, point.footprints_m[1] * self.floors_per_m);
        let glass = stripes(bay, self.window[0], self.window[1], du) * stripes(floor, self.sill[0], self.sill[1], dv);
        let cell = hash(floor_int(bay) as u32, floor_int(floor) as u32 ^ self.seed);
        (glass, one_if(unit(hash(cell, 7)) < 0.30))
    }

    /// The look at `along_m` from one edge and `up_m` above the building's foot.
    #[inline(always)]
    fn look(&self, point: &SurfacePoint, along_m: f32, up_m: f32, night: Option<f32>, noise: &NoiseTexture) -> Look {
        let (bay, floor) = (along_m * self.bays_per_m, up_m * self.floors_per_m);
        let (du, dv) = (point.footprints_m[0] * self.bays_per_m, point.footprints_m[1] * self.floors_per_m);
        let wall = self.wall_at(point, along_m, up_m, noise);
        let story = floor_int(floor);
        let ledge = stripes(floor, 0.0, 0.055, dv);
        let wall = wall.lerp(self.trim, 0.65 * ledge);
        let cell = hash(floor_int(bay) as u32, story as u32 ^ self.seed);
        let openings = one_if(floor < self.floors - 0.02);
        let glass = openings
            * stripes(bay, self.window[0], self.window[1], du)
            * stripes(floor, self.sill[0], self.sill[1], dv);
        let framed = openings
            * stripes(bay, self.frame[0], self.frame[1], du)
            * stripes(floor, self.sill[0] - 0.035, self.sill[1] + 0.03, dv);
        let frame = most(framed - glass, 0.0);
        // Windows lie back in the wall: the lintel shades their upper edge.
        let recess = stripes(floor, self.sill[1] - 0.07, self.sill[1], dv) * (1.0 - smoothstep(0.4, 1.0, dv));
        let mullion = self.mullions * stripes(bay, 0.488, 0.512, du);
        let mut look = Look::matt(wall.lerp(self.trim, frame), point.normal);
        let glass = glass * (1.0 - 0.8 * mullion);
        self.glaze(&mut look, glass, cell, 1.0 - 0.5 * recess, smoothstep(0.35, 0.9, du), night);
        look
    }

    /// The bare wall: plaster or brick, dirtier at its foot, with a cornice.
    #[inline(always)]
    fn wall_at(&self, point: &SurfacePoint, along_m: f32, up_m: f32, noise: &NoiseTexture) -> Vec3 {
        let size = point.footprint_m;
        let rough = noise.rough(along_m * 14.0 + self.shift, up_m * 14.0, size * 14.0);
        let foot = 1.0 - 0.25 * (1.0 - smoothstep(0.0, 1.6, up_m));
        let course = stripes(up_m / 0.08, 0.0, 0.17, point.footprints_m[1] / 0.08);
        let brick = self.brick * one_if(size < 0.1) * 0.25;
        let wall = self.wall * ((0.78 + 0.44 * rough) * foot * (1.0 - brick * course));
        let crown = band(up_m, self.height_m - 0.55, self.height_m, point.footprints_m[1]);
        wall.lerp(self.trim * 0.9, crown)
    }

    /// Puts glass of a window over a share of the pixel; `mean` 1 where windows are too small to tell apart.
    #[inline(always)]
    fn glaze(&self, look: &mut Look, share: f32, cell: u32, shade: f32, mean: f32, night: Option<f32>) {
        let curtains = unit(hash(cell, 3));
        let drawn = one_if(curtains > 0.62);
        let inside = GLASS.lerp(Vec3::new(0.32, 0.29, 0.24) * (curtains - 0.35), drawn);
        let inside = inside.lerp(Vec3::new(0.09, 0.09, 0.085), mean);
        look.albedo = look.albedo.lerp(inside * shade, share);
        look.mirror = share * self.gloss * shade;
        if let Some(night) = night {
            let lit = unit(hash(cell, 7));
            let one = one_if(lit < 0.30) * (0.12 + 1.3 * lit);
            let strength = one + (0.09 - one) * mean;
            let warm = Vec3::new(1.0, 0.62, 0.26).lerp(Vec3::new(0.80, 0.85, 0.95), unit(hash(cell, 9)) * 0.45);
            look.emission = warm * (strength * share * 0.34 * night);
        }
    }

    /// The street floor: shop windows, doors and a sign band.
    #[inline(always)]
    fn shop(&self, point: &SurfacePoint, along_m: f32, up_m: f32, night: Option<f32>, noise: &NoiseTexture) -> Look {
        let bay = along_m * self.bays_per_m;
        let (du, dv) = (point.footprints_m[0] * self.bays_per_m, point.footprints_m[1]);
        let wall = self.wall_at(point, along_m, up_m, noise);
        let top = self.floor_m;
        let third = bay * (1.0 / 3.0);
        let unit_number = floor_int(third);
        let shop = hash(unit_number as u32, self.seed ^ 0x5407);
        let sign = SIGNS[(shop >> 29) as usize & 7];
        let place = floor_int(bay).wrapping_sub(unit_number.wrapping_mul(3));
        let door = one_if(place == ((shop & 0xffff).wrapping_mul(3) >> 16) as i32);
        let (left, right, low) = (lerp(0.06, 0.28, door), lerp(0.94, 0.72, door), lerp(0.45, 0.02, door));
        let across = stripes(bay, left, right, du);
        let glass = across * band(up_m, low, top - 1.05, dv);
        let sign_share = band(up_m, top - 0.85, top - 0.25, dv) * stripes(third, 0.02, 0.98, du * (1.0 / 3.0));
        let mut look = Look::matt(wall.lerp(sign, sign_share), point.normal);
        self.glaze(&mut look, glass, hash(shop, 1), 1.0, 0.35, night);
        look.albedo = look.albedo.lerp(sign * 0.5, 0.55 * glass * door);
        if let Some(night) = night {
            let open = one_if(unit(hash(shop, 5)) < 0.6) * night;
            look.emission += (sign * 1.2 + Vec3::splat(0.03)) * (sign_share * 0.12 * open)
                + Vec3::new(0.30, 0.21, 0.11) * (glass * (0.06 + 0.22 * unit(hash(shop, 6))) * open);
        }
        look
    }

    #[inline(always)]
    fn paint_all(
        &self,
        shared: &[Shared],
        blocks: &mut [Block],
        place: &BoxFace,
        night: Option<f32>,
        noise: &NoiseTexture,
    ) {
        for (shared, four) in groups(shared, blocks) {
            for block in four {
                let mut in_shop = 0u32;
                for k in 0..WIDE {
                    let point = block.point(shared, k);
                    let up_m = point.world.z - place.foot_m;
                    let look = self.look(&point, place.along_m(&point), up_m, night, noise);
                    block.put(k, &look);
                    in_shop |= u32::from(up_m < self.floor_m);
                }
                if self.shops && in_shop != 0 {
                    for k in 0..WIDE {
                        let point = block.point(shared, k);
                        let up_m = point.world.z - place.foot_m;
                        let shop = self.shop(&point, place.along_m(&point), up_m, night, noise);
                        let look = block.look(k).lerp(&shop, one_if(up_m < self.floor_m));
                        block.put(k, &look);
                    }
                }
            }
        }
    }
}

/// Place of a point on a box's upright face.
#[derive(Clone, Copy, Debug)]
pub struct BoxFace {
    /// The face's horizontal.
    pub along: Vec3,
    /// `along` of the edge from which lengths are counted, metres.
    pub edge_m: f32,
    /// Height of the box's foot, metres.
    pub foot_m: f32,
}

impl BoxFace {
    #[inline(always)]
    fn along_m(&self, point: &SurfacePoint) -> f32 {
        point.world.x * self.along.x + point.world.y * self.along.y - self.edge_m
    }
}

simd_kernel! {
    /// The look of a facade.
    pub fn facade(
        shared: &[Shared],
        blocks: &mut [Block],
        facade: &Facade,
        place: &BoxFace,
        night: f32,
        noise: &NoiseTexture,
    ) {
        let (facade, place) = (*facade, *place);
        if night > 0.0 {
            facade.paint_all(shared, blocks, &place, Some(night), noise);
        } else {
            facade.paint_all(shared, blocks, &place, None, noise);
        }
    }
}

simd_kernel! {
    /// The look of a flat roof.
    pub fn roofs(shared: &[Shared], blocks: &mut [Block], roof: &Roof, noise: &NoiseTexture) {
        let roof = *roof;
        for (shared, four) in groups(shared, blocks) {
            for block in four {
                for k in 0..WIDE {
                    let look = roof.look(&block.point(shared, k), noise);
                    block.put(k, &look);
                }
            }
        }
    }
}

/// Properties of a whole roof.
#[derive(Clone, Copy, Debug)]
pub struct Roof {
    seed: u32,
    tone: Vec3,
    shift: f32,
    center: Vec3,
    axes: [Vec3; 2],
    half_m: [f32; 2],
}

impl Roof {
    /// The flat roof of a building `seed` around `center`, `half_m` half its size along `axes`.
    pub fn new(seed: u32, center: Vec3, axes: [Vec3; 2], half_m: [f32; 2]) -> Self {
        let tones = [Vec3::new(0.20, 0.19, 0.18), Vec3::new(0.34, 0.32, 0.29), Vec3::new(0.12, 0.12, 0.125)];
        let tone = tones[(draw(seed, 20) * 3.0) as usize % 3];
        Self { seed, tone, shift: unit(seed) * 99.0, center, axes, half_m }
    }

    /// Colour without patterns.
    pub fn colour(&self) -> Vec3 {
        self.tone
    }

    #[inline(always)]
    fn look(&self, point: &SurfacePoint, noise: &NoiseTexture) -> Look {
        let size = point.footprint_m;
        let away = point.world - self.center;
        let (x, y) = (away.dot(self.axes[0]), away.dot(self.axes[1]));
        let rough = noise.rough(x * 10.0 + self.shift, y * 10.0, size * 10.0);
        let stain = noise.clumps(x * 1.5 + self.shift, y * 1.5, size * 1.5);
        // Seams of the roofing, skylights and machinery on a grid.
        let seam = stripes(x * (1.0 / 3.0), 0.0, 0.03, point.footprints_m[0] * (1.0 / 3.0));
        let mut albedo = self.tone * ((0.5 + 0.5 * rough + 0.5 * stain) * (1.0 - 0.25 * seam));
        let (u, v) = (x * 0.2, y * 0.2);
        let cell = hash(floor_int(u) as u32, floor_int(v) as u32 ^ self.seed);
        let inner = least(self.half_m[0] - x.abs(), self.half_m[1] - y.abs());
        let there = one_if((unit(cell) < 0.16) & (inner > 3.0));
        let (du, dv) = (point.footprints_m[0] * 0.2, point.footprints_m[1] * 0.2);
        let side = 0.16 + 0.16 * unit(hash(cell, 1));
        let shadow = stripes(u, 0.5 - side, 0.5 + side + 0.05, du) * stripes(v, 0.5 - side, 0.5 + side + 0.07, dv);
        let machine = stripes(u, 0.5 - side, 0.5 + side, du) * stripes(v, 0.5 - side, 0.5 + side, dv);
        albedo *= 1.0 - 0.55 * shadow * there;
        let skylight = one_if(unit(hash(cell, 2)) < 0.4);
        let metal = Vec3::splat(0.46).lerp(Vec3::new(0.10, 0.16, 0.22), skylight);
        albedo = albedo.lerp(metal * (0.8 + 0.3 * rough), machine * there);
        let parapet = band(inner, -1.0, 0.35, size) - 0.5 * band(inner, 0.35, 0.6, size);
        albedo = albedo.lerp(Vec3::splat(0.42), most(parapet, 0.0)) * (1.0 - 0.4 * most(-parapet, 0.0));
        Look::matt(albedo, point.normal)
    }
}
