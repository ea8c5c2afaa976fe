//! Sheet, glass and rubber of vehicles: gaps of doors and lids, seats behind the glass, dirt near the road.

use super::geometry::View;
use cosfly_figures::{Fittings, Region};
use cosfly_frames::DVec3;
use cosfly_frames::simd_kernel;
use cosfly_materials::lanes::{Block, Shared, WIDE, get, groups, set};
use cosfly_materials::pattern::{NoiseTexture, Noises, band, floor_int, hash, least, most, one_if, share, stripes};
use cosfly_materials::vector::Vec3;

/// Half the width of a gap between two panels of sheet, metres.
const HALF_GAP_M: f32 = 0.004;
/// Dust of roads.
const DUST: Vec3 = Vec3::new(0.17, 0.15, 0.125);
/// Red glass of lamps at the tail, and how much they glow at night.
const TAIL_LAMP: Vec3 = Vec3::new(0.22, 0.008, 0.010);
const TAIL_GLOW: f32 = 1.9;
/// Bumpers below, and badges.
const PLASTIC: Vec3 = Vec3::new(0.014, 0.014, 0.014);
const BADGE: Vec3 = Vec3::new(0.30, 0.31, 0.32);
/// Tape along the boxes of lorries.
const TAPE: Vec3 = Vec3::new(0.40, 0.02, 0.02);
/// Shares of light that sides lose to the road and to what stands around: 1 m above the ground, and how much more at the ground. Under
/// clouds, doors of a real car have a half to an eighth of the light of its roof, and the shoulder below the windows has as much.
const SIDES: f32 = 0.30;
const LOW: f32 = 0.70;
/// Light that comes into a cabin and out of it again.
const BEHIND_GLASS: f32 = 0.30;

/// A region of a vehicle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coach {
    pub(super) colour: Vec3,
    /// Multiple of what a smooth coat mirrors.
    mirror: f32,
    emission: Vec3,
    kind: Kind,
    /// The camera, metres, and the size of a pixel at a distance of 1.
    eye: Vec3,
    pixel: f32,
    /// The middle of the box's foot, its own axes, and its size, metres.
    feet: Vec3,
    along: Vec3,
    side: Vec3,
    half_width_m: f32,
    height_m: f32,
    /// Places along, metres; heights of the gaps of doors.
    doors: [f32; 3],
    door_heights: [f32; 2],
    bonnet: [f32; 2],
    boot: [f32; 2],
    gutter_m: f32,
    bumper_m: f32,
    half_length_m: f32,
    /// Lamps at the tail: where they begin from the middle, lower and upper edge, metres; their light at night.
    tail_lamps: [f32; 3],
    glow: f32,
    skirt_m: f32,
    rear_plate_m: f32,
    /// The sign on both sides: ends of the word, its edges, those of the band, metres.
    sign: Vec3,
    word: [f32; 2],
    word_heights: [f32; 2],
    band: [f32; 2],
    letters: u32,
    /// One where there are two doors behind.
    rear_doors: f32,
    seats: [f32; 2],
    dirt: f32,
    /// Share of light lost where paint is seen along.
    flakes: f32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Sheet,
    Cargo,
    Glass,
    Other,
}

impl Coach {
    /// The look of a region of a vehicle at `place`: its feet in the world, and the unit vector to its right. `night` is 1 when
    /// lamps are lit.
    pub(super) fn new(
        (region, colour): (Region, Vec3),
        fittings: &Fittings,
        (feet, side): (DVec3, Vec3),
        night: f32,
        view: &View,
    ) -> Self {
        let (mirror, glow, kind) = match region {
            Region::Paint => (1.0, 0.0, Kind::Sheet),
            Region::Cargo => (0.5, 0.0, Kind::Cargo),
            Region::Glass => (1.7, 0.0, Kind::Glass),
            Region::Metal => (4.0, 0.0, Kind::Other),
            Region::HeadLamp => (1.6, 2.4, Kind::Other),
            Region::TailLamp => (1.6, TAIL_GLOW, Kind::Other),
            Region::Trim => (0.3, 0.0, Kind::Other),
            _ => (0.0, 0.0, Kind::Other),
        };
        let (size_m, [inner, low, high], [red, green, blue]) =
            (fittings.size_m, fittings.tail_lamps, fittings.sign.colour);
        let along_m = |x: f64| (x * size_m.x) as f32;
        Self {
            colour,
            mirror,
            emission: colour * (glow * night),
            kind,
            eye: view.position,
            pixel: view.pixel(),
            feet: feet.into(),
            along: Vec3::new(side.y, -side.x, 0.0),
            side,
            half_width_m: (0.5 * size_m.y) as f32,
            height_m: size_m.z as f32,
            doors: fittings.doors.map(along_m),
            door_heights: fittings.door_heights.map(|z| (z * size_m.z) as f32),
            bonnet: fittings.bonnet.map(along_m),
            boot: fittings.boot.map(along_m),
            gutter_m: (fittings.gutter * size_m.y) as f32,
            bumper_m: (fittings.bumper * size_m.z) as f32,
            half_length_m: (0.5 * size_m.x) as f32,
            tail_lamps: [(0.5 * inner * size_m.y) as f32, (low * size_m.z) as f32, (high * size_m.z) as f32],
            glow: night,
            sign: Vec3::new(red, green, blue),
            word: fittings.sign.word.map(along_m),
            word_heights: fittings.sign.heights.map(|z| (z * size_m.z) as f32),
            band: fittings.sign.band.map(|z| (z * size_m.z) as f32),
            letters: fittings.sign.letters,
            skirt_m: (fittings.skirt * size_m.z) as f32,
            rear_plate_m: (fittings.rear_plate * size_m.z) as f32,
            rear_doors: f32::from(u8::from(fittings.has_rear_doors)),
            seats: fittings.seats.map(along_m),
            dirt: fittings.dirt as f32,
            flakes: if fittings.flakes { 0.45 } else { 0.0 },
        }
    }

