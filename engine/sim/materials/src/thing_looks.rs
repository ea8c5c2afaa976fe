//! Looks of parts whose form says more than their kind: containers, boats, panes, sheet and paint.

use super::pattern::{
    NoiseTexture, Noises, band, draw, floor_int, hash, least, lerp, most, one_if, share, smoothstep, stripes,
};
use super::surface::{Look, SurfacePoint};
use super::thing_form::ThingForm;
use super::things::{BoxThing, Place};
use super::vector::Vec3;

/// Waves of the sheet of containers, and of other ribbed sheet, metres from one to the next.
const WAVE_M: f32 = 0.278;
const RIB_M: f32 = 0.5;
/// Half the length of a cabin from which on it is the house of a ship, metres, and the share of boats that are lit at night.
const SHIPS_HOUSE_M: f32 = 3.2;
const LIT_BOATS: f32 = 0.3;
/// A part of a ship that is lower is none of its hull at the water, metres.
const LEAST_HULL_M: f32 = 2.0;
const RUST: Vec3 = Vec3::new(0.15, 0.06, 0.028);
/// Height of the letters on a container, metres; they are five cells high, three wide and one apart.
const LETTERS_M: f32 = 0.75;
/// Share of a line of letters that is painted.
const INK: f32 = 0.5;
/// Share of containers with letters.
const LETTERED: f32 = 0.75;

impl BoxThing {
    /// Which of the box's own axes it is long along.
    #[inline(always)]
    fn long(&self) -> usize {
        usize::from(self.half.y > self.half.x)
    }

    /// Half the width and height of a face.
    #[inline(always)]
    fn half_of<const AXIS: usize>(&self) -> [f32; 2] {
        match AXIS {
            0 => [self.half.y, self.half.z],
            1 => [self.half.x, self.half.z],
            _ => [self.half.x, self.half.y],
        }
    }

    /// Waves of sheet in a frame of rails and posts; doors with bars at one end; letters, rust and dust.
    #[inline(always)]
    pub(crate) fn container<const AXIS: usize>(&self, point: &SurfacePoint, at: &Place, noise: &NoiseTexture) -> Look {
        let [du, dv] = point.footprints_m;
        let [half_u, half_v] = self.half_of::<AXIS>();
        let long = self.long();
        let (away_u, away_v) = (half_u - at.u.abs(), half_v - at.v.abs());
        let framed = 1.0 - smoothed(away_u, 0.12, du) * smoothed(away_v, 0.11, dv);
        let stain = noise.clumps(at.u * 7.0 + self.shift(), at.v * 7.0, point.footprint_m * 7.0);
        let wear = draw(self.seed, 30);
        let mut colour = self.tint * (0.86 + 0.28 * stain);
        let is_end = AXIS != 2 && AXIS == long;
        let ahead = if long == 0 { at.local.x } else { at.local.y };
        let has_doors = is_end & (ahead > 0.0);
        let along = if AXIS == 2 { ahead } else { at.u };
        let wave_size = (if AXIS == 2 && long == 1 { dv } else { du }) / WAVE_M;
        let depth = if AXIS == 2 { 0.35 } else { 1.0 };
        if has_doors {
            colour = self.doors(colour, point, at, half_u);
        } else {
            let wave = waves(along / WAVE_M, wave_size);
            colour *= lerp(1.0, wave, depth * (1.0 - framed));
        }
        if AXIS != 2 && !is_end && draw(self.seed, 31) < LETTERED {
            colour = colour.lerp(self.ink(), 0.85 * self.letters(point, at, [half_u, half_v]));
        }
        let eaten = smoothstep(0.70 - 0.12 * wear, 0.86 - 0.12 * wear, stain) * (0.25 + 0.75 * framed);
        colour = colour.lerp(RUST, 0.8 * wear * eaten);
        if AXIS == 2 {
            colour = colour.lerp(Vec3::splat(0.26), 0.30);
        }
        // The joint to the container below and above, and the castings at the corners.
        let joint = AXIS != 2;
        let dark = if joint { 1.0 - smoothed(away_v, 0.025, dv) } else { 0.0 };
        let casting = (1.0 - smoothed(away_u, 0.16, du)) * (1.0 - smoothed(away_v, 0.14, dv));
        colour = colour * (1.0 - 0.75 * dark) * (1.0 - 0.35 * casting);
        Look::matt(colour, point.normal)
    }

