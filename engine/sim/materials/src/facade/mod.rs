//! Buildings: facades with storeys, deep windows, balconies, shops and doors, and flat and pitched roofs, all drawn from the building's
//! seed and its family.

mod family;
mod roof;
mod tiles;

pub use roof::{Roof, roofs};
pub use tiles::{Tiles, lift, tiles};

use super::lanes::{Block, Lane, Shared, WIDE, get, groups, set};
use super::light::Light;
use super::pattern::{
    NoiseLevel, NoiseLevels, NoiseTexture, Noises, band, draw, floor_int, hash, least, lerp, most, one_if, share,
    smoothstep, stripes, unit,
};
use super::surface::{Look, SurfacePoint};
use super::vector::Vec3;
use cosfly_frames::simd_kernel;
use family::{Family, between, chance};

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

/// Balconies stand out of the wall by this much, metres.
const BALCONY_M: f32 = 1.1;
/// Height of their rails, metres.
const RAIL_M: f32 = 1.0;
/// Awnings stand out by this much, metres.
const AWNING_M: f32 = 1.0;

/// Texels of the plaster's grain per metre.
const GRAIN_PER_M: f32 = 14.0;
/// Height of the darker foot of a wall, and of its cornice, metres.
const FOOT_M: f32 = 2.2;
const CORNICE_M: f32 = 0.45;

/// Shadows within windows fade until pixels are as large as this, metres.
const FINE_M: f32 = 0.2;
/// And balconies until they are as large as this, metres.
const COARSE_M: f32 = 0.8;

/// Properties of a whole facade.
#[derive(Clone, Copy, Debug)]
pub struct Facade {
    seed: u32,
    wall: Vec3,
    trim: Vec3,
    rail: Vec3,
    door: Vec3,
    bays_per_m: f32,
    floors_per_m: f32,
    floor_m: f32,
    floors: f32,
    window: [f32; 2],
    sill: [f32; 2],
    /// Depth of the panes in the wall, metres.
    reveal_m: f32,
    /// Share of a mirror in the glass.
    gloss: f32,
    /// 1 where windows have a bar in the middle.
    mullions: f32,
    /// 1 for walls of bricks.
    brick: f32,
    /// Strength of ledges and of joints between panels.
    ledge: f32,
    joint: f32,
    /// Height of either, share of a storey.
    course: f32,
    /// Strength of dirt.
    age: f32,
    /// Share of the columns of bays that have balconies.
    balconies: f32,
    shops: bool,
    height_m: f32,
    shift: f32,
}

/// How lines through the face move along it, metres along and up per metre of depth.
#[derive(Clone, Copy)]
struct Slant {
    along: f32,
    up: f32,
}

impl Facade {
    /// The facade of a building `seed` in a town on a face of this size.
    pub fn new(seed: u32, town: u32, face: u32, width_m: f32, height_m: f32) -> Self {
        let family = Family::of(seed, town, height_m);
        let [wall, trim] = family.colours(seed);
        let floors = (height_m / between(family.storey_m, seed, 3)).round().max(1.0);
        let bay_m = width_m / (width_m / between(family.bay_m, seed, 4)).round().max(1.0);
        let share = between(family.share, seed, 6);
        let rails = [Vec3::splat(0.06), Vec3::splat(0.5), trim, Vec3::new(0.16, 0.22, 0.24)];
        Self {
            seed: hash(seed, face),
            wall,
            trim,
            rail: rails[(draw(seed, 12) * 4.0) as usize % 4],
            door: SIGNS[(draw(seed, 14) * 8.0) as usize % 8] * 0.6,
            bays_per_m: 1.0 / bay_m,
            floors_per_m: floors / height_m,
            floor_m: height_m / floors,
            floors,
            window: [0.5 - 0.5 * share, 0.5 + 0.5 * share],
            sill: [between(family.sill[0], seed, 7), between(family.sill[1], seed, 8)],
            reveal_m: family.reveal_m,
            gloss: family.gloss,
            mullions: if family.mullion { 1.0 } else { 0.0 },
            brick: if family.brick { 1.0 } else { 0.0 },
            ledge: family.ledge,
            joint: family.joint,
            course: if family.joint > 0.0 { 0.012 } else { 0.05 },
            age: between(family.age, seed, 9),
            // Streets have more of them than yards.
            balconies: if floors > 1.5 { chance(family.balconies, hash(seed, face), 13) * 0.55 } else { 0.0 },
            shops: draw(seed, 10) < family.shops && height_m > 5.0,
            height_m,
            shift: 200.0 * draw(seed, 11),
        }
    }