    /// A place in the vehicle's own axes, metres.
    #[inline(always)]
    fn own(&self, world: Vec3) -> Vec3 {
        let away = world - self.feet;
        Vec3::new(away.dot(self.along), away.dot(self.side), away.z)
    }

    /// Share of a pixel that gaps of doors and lids, gutters and handles take; `upward` is 1 on top and 0 on the sides.
    #[inline(always)]
    fn gaps(&self, own: Vec3, upward: f32, footprint_m: f32) -> f32 {
        let reach = HALF_GAP_M + 0.5 * footprint_m;
        let most_of_it = 2.0 * HALF_GAP_M / reach;
        let line = |away_m: f32| share(1.0 - away_m.abs() / (2.0 * reach)) * most_of_it;
        let within = |value: f32, [low, high]: [f32; 2]| share((value - low) / reach) * share((high - value) / reach);
        let [first, second, third] = self.doors;
        let upright = most(most(line(own.x - first), line(own.x - second)), line(own.x - third));
        let doors = upright * within(own.z, self.door_heights);
        let last = if third < first { third } else { second };
        let below = line(own.z - self.door_heights[0]) * within(own.x, [last, first]);
        let behind = most(within(own.x, [second + 0.05, second + 0.22]), within(own.x, [third + 0.05, third + 0.22]));
        let grip_m = self.door_heights[1] - 0.10;
        let handles = behind * within(own.z, [grip_m - 0.018, grip_m + 0.018]);
        let ends = line(own.z - self.bumper_m) * share((own.x.abs() - 0.86 * self.half_length_m) / reach);
        let aside = most(most(doors, below), most(handles, ends));
        let (edge_m, across) = (0.70 * self.half_width_m, own.y.abs());
        let lid = |[back, front]: [f32; 2], end: f32| {
            most(
                line(across - edge_m) * within(own.x, [back, front]),
                line(own.x - end) * share((edge_m - across) / reach),
            )
        };
        let lids = most(lid(self.bonnet, self.bonnet[1]), lid(self.boot, self.boot[0]));
        let halves = line(own.y) * within(own.z, [self.bumper_m, 0.92 * self.height_m]) * self.rear_doors;
        let halves = halves * share((-own.x - 0.86 * self.half_length_m) / reach);
        let gutters = line(across - self.gutter_m) * share((own.z - 0.88 * self.height_m) / reach);
        most(aside, halves) * (1.0 - upward) + most(lids, gutters) * upward
    }

    /// Share of a pixel that lamps at the tail take. They reach round the corners.
    #[inline(always)]
    fn tail_lamp(&self, own: Vec3, footprint_m: f32) -> f32 {
        let (per_reach, [inner, low, high]) = (1.0 / (0.008 + footprint_m), self.tail_lamps);
        let within = |away_m: f32| share(0.5 + away_m * per_reach);
        let behind = within(-own.x - self.half_length_m + 0.24);
        within(own.z - low) * within(high - own.z) * within(own.y.abs() - inner) * behind
    }

    /// Shares of a pixel that dark plastic and metal take: the lower part of the bumpers, the recess of the plate at the tail, a badge.
    #[inline(always)]
    fn fascia(&self, own: Vec3, footprint_m: f32) -> [f32; 2] {
        let per_reach = 1.0 / (0.006 + footprint_m);
        let within = |away_m: f32| share(0.5 + away_m * per_reach);
        let at_end = within(own.x.abs() - 0.90 * self.half_length_m);
        let behind = within(-own.x - 0.93 * self.half_length_m);
        let (across, above_m) = (own.y.abs(), own.z - self.rear_plate_m);
        let recess = behind * within(0.33 - across) * within(0.085 - above_m.abs());
        let badge = behind * within(0.055 - across) * within(0.045 - (above_m - 0.20).abs());
        [most(within(self.skirt_m - own.z) * at_end, 0.85 * recess), badge]
    }