    /// Two doors: a seam in the middle, four bars with handles, hinges.
    #[inline(always)]
    fn doors(&self, colour: Vec3, point: &SurfacePoint, at: &Place, half_m: f32) -> Vec3 {
        let [du, dv] = point.footprints_m;
        let aside = at.u.abs();
        let seam = band(aside, -0.02, 0.02, du);
        let bars = band(aside, 0.27 * half_m - 0.03, 0.27 * half_m + 0.03, du)
            + band(aside, 0.66 * half_m - 0.03, 0.66 * half_m + 0.03, du);
        let handles = band(at.v, -0.42, -0.34, dv) * band(aside, 0.22 * half_m, 0.72 * half_m, du);
        let hinges = band(aside, half_m - 0.16, half_m - 0.05, du) * stripes(at.v / 0.55, 0.4, 0.6, dv / 0.55);
        let panels = stripes(at.v / 0.52, 0.0, 0.06, dv / 0.52);
        let colour = colour * (1.0 - 0.22 * panels) * (1.0 - 0.75 * seam) * (1.0 - 0.4 * hinges);
        colour.lerp(Vec3::splat(0.42), least(bars + handles, 1.0) * 0.75)
    }

    /// White letters on paint, dark ones on white.
    #[inline(always)]
    fn ink(&self) -> Vec3 {
        if self.tint.x + self.tint.y + self.tint.z > 0.9 { Vec3::new(0.03, 0.05, 0.16) } else { Vec3::splat(0.62) }
    }

    /// How much of a place is painted with letters: each is a pattern of cells of its own, as one sees them from afar.
    #[inline(always)]
    fn letters(&self, point: &SurfacePoint, at: &Place, [half_u, half_v]: [f32; 2]) -> f32 {
        let seed = hash(self.seed, 32);
        let size_m = LETTERS_M * (0.7 + 0.6 * draw(seed, 0));
        let cell_m = 0.2 * size_m;
        let fit = floor_int((2.0 * half_u - 1.2) / (4.0 * cell_m));
        let count = least(3.0 + floor_int(6.0 * draw(seed, 1)) as f32, fit as f32);
        let long_m = 4.0 * cell_m * count;
        let start = (draw(seed, 2) - 0.5) * most(2.0 * half_u - 1.0 - long_m, 0.0) - 0.5 * long_m;
        let foot = (0.05 + 0.35 * draw(seed, 3)) * half_v;
        let (x, y) = ((at.u - start) / cell_m, (at.v - foot) / cell_m);
        let [wide, high] = point.footprints_m.map(|size| size / cell_m);
        // Blended between the nearest cells over the width of a pixel.
        let (column, row) = (floor_int(x - 0.5), floor_int(y - 0.5));
        let fx = share((x - 0.5 - column as f32 - 0.5) / most(wide, 0.02) + 0.5);
        let fy = share((y - 0.5 - row as f32 - 0.5) / most(high, 0.02) + 0.5);
        let cell = |dx: i32, dy: i32| letter_cell(seed, [column.wrapping_add(dx), row.wrapping_add(dy)], count);
        let one = lerp(lerp(cell(0, 0), cell(1, 0), fx), lerp(cell(0, 1), cell(1, 1), fx), fy);
        let block = band(x, 0.0, 4.0 * count - 1.0, wide) * band(y, 0.0, 5.0, high);
        lerp(one, INK * block, smoothstep(0.7, 1.3, most(wide, high)))
    }

    /// A draw of the thing as an offset into noise.
    #[inline(always)]
    fn shift(&self) -> f32 {
        (self.seed & 0xff) as f32
    }

    /// Paint above the waterline, the paint of the bottom below, a light line between them; planks or steel on deck.
    #[inline(always)]
    pub(crate) fn hull<const AXIS: usize>(&self, point: &SurfacePoint, at: &Place, noise: &NoiseTexture) -> Look {
        let is_ship = self.form == ThingForm::Ship;
        let [_, dv] = point.footprints_m;
        if AXIS == 2 {
            let stain = noise.clumps(at.u * 5.0, at.v * 5.0, point.footprint_m * 5.0);
            if is_ship {
                let decks = [Vec3::new(0.15, 0.065, 0.045), Vec3::new(0.06, 0.11, 0.085), Vec3::splat(0.15)];
                return Look::matt(decks[self.choice] * (0.75 + 0.5 * stain), point.normal);
            }
            let across = if self.long() == 0 { at.local.y } else { at.local.x };
            let plank = stripes(across / 0.14, 0.0, 0.1, point.footprint_m / 0.14);
            let decks = [Vec3::new(0.33, 0.22, 0.12), Vec3::splat(0.42), Vec3::new(0.22, 0.14, 0.08)];
            return Look::matt(decks[self.choice] * ((0.8 + 0.4 * stain) * (1.0 - 0.35 * plank)), point.normal);
        }
        let up = at.local.z + self.half.z;
        let high = 2.0 * self.half.z;
        // Bulwarks and forecastles are low, and have no waterline.
        let (bottom, line) = match is_ship {
            true if high < LEAST_HULL_M => (0.0, 0.0),
            true => (0.30 * high, 0.34 * high),
            false => (0.24 * high, 0.31 * high),
        };
        let streak = noise.clumps(at.u * 5.0 + self.shift(), at.v * 0.9, point.footprint_m * 5.0);
        let worn = if is_ship { 0.55 * smoothstep(0.55, 0.8, streak) } else { 0.0 };
        let paint = self.tint * (0.9 + 0.2 * streak);
        let paint = paint.lerp(RUST, worn);
        let under = if is_ship { Vec3::new(0.17, 0.035, 0.025) } else { Vec3::new(0.05, 0.025, 0.02) };
        let colour = paint.lerp(Vec3::splat(0.55), 0.8 * band(up, bottom, line, dv));
        let colour = colour.lerp(under * (0.8 + 0.4 * streak), band(up, -1.0, bottom, dv));
        let seams = if is_ship { stripes(up / 1.4, 0.0, 0.03, dv / 1.4) } else { 0.0 };
        Look { mirror: 0.10, ..Look::matt(colour * (1.0 - 0.25 * seams), point.normal) }
    }