    /// The same wall without anything in it: a gable.
    pub fn bare(self) -> Self {
        let bare = Self { window: [0.5; 2], shops: false, balconies: 0.0, ledge: 0.0, joint: 0.0, ..self };
        // No cornice.
        Self { height_m: self.height_m + 100.0, ..bare }
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

    /// The wall at `along_m` from one edge and `up_m` above the building's foot, and how much of the place is opening.
    #[inline(always)]
    fn wall_and_opening(&self, point: &SurfacePoint, [along_m, up_m]: [f32; 2], wall: Vec3) -> (Look, f32) {
        let (bay, floor) = (along_m * self.bays_per_m, up_m * self.floors_per_m);
        let (du, dv) = (point.footprints_m[0] * self.bays_per_m, point.footprints_m[1] * self.floors_per_m);
        // A ledge between storeys, or the joint between panels.
        let ledge = stripes(floor, 0.0, self.course, dv);
        let wall = wall.lerp(self.trim, self.ledge * ledge) * (1.0 - self.joint * ledge);
        let openings = one_if(floor < self.floors - 0.02);
        let opening = openings
            * stripes(bay, self.window[0], self.window[1], du)
            * stripes(floor, self.sill[0], self.sill[1], dv);
        (Look::matt(wall, point.normal), opening)
    }

    /// A window in an opening of the wall: the pane lies deeper than the wall, within a frame.
    #[inline(always)]
    fn window(
        &self,
        look: &Look,
        opening: f32,
        point: &SurfacePoint,
        [along_m, up_m]: [f32; 2],
        view: Slant,
        night: Option<f32>,
    ) -> Look {
        let (bay, floor) = (along_m * self.bays_per_m, up_m * self.floors_per_m);
        let (du, dv) = (point.footprints_m[0] * self.bays_per_m, point.footprints_m[1] * self.floors_per_m);
        let (deep_along, deep_up) = (self.reveal_m * view.along, self.reveal_m * view.up);
        let (deep_bay, deep_floor) = (bay + deep_along * self.bays_per_m, floor + deep_up * self.floors_per_m);
        let pane = opening
            * stripes(deep_bay, self.window[0] + 0.02, self.window[1] - 0.02, du)
            * stripes(deep_floor, self.sill[0] + 0.02, self.sill[1] - 0.02, dv);
        let frame = most(opening - pane, 0.0);
        let mullion = self.mullions * stripes(deep_bay, 0.488, 0.512, du);
        let mut look = Look { albedo: look.albedo.lerp(self.trim * 0.82, frame), ..*look };
        let cell = hash(floor_int(deep_bay) as u32, floor_int(floor) as u32 ^ self.seed);
        let glass = pane * (1.0 - 0.8 * mullion);
        self.glaze(&mut look, glass, cell, 1.0, smoothstep(0.35, 0.9, du), night);
        look
    }

    /// The share of sunlight that lintels and jambs let through to an opening.
    #[inline(always)]
    fn lit(&self, point: &SurfacePoint, opening: f32, [along_m, up_m]: [f32; 2], [view, sun]: [Slant; 2]) -> f32 {
        let (bay, floor) = (along_m * self.bays_per_m, up_m * self.floors_per_m);
        let (du, dv) = (point.footprints_m[0] * self.bays_per_m, point.footprints_m[1] * self.floors_per_m);
        let (across, up) = (self.reveal_m * (view.along + sun.along), self.reveal_m * (view.up + sun.up));
        let open = stripes(bay + across * self.bays_per_m, self.window[0], self.window[1], du)
            * stripes(floor + up * self.floors_per_m, self.sill[0], self.sill[1], dv);
        1.0 - opening * (1.0 - open)
    }

    /// Streaks of dirt under sills and roofs: the share of light that they leave.
    #[inline(always)]
    fn dirt(&self, point: &SurfacePoint, [along_m, up_m]: [f32; 2], noise: &NoiseTexture) -> f32 {
        let streak = noise.clumps(along_m * 11.0 + self.shift, up_m * 1.3 + self.shift, point.footprint_m * 5.0);
        1.0 - self.age * 0.5 * smoothstep(0.42, 0.80, streak)
    }

    /// Grain of the plaster.
    #[inline(always)]
    fn grain(&self, along_m: f32, up_m: f32, fine: NoiseLevel, noise: &NoiseTexture) -> f32 {
        noise.rough_at(along_m * GRAIN_PER_M + self.shift, up_m * GRAIN_PER_M, fine)
    }

    /// Joints between courses of bricks.
    #[inline(always)]
    fn courses(&self, point: &SurfacePoint, up_m: f32) -> f32 {
        let course = stripes(up_m / 0.08, 0.0, 0.17, point.footprints_m[1] / 0.08);
        1.0 - self.brick * one_if(point.footprint_m < 0.1) * 0.25 * course
    }

    /// Plaster or brick, with the share of light that the foot of the wall leaves.
    #[inline(always)]
    fn plaster(&self, grain: f32, foot: f32, dirt: f32, courses: f32) -> Vec3 {
        self.wall * ((0.78 + 0.44 * grain) * foot * dirt * courses)
    }

    /// The bare wall: plaster or brick, a base of darker stone and a cornice.
    #[inline(always)]
    fn wall_at(&self, point: &SurfacePoint, up_m: f32, grain: f32, dirt: f32, courses: f32) -> Vec3 {
        let foot = 1.0 - (0.15 + 0.2 * self.age) * (1.0 - smoothstep(0.0, FOOT_M, up_m));
        let wall = self.plaster(grain, foot, dirt, courses);
        let dv = point.footprints_m[1];
        let base = band(up_m, -1.0, 0.55, dv);
        let wall = wall.lerp(Vec3::splat(0.20) * (0.6 + 0.6 * grain), 0.7 * base);
        let crown = band(up_m, self.height_m - CORNICE_M, self.height_m + 1.0, dv);
        wall.lerp(self.trim * 0.9, crown)
    }

    /// Whether a wall is bare of base and cornice at a place.
    #[inline(always)]
    fn is_middle(&self, point: &SurfacePoint, up_m: f32) -> bool {
        let dv = point.footprints_m[1];
        (up_m - dv > FOOT_M) & (up_m + dv < self.height_m - CORNICE_M)
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
    fn shop(
        &self,
        point: &SurfacePoint,
        along_m: f32,
        up_m: f32,
        view: Slant,
        night: Option<f32>,
        [grain, courses]: [f32; 2],
    ) -> Look {
        let bay = along_m * self.bays_per_m;
        let (du, dv) = (point.footprints_m[0] * self.bays_per_m, point.footprints_m[1]);
        let wall = self.wall_at(point, up_m, grain, 1.0, courses);
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
        // An awning: cloth that stands out, and glass in its shade.
        let has = one_if(unit(hash(shop, 8)) < 0.4);
        let (out_along, out_up) = (along_m - 0.5 * AWNING_M * view.along, up_m - 0.5 * AWNING_M * view.up);
        let out_third = out_along * (self.bays_per_m / 3.0);
        let width = stripes(out_third, 0.03, 0.97, du * (1.0 / 3.0));
        let cloth = has * width * band(out_up, top - 1.35, top - 0.85, dv);
        let pale = stripes(out_along * 1.6, 0.0, 0.5, point.footprints_m[0] * 1.6);
        look.albedo = look.albedo.lerp(sign.lerp(Vec3::splat(0.62), 0.85 * pale), cloth);
        (look.emission, look.mirror) = (look.emission * (1.0 - cloth), look.mirror * (1.0 - cloth));
        look
    }

    /// A house door among the windows of the street floor.
    #[inline(always)]
    fn entrance(&self, look: Look, point: &SurfacePoint, along_m: f32, up_m: f32) -> Look {
        let bay = along_m * self.bays_per_m;
        let (du, dv) = (point.footprints_m[0] * self.bays_per_m, point.footprints_m[1]);
        let number = floor_int(bay) as u32;
        let here = one_if(unit(hash(number, self.seed ^ 0xd005)) < 0.16);
        let (wide, high) = (0.55 * self.bays_per_m, least(2.25, self.floor_m - 0.4));
        let door = here * stripes(bay, 0.5 - wide, 0.5 + wide, du) * band(up_m, 0.08, high, dv);
        let framed = here * stripes(bay, 0.5 - 1.3 * wide, 0.5 + 1.3 * wide, du) * band(up_m, 0.0, high + 0.18, dv);
        let colour = self.door;
        let bare = Look { mirror: look.mirror * (1.0 - framed), ..look };
        Look { albedo: look.albedo.lerp(self.trim, framed).lerp(colour, door), ..bare }
    }

    /// 1 where a column of balconies and a storey meet.
    #[inline(always)]
    fn has_balcony(&self, u: f32, floor: f32) -> f32 {
        let column = unit(hash(floor_int(u) as u32, self.seed ^ 0xba1c));
        one_if((column < self.balconies) & (floor > 1.0) & (floor < self.floors - 0.3))
    }

    /// Whether a balcony may be seen, or may take sunlight.
    #[inline(always)]
    fn near_balcony(&self, [along_m, up_m]: [f32; 2], view: Slant, sun: Slant) -> bool {
        let (half, floor) = (0.5 * self.bays_per_m, up_m * self.floors_per_m);
        let (u, passed) = ((along_m - BALCONY_M * view.along) * half, (up_m - BALCONY_M * view.up) * self.floors_per_m);
        let shaded_u = (along_m + 0.6 * BALCONY_M * sun.along) * half;
        let has = self.has_balcony(u, passed) + self.has_balcony(along_m * half, floor);
        has + self.has_balcony(shaded_u, floor + 0.9) > 0.0
    }

    /// A balcony before a look, and the share of sunlight that balconies let through to it.
    #[inline(always)]
    fn balcony(
        &self,
        look: &Look,
        point: &SurfacePoint,
        [along_m, up_m]: [f32; 2],
        [view, sun]: [Slant; 2],
    ) -> (Look, f32) {
        let half = 0.5 * self.bays_per_m;
        let (du, dv) = (point.footprints_m[0] * half, point.footprints_m[1] * self.floors_per_m);
        let rail = RAIL_M * self.floors_per_m;
        // Where the line of sight passes the rail.
        let (u, floor) = ((along_m - BALCONY_M * view.along) * half, (up_m - BALCONY_M * view.up) * self.floors_per_m);
        let front = self.has_balcony(u, floor) * stripes(u, 0.08, 0.92, du);
        let slab = front * stripes(floor, 0.0, 0.06, dv);
        let bars = front * stripes(floor, 0.0, rail, dv);
        // Between rail and wall one looks down on the floor of the balcony, or up at it.
        let depth = (up_m * self.floors_per_m - floor).abs();
        let inside =
            self.has_balcony(along_m * half, floor) * stripes(up_m * self.floors_per_m, 0.0, least(depth, 0.5), dv);
        let albedo = look.albedo.lerp(Vec3::splat(0.30), 0.8 * inside * front);
        let albedo = albedo.lerp(self.rail, 0.86 * bars).lerp(self.trim * 0.85, slab);
        let kept = (1.0 - 0.86 * bars) * (1.0 - slab);
        let emission = look.emission * kept;
        let drop = most(BALCONY_M * sun.up * self.floors_per_m, 0.0);
        let shaded_u = (along_m + 0.6 * BALCONY_M * sun.along) * half;
        let shadow = self.has_balcony(shaded_u, up_m * self.floors_per_m + 0.9)
            * stripes(shaded_u, 0.08, 0.92, du)
            * stripes(up_m * self.floors_per_m + drop, 0.0, least(most(drop, rail), 0.95), dv);
        let lit = 1.0 - 0.9 * shadow * (1.0 - most(bars, slab));
        (Look { albedo, emission, mirror: look.mirror * kept, ..*look }, lit)
    }

    #[inline(always)]
    fn paint_all(
        &self,
        shared: &[Shared],
        blocks: &mut [Block],
        place: &BoxFace,
        (night, to_sun): (Option<f32>, Vec3),
        noise: &NoiseTexture,
    ) {
        let sunny = shared.first().is_some_and(|shared| get(&shared.normal, 0).dot(to_sun) > 0.0);
        for (shared, four) in groups(shared, blocks) {
            let mut views = [[0.0f32; WIDE]; 2];
            let mut suns = [[0.0f32; WIDE]; 2];
            let (mut fine, mut coarse) = ([0.0f32; WIDE], [0.0f32; WIDE]);
            let (mut any_fine, mut any_coarse) = (0u32, 0u32);
            for ((fine, coarse), pixel_m) in fine.iter_mut().zip(&mut coarse).zip(shared.footprint_m) {
                (*fine, *coarse) = (fade(pixel_m, FINE_M), fade(pixel_m, COARSE_M));
                any_fine |= u32::from(*fine > 0.0);
                any_coarse |= u32::from(*coarse > 0.0);
            }
            let fine_grain = NoiseLevels::of(&shared.footprint_m, GRAIN_PER_M);
            let mut dirt = [1.0f32; WIDE];
            for (k, dirt) in dirt.iter_mut().enumerate() {
                let middle = shared.point(k);
                *dirt = self.dirt(&middle, [place.along_m(&middle), middle.world.z - place.foot_m], noise);
                let (ray, normal) = (get(&shared.ray, k), get(&shared.normal, k));
                let deep = 1.0 / most(-ray.dot(normal), 0.2 * ray.dot(ray).sqrt());
                (views[0][k], views[1][k]) = (ray.dot(place.along) * deep, ray.z * deep);
                let out = 1.0 / most(to_sun.dot(normal), 0.2);
                (suns[0][k], suns[1][k]) = (to_sun.dot(place.along) * out, to_sun.z * out);
            }
            for block in four {
                let (mut in_street, mut opens, mut at_ends) = (0u32, 0u32, 0u32);
                let mut grain = [0.0f32; WIDE];
                for (k, grain) in grain.iter_mut().enumerate() {
                    let point = block.point(shared, k);
                    let up_m = point.world.z - place.foot_m;
                    *grain = self.grain(place.along_m(&point), up_m, fine_grain.at(k), noise);
                    in_street |= u32::from(up_m < self.floor_m);
                    at_ends |= u32::from(!self.is_middle(&point, up_m));
                }
                let mut courses = [1.0f32; WIDE];
                if self.brick > 0.0 {
                    for (k, courses) in courses.iter_mut().enumerate() {
                        let point = block.point(shared, k);
                        *courses = self.courses(&point, point.world.z - place.foot_m);
                    }
                }
                if at_ends != 0 {
                    for k in 0..WIDE {
                        let point = block.point(shared, k);
                        let up_m = point.world.z - place.foot_m;
                        set(&mut block.albedo, k, self.wall_at(&point, up_m, grain[k], dirt[k], courses[k]));
                    }
                } else {
                    for k in 0..WIDE {
                        set(&mut block.albedo, k, self.plaster(grain[k], 1.0, dirt[k], courses[k]));
                    }
                }
                for k in 0..WIDE {
                    let point = block.point(shared, k);
                    let at = [place.along_m(&point), point.world.z - place.foot_m];
                    let (look, opening) = self.wall_and_opening(&point, at, get(&block.albedo, k));
                    block.put(k, &look);
                    block.openness[k] = opening;
                    opens |= u32::from(opening > 0.0);
                }
                // Between two rows of windows there are none.
                if opens != 0 {
                    for k in 0..WIDE {
                        let point = block.point(shared, k);
                        let at = [place.along_m(&point), point.world.z - place.foot_m];
                        let look = self.window(&block.look(k), block.openness[k], &point, at, slant(&views, k), night);
                        block.put(k, &look);
                    }
                }
                let mut is_lit = 0u32;
                for lit in block.sunlight {
                    is_lit |= u32::from(lit > 0.0);
                }
                if opens & is_lit & any_fine != 0 && sunny {
                    for (k, fine) in fine.iter().enumerate() {
                        let point = block.point(shared, k);
                        let at = [place.along_m(&point), point.world.z - place.foot_m];
                        let opening = fine * block.openness[k];
                        block.sunlight[k] *= self.lit(&point, opening, at, [slant(&views, k), slant(&suns, k)]);
                    }
                }
                if self.shops && in_street != 0 {
                    for k in 0..WIDE {
                        let point = block.point(shared, k);
                        let up_m = point.world.z - place.foot_m;
                        let wall = [grain[k], courses[k]];
                        let shop = self.shop(&point, place.along_m(&point), up_m, slant(&views, k), night, wall);
                        let look = block.look(k).lerp(&shop, one_if(up_m < self.floor_m));
                        block.put(k, &look);
                    }
                }
                if !self.shops && in_street != 0 {
                    for k in 0..WIDE {
                        let point = block.point(shared, k);
                        let up_m = point.world.z - place.foot_m;
                        let door = self.entrance(block.look(k), &point, place.along_m(&point), up_m);
                        let look = block.look(k).lerp(&door, one_if(up_m < self.floor_m));
                        block.put(k, &look);
                    }
                }
                if self.balconies > 0.0 && any_coarse != 0 {
                    let mut any = 0u32;
                    for k in 0..WIDE {
                        let point = block.point(shared, k);
                        let at = [place.along_m(&point), point.world.z - place.foot_m];
                        any |= u32::from(self.near_balcony(at, slant(&views, k), slant(&suns, k)));
                    }
                    if any == 0 {
                        continue;
                    }
                    for (k, coarse) in coarse.iter().enumerate() {
                        let point = block.point(shared, k);
                        let at = [place.along_m(&point), point.world.z - place.foot_m];
                        let bare = block.look(k);
                        let (look, lit) = self.balcony(&bare, &point, at, [slant(&views, k), slant(&suns, k)]);
                        block.put(k, &bare.lerp(&look, *coarse));
                        block.sunlight[k] *= lerp(1.0, lit, *coarse);
                    }
                }
            }
        }
    }
}

/// 1 where pixels are much smaller than a size, 0 from there on, metres.
#[inline(always)]
fn fade(pixel_m: f32, size_m: f32) -> f32 {
    share((1.0 - pixel_m * (1.0 / size_m)) * 4.0)
}

/// The slant of lines at pixel `k`.
#[inline(always)]
fn slant([along, up]: &[Lane; 2], k: usize) -> Slant {
    Slant { along: along[k], up: up[k] }
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
        light: &Light,
        noise: &NoiseTexture,
    ) {
        let (facade, place, night, to_sun) = (*facade, *place, light.night, light.to_sun);
        if night > 0.0 {
            facade.paint_all(shared, blocks, &place, (Some(night), to_sun), noise);
        } else {
            facade.paint_all(shared, blocks, &place, (None, to_sun), noise);
        }
    }
}