    /// Share of a pixel that the sign on the sides takes; `aside` is 1 on a side.
    #[inline(always)]
    fn signed(&self, own: Vec3, aside: f32, footprint_m: f32) -> f32 {
        let per_reach = 1.0 / (0.01 + footprint_m);
        let within = |away_m: f32| share(0.5 + away_m * per_reach);
        let (word, [low, high]) = (self.word, self.word_heights);
        let letter_m = 0.8 * (high - low);
        // On the left, words run backwards.
        let from_m = if own.y < 0.0 { word[1] - own.x } else { own.x - word[0] };
        let [u, v] = [from_m / letter_m, (own.z - low) / (high - low)];
        let letter = floor_int(u);
        let (bits, u) = (hash(self.letters, letter as u32), u - letter as f32);
        let has = |bit: u32| one_if((bits >> bit) & 1 == 1);
        let bar = |at: f32, place: f32, length_m: f32| within((0.11 - (at - place).abs()) * length_m);
        let stems = most(bar(u, 0.13, letter_m), bar(u, 0.67, letter_m) * has(3));
        let bars = [bar(v, 0.89, letter_m) * has(4), bar(v, 0.5, letter_m) * has(5), bar(v, 0.11, letter_m) * has(6)];
        let across = within(most(0.78 - u, 0.0) * letter_m) * one_if(u < 0.78);
        let strokes = most(stems, most(bars[0], most(bars[1], bars[2])) * across);
        let is_whole = one_if((letter + 1) as f32 * letter_m < word[1] - word[0]);
        let inside = within(own.x - word[0]) * within(word[1] - own.x) * within(own.z - low) * within(high - own.z);
        let band = within(own.z - self.band[0]) * within(self.band[1] - own.z);
        most(strokes * inside * is_whole, band) * aside
    }

    /// Light sent back from seats behind glass: where a ray meets their upper ends.
    #[inline(always)]
    fn seats(&self, own: Vec3, ray: Vec3) -> f32 {
        let top_m = 0.56 * self.height_m;
        let fall = most(-ray.z, 0.12);
        let step = least(most(own.z - top_m, 0.0) / fall, 1.6);
        let (x, y) = (own.x + ray.dot(self.along) * step, own.y + ray.dot(self.side) * step);
        let row = |at: f32| share(1.0 - ((x - at).abs() - 0.10) * 9.0);
        let across = y.abs() / self.half_width_m;
        let place = share((across - 0.10) * 12.0) * share((0.74 - across) * 12.0);
        let seat = most(row(self.seats[0]), row(self.seats[1])) * place;
        let board = share((x - self.doors[0] + 0.35) * 6.0);
        0.018 + 0.085 * seat + 0.030 * board
    }
}

simd_kernel! {
    /// Shades a region.
    pub(super) fn coach(shared: &[Shared], blocks: &mut [Block], look: &Coach, noise: &NoiseTexture) {
        let look = *look;
        match look.kind {
            Kind::Sheet => sheet(shared, blocks, &look, noise),
            Kind::Cargo => cargo(shared, blocks, &look, noise),
            Kind::Glass => glass(shared, blocks, &look),
            Kind::Other => even(blocks, &look),
        }
    }
}

#[inline(always)]
fn sheet(shared: &[Shared], blocks: &mut [Block], look: &Coach, noise: &NoiseTexture) {
    for (shared, four) in groups(shared, blocks) {
        let (mut flakes, mut footprint_m) = ([0.0; WIDE], [0.0; WIDE]);
        for k in 0..WIDE {
            let facing = share(-get(&shared.ray, k).unit().dot(get(&shared.normal, k)));
            flakes[k] = 1.0 + look.flakes * (facing - 0.7);
            let way = get(&shared.middle, k) - look.eye;
            footprint_m[k] = look.pixel * way.dot(way).sqrt() / (0.4 + 0.6 * facing);
        }
        for block in four {
            for k in 0..WIDE {
                let point = block.point(shared, k);
                let own = look.own(point.world);
                let upward = share((point.normal.z - 0.35) * 3.0);
                let gap = look.gaps(own, upward, footprint_m[k]);
                // The road takes light from what is low, and gives dust to it.
                let (low, near) = (share(1.0 - own.z), share(1.0 - own.z * 1.25));
                let near2 = near * near;
                let shoulder = share(1.0 - (own.z - look.door_heights[1] + 0.05).abs() * 16.0);
                let specks = noise.clumps(own.x * 40.0, (own.z + own.y) * 40.0, footprint_m[k] * 40.0);
                let dust = look.dirt * (0.75 * near2 + 0.10) * (0.4 + 1.2 * specks);
                let aside = 1.0 - upward;
                let shade = (1.0 - 0.8 * gap) * (1.0 - aside * (SIDES + LOW * low) * (1.0 - shoulder)) * flakes[k];
                let lamp = look.tail_lamp(own, footprint_m[k]);
                let [plastic, badge] = look.fascia(own, footprint_m[k]);
                let paint = look.colour.lerp(DUST, share(dust));
                let paint = paint.lerp(look.sign, look.signed(own, aside, footprint_m[k])) * shade;
                let paint = paint.lerp(PLASTIC, plastic).lerp(BADGE, badge);
                set(&mut block.albedo, k, paint.lerp(TAIL_LAMP, lamp));
                set(&mut block.emission, k, TAIL_LAMP * (lamp * look.glow * TAIL_GLOW));
                block.mirror[k] =
                    look.mirror * (1.0 - gap) * (1.0 - 0.7 * share(dust)) * (1.0 - 0.7 * plastic) + 0.6 * lamp + badge;
            }
        }
    }
}