    /// White walls with a row of windows on each deck.
    #[inline(always)]
    pub(crate) fn cabin<const AXIS: usize>(&self, point: &SurfacePoint, at: &Place) -> Look {
        let [du, dv] = point.footprints_m;
        let wall = Look { mirror: 0.08, ..Look::matt(self.tint, point.normal) };
        if AXIS == 2 {
            return wall;
        }
        let [half_u, half_v] = self.half_of::<AXIS>();
        let decks = most(floor_int(2.0 * half_v / 2.2) as f32, 1.0);
        let floor = (at.v + half_v) / (2.0 * half_v) * decks;
        // A low cabin is mostly window.
        let (sill, lintel) = if half_v < 0.9 { (0.42, 0.84) } else { (0.48, 0.80) };
        let (pitch_m, pane) = if half_v < 0.9 { (0.8, 0.90) } else { (1.3, 0.62) };
        let panes = stripes(at.u / pitch_m + 0.5, 0.5 - 0.5 * pane, 0.5 + 0.5 * pane, du / pitch_m)
            * stripes(floor, sill, lintel, dv * decks / (2.0 * half_v))
            * band(at.u, 0.15 - half_u, half_u - 0.15, du);
        let albedo = wall.albedo.lerp(Vec3::new(0.02, 0.025, 0.03), panes);
        // Somebody is on every ship, and on few boats.
        let is_lit = one_if((most(self.half.x, self.half.y) > SHIPS_HOUSE_M) | (draw(self.seed, 33) < LIT_BOATS));
        let lit = Vec3::new(1.0, 0.75, 0.45) * (0.06 * self.night * panes * is_lit);
        Look { albedo, mirror: wall.mirror + 0.35 * panes, emission: lit, ..wall }
    }

    /// Steel with ribs across.
    #[inline(always)]
    pub(crate) fn sheet(&self, point: &SurfacePoint, at: &Place, noise: &NoiseTexture) -> Look {
        let along = if self.long() == 0 { at.local.x } else { at.local.y };
        let rib = stripes(along / RIB_M, 0.0, 0.18, point.footprint_m / RIB_M);
        let stain = noise.clumps(at.u * 6.0 + self.shift(), at.v * 6.0, point.footprint_m * 6.0);
        Look::matt(self.tint * ((0.8 + 0.4 * stain) * (1.0 - 0.3 * rib)), point.normal)
    }

    /// Even paint.
    #[inline(always)]
    pub(crate) fn paint(&self, point: &SurfacePoint) -> Look {
        Look { mirror: 0.08, ..Look::matt(self.tint, point.normal) }
    }

    /// Panes and still water.
    #[inline(always)]
    pub(crate) fn glass(&self, point: &SurfacePoint) -> Look {
        let mirror = if self.form == ThingForm::Glass { 0.45 } else { 0.30 };
        Look { mirror, ..Look::matt(self.tint, point.normal) }
    }
}

/// 1 farther than a width from an edge, 0 nearer, over a pixel.
#[inline(always)]
fn smoothed(away_m: f32, width_m: f32, size_m: f32) -> f32 {
    share((away_m - width_m) / most(size_m, 1e-4) + 0.5)
}

/// Light on sheet in waves: flats in front and behind, and between them one slope in light and one in shade.
#[inline(always)]
fn waves(x: f32, width: f32) -> f32 {
    let back = stripes(x, 0.10, 0.44, width);
    let shade = stripes(x, 0.0, 0.10, width);
    let light = stripes(x, 0.44, 0.54, width);
    1.0 - 0.16 * back - 0.45 * shade + 0.18 * light
}

/// 1 where a cell of a line of letters is painted: the letter's number draws its cells, the first column mostly full.
#[inline(always)]
fn letter_cell(seed: u32, [column, row]: [i32; 2], count: f32) -> f32 {
    let letter = column >> 2;
    let place = column & 3;
    let is_within = (column >= 0) & ((letter as f32) < count) & (place != 3) & (0..5).contains(&row);
    let drawn = hash(letter as u32, seed);
    let cells = (drawn | 0b11111).wrapping_shr((place as u32).wrapping_mul(5).wrapping_add(row as u32) & 31) & 1;
    one_if(is_within & (cells == 1))
}