/// The box of a lorry: its sign, seams of its walls and roof, bars of its doors, tape that shines along its lower edge, and what the
/// rain leaves on its roof. Its walls lose light to the road as sheet does.
#[inline(always)]
fn cargo(shared: &[Shared], blocks: &mut [Block], look: &Coach, noise: &NoiseTexture) {
    for (shared, four) in groups(shared, blocks) {
        let mut footprint_m = [0.0; WIDE];
        for (k, wide_m) in footprint_m.iter_mut().enumerate() {
            let way = get(&shared.middle, k) - look.eye;
            *wide_m = look.pixel * way.dot(way).sqrt() * 1.5;
        }
        for block in four {
            for (k, wide_m) in footprint_m.into_iter().enumerate() {
                let point = block.point(shared, k);
                let own = look.own(point.world);
                let along = point.normal.dot(look.along).abs();
                let aside = point.normal.dot(look.side).abs();
                let upward = share((point.normal.z - 0.35) * 3.0);
                let seams = stripes(own.x / 1.22, 0.0, 0.016, wide_m / 1.22) * most(aside, upward);
                let across = own.y.abs() / look.half_width_m;
                let [inner, outer] = [0.30, 0.72].map(|at| band(across, at, at + 0.035, wide_m / look.half_width_m));
                let behind = along * look.rear_doors;
                let bars = (inner + outer) * behind;
                // The doors meet in the middle; rails of bare metal hold the roof.
                let between = band(own.y, -0.012, 0.012, wide_m) * behind;
                let rail = band(own.z - look.height_m, -0.07, 0.0, wide_m) * aside * look.rear_doors;
                let tape_m = own.z - 0.315 * look.height_m;
                let dashes = stripes(own.x + own.y, 0.0, 0.5, wide_m);
                let tape = band(tape_m, -0.03, 0.03, wide_m) * (along + aside) * dashes;
                let pools = noise.clumps(own.x * 6.0, own.y * 6.0, wide_m * 6.0);
                let dust = (0.04 + 0.25 * look.dirt) * (0.3 + 1.4 * pools) * upward;
                let lost = (1.0 - upward) * (SIDES + LOW * share(1.0 - own.z));
                let wall = look.colour.lerp(DUST, share(dust)) * (1.0 - 0.45 * seams);
                let wall = wall.lerp(look.sign, look.signed(own, aside, wide_m)).lerp(BADGE, share(bars + rail));
                let wall = wall * ((1.0 - lost) * (1.0 - 0.9 * share(between)));
                set(&mut block.albedo, k, wall.lerp(TAPE, share(tape)));
                set(&mut block.emission, k, look.emission);
                block.mirror[k] = look.mirror;
            }
        }
    }
}

#[inline(always)]
fn glass(shared: &[Shared], blocks: &mut [Block], look: &Coach) {
    for (shared, four) in groups(shared, blocks) {
        for block in four {
            for k in 0..WIDE {
                let own = look.own(get(&block.world, k));
                let ray = get(&shared.ray, k).unit();
                let inside = look.seats(own, ray) * BEHIND_GLASS;
                set(&mut block.albedo, k, look.colour * 0.3 + Vec3::splat(inside));
                set(&mut block.emission, k, look.emission);
                block.mirror[k] = look.mirror;
            }
        }
    }
}

#[inline(always)]
fn even(blocks: &mut [Block], look: &Coach) {
    for block in blocks.iter_mut() {
        for k in 0..WIDE {
            set(&mut block.albedo, k, look.colour);
            set(&mut block.emission, k, look.emission);
        }
        block.mirror = [look.mirror; WIDE];
    }
}
