//! Families of houses by use and age: what their walls, windows and ground floors are drawn from.

use super::draws;
use crate::building_form::BuildingForm;
use crate::pattern::{draw, hash, one_if};
use crate::vector::Vec3;

/// Looks that a family's houses have in common. Pairs are the lowest and highest value to draw.
pub(super) struct Family {
    /// Wall colours, linear RGB.
    walls: &'static [[f32; 3]],
    trim: [f32; 3],
    /// Height of a storey, metres.
    pub storey_m: [f32; 2],
    /// Width from window to window, metres.
    pub bay_m: [f32; 2],
    /// Share of a bay that is window.
    pub share: [f32; 2],
    /// Foot and head of windows, shares of a storey.
    pub sill: [[f32; 2]; 2],
    /// Panes lie this deep in the wall, metres.
    pub reveal_m: f32,
    pub gloss: f32,
    pub mullion: bool,
    pub brick: bool,
    /// Strength of ledges between storeys, and of joints between panels.
    pub ledge: f32,
    pub joint: f32,
    /// Probability of balconies.
    pub balconies: f32,
    /// Probability of shops at the street.
    pub shops: f32,
    /// Doors and gates: share of the bays of the street floor, half their width and their height, metres.
    pub door: [f32; 3],
    /// Strength of dirt.
    pub age: [f32; 2],
}

/// Shop signs, linear RGB.
pub(super) const SIGNS: [Vec3; 8] = [
    Vec3::new(0.55, 0.04, 0.03),
    Vec3::new(0.03, 0.12, 0.35),
    Vec3::new(0.02, 0.22, 0.10),
    Vec3::new(0.60, 0.35, 0.03),
    Vec3::new(0.06, 0.06, 0.07),
    Vec3::new(0.45, 0.43, 0.40),
    Vec3::new(0.16, 0.07, 0.03),
    Vec3::new(0.05, 0.25, 0.32),
];

/// Their mean.
pub(super) const MEAN_SIGN: Vec3 = Vec3::new(0.24, 0.19, 0.17);

const PLASTER: &[[f32; 3]] = &[
    [0.62, 0.52, 0.36],
    [0.66, 0.60, 0.50],
    [0.58, 0.42, 0.30],
    [0.55, 0.56, 0.52],
    [0.64, 0.50, 0.42],
    [0.68, 0.64, 0.54],
];
const BRICK: &[[f32; 3]] = &[[0.36, 0.14, 0.09], [0.42, 0.20, 0.13], [0.28, 0.13, 0.10], [0.46, 0.30, 0.19]];
const STONE: &[[f32; 3]] = &[[0.52, 0.49, 0.43], [0.46, 0.42, 0.36], [0.58, 0.55, 0.48]];
const CONCRETE: &[[f32; 3]] = &[[0.42, 0.41, 0.39], [0.36, 0.36, 0.35], [0.50, 0.48, 0.44], [0.46, 0.44, 0.38]];
const WHITE: &[[f32; 3]] = &[[0.74, 0.73, 0.70], [0.70, 0.70, 0.70], [0.72, 0.69, 0.62]];
const METAL: &[[f32; 3]] = &[[0.40, 0.43, 0.46], [0.30, 0.34, 0.36], [0.52, 0.52, 0.50], [0.22, 0.30, 0.36]];
const BRIGHT: &[[f32; 3]] = &[[0.60, 0.34, 0.20], [0.34, 0.46, 0.40], [0.62, 0.52, 0.24], [0.36, 0.42, 0.54]];

const COMMON: Family = Family {
    walls: PLASTER,
    trim: [0.62, 0.60, 0.55],
    storey_m: [3.0, 3.4],
    bay_m: [2.2, 3.2],
    share: [0.36, 0.50],
    sill: [[0.26, 0.32], [0.74, 0.82]],
    reveal_m: 0.14,
    gloss: 0.38,
    mullion: true,
    brick: false,
    ledge: 0.4,
    joint: 0.0,
    balconies: 0.0,
    shops: 0.6,
    door: [0.16, 0.55, 2.25],
    age: [0.2, 0.8],
};

/// From old to new.
const FAMILIES: [Family; 15] = [
    // Town houses of stone with deep windows and strong ledges.
    Family {
        walls: STONE,
        storey_m: [3.5, 4.0],
        share: [0.36, 0.44],
        sill: [[0.2, 0.26], [0.80, 0.86]],
        reveal_m: 0.26,
        ledge: 0.9,
        age: [0.4, 1.0],
        ..COMMON
    },
    // Tenements of brick.
    Family {
        walls: BRICK,
        trim: [0.50, 0.46, 0.40],
        brick: true,
        reveal_m: 0.18,
        ledge: 0.25,
        age: [0.4, 1.0],
        shops: 0.7,
        ..COMMON
    },
    // Plastered tenements.
    Family { reveal_m: 0.18, ledge: 0.8, age: [0.3, 1.0], shops: 0.75, balconies: 0.25, ..COMMON },
    // Lofts and works of brick with large windows.
    Family {
        walls: BRICK,
        trim: [0.10, 0.10, 0.10],
        storey_m: [3.8, 4.4],
        bay_m: [3.4, 4.4],
        share: [0.66, 0.78],
        sill: [[0.22, 0.26], [0.84, 0.9]],
        brick: true,
        reveal_m: 0.22,
        ledge: 0.15,
        shops: 0.3,
        age: [0.5, 1.0],
        ..COMMON
    },
    // Plain blocks between the wars.
    Family {
        walls: PLASTER,
        bay_m: [2.6, 3.6],
        share: [0.40, 0.56],
        reveal_m: 0.10,
        ledge: 0.1,
        balconies: 0.35,
        ..COMMON
    },
    // Slabs of concrete panels.
    Family {
        walls: CONCRETE,
        trim: [0.66, 0.66, 0.64],
        bay_m: [2.8, 3.3],
        share: [0.46, 0.60],
        storey_m: [2.8, 2.9],
        reveal_m: 0.10,
        ledge: 0.0,
        joint: 0.55,
        balconies: 0.75,
        shops: 0.25,
        age: [0.5, 1.0],
        ..COMMON
    },
    // Offices with ribbons of windows.
    Family {
        walls: CONCRETE,
        trim: [0.20, 0.20, 0.21],
        share: [1.0, 1.0],
        bay_m: [1.5, 1.9],
        sill: [[0.30, 0.36], [0.80, 0.86]],
        storey_m: [3.3, 3.7],
        reveal_m: 0.12,
        ledge: 0.0,
        mullion: false,
        gloss: 0.46,
        age: [0.2, 0.7],
        ..COMMON
    },
    // Towers of bronze glass.
    Family {
        walls: &[[0.10, 0.075, 0.055], [0.075, 0.075, 0.07]],
        trim: [0.12, 0.10, 0.08],
        share: [0.88, 0.93],
        bay_m: [1.4, 1.7],
        sill: [[0.10, 0.20], [0.94, 0.97]],
        storey_m: [3.5, 3.9],
        reveal_m: 0.08,
        ledge: 0.0,
        mullion: false,
        gloss: 0.50,
        age: [0.0, 0.3],
        shops: 0.4,
        ..COMMON
    },
    // Curtain walls.
    Family {
        walls: &[[0.22, 0.24, 0.26], [0.34, 0.36, 0.38]],
        trim: [0.30, 0.31, 0.33],
        share: [0.90, 0.95],
        bay_m: [1.4, 1.8],
        sill: [[0.04, 0.08], [0.95, 0.97]],
        storey_m: [3.6, 4.0],
        reveal_m: 0.05,
        ledge: 0.0,
        mullion: false,
        gloss: 0.58,
        age: [0.0, 0.2],
        shops: 0.5,
        ..COMMON
    },
    // Flats of today: white, with balconies.
    Family {
        walls: WHITE,
        trim: [0.12, 0.12, 0.13],
        share: [0.50, 0.66],
        bay_m: [2.8, 3.8],
        sill: [[0.05, 0.12], [0.78, 0.84]],
        reveal_m: 0.20,
        ledge: 0.0,
        balconies: 0.9,
        shops: 0.45,
        age: [0.0, 0.4],
        gloss: 0.44,
        ..COMMON
    },
    // Schools, hotels and offices with bright panels.
    Family {
        walls: BRIGHT,
        trim: [0.70, 0.70, 0.68],
        share: [0.50, 0.62],
        bay_m: [1.8, 2.4],
        reveal_m: 0.12,
        ledge: 0.0,
        joint: 0.35,
        balconies: 0.1,
        age: [0.0, 0.5],
        ..COMMON
    },
    // Halls and shops of sheet metal.
    Family {
        walls: METAL,
        trim: [0.16, 0.17, 0.18],
        share: [0.25, 0.40],
        bay_m: [4.5, 6.0],
        storey_m: [3.8, 4.6],
        sill: [[0.45, 0.55], [0.80, 0.86]],
        reveal_m: 0.05,
        ledge: 0.0,
        joint: 0.5,
        shops: 0.5,
        age: [0.1, 0.6],
        mullion: false,
        ..COMMON
    },
    // Cottages.
    Family {
        walls: WHITE,
        trim: [0.20, 0.13, 0.08],
        bay_m: [2.6, 3.6],
        share: [0.34, 0.44],
        storey_m: [2.7, 3.0],
        reveal_m: 0.16,
        ledge: 0.1,
        shops: 0.0,
        age: [0.2, 0.9],
        ..COMMON
    },
    // Works halls: sheet metal, a band of windows below the roof, gates.
    Family {
        walls: METAL,
        trim: [0.16, 0.17, 0.18],
        share: [0.84, 0.92],
        bay_m: [5.0, 6.5],
        storey_m: [9.0, 12.0],
        sill: [[0.70, 0.74], [0.82, 0.86]],
        reveal_m: 0.05,
        ledge: 0.0,
        mullion: false,
        shops: 0.0,
        door: [0.3, 1.9, 4.2],
        age: [0.1, 0.6],
        ..COMMON
    },
    // Tanks: rings of plates.
    Family {
        walls: &[[0.60, 0.60, 0.58], [0.52, 0.53, 0.54], [0.44, 0.46, 0.46]],
        trim: [0.40, 0.41, 0.42],
        share: [0.0, 0.0],
        storey_m: [2.2, 2.6],
        reveal_m: 0.0,
        ledge: 0.0,
        joint: 0.3,
        mullion: false,
        shops: 0.0,
        door: [0.0, 0.0, 0.0],
        age: [0.2, 0.8],
        ..COMMON
    },
];

/// Families of homes, of higher houses below a pitched roof, of halls and of tanks.
const HOME: [usize; 4] = [12, 2, 4, 1];
const ROOFED: [usize; 4] = [2, 1, 4, 0];
const HALL: [usize; 4] = [13, 13, 11, 3];
const TANK: [usize; 1] = [14];
/// Share of the shops of a family that its homes have.
const SHOPS_OF_HOMES: f32 = 0.12;
/// Families of blocks by height: low ones, those of a street, towers.
const LOW: [usize; 6] = [12, 2, 1, 4, 11, 10];
const STREET: [usize; 10] = [2, 1, 0, 4, 9, 5, 3, 6, 10, 8];
const TALL: [usize; 7] = [6, 8, 5, 9, 7, 10, 8];

impl Family {
    /// The family of a house: of those of its form and height, a town prefers some.
    pub fn of(seed: u32, town: u32, (form, height_m): (BuildingForm, f32)) -> &'static Self {
        let kinds: &[usize] = match form {
            BuildingForm::Home => &HOME,
            BuildingForm::Roofed => &ROOFED,
            BuildingForm::Hall => &HALL,
            BuildingForm::Tank => &TANK,
            BuildingForm::Block if height_m < 7.5 => &LOW,
            BuildingForm::Block if height_m < 20.0 => &STREET,
            BuildingForm::Block => &TALL,
        };
        // Squared: the first of the list, as the town turns it, come most often.
        let drawn = draw(seed, draws::FAMILY);
        let place = (drawn * (0.35 + 0.65 * drawn) * kinds.len() as f32) as usize;
        let turned = place + (hash(town, kinds.len() as u32) % 3) as usize;
        &FAMILIES[kinds[turned % kinds.len()]]
    }

    /// Whether a house of a form has shops at the street.
    pub fn has_shops(&self, seed: u32, form: BuildingForm) -> bool {
        let share = if form == BuildingForm::Home { SHOPS_OF_HOMES } else { 1.0 };
        draw(seed, draws::SHOPS) < share * self.shops
    }

    /// Colour of the wall and of what frames it.
    pub fn colours(&self, seed: u32) -> [Vec3; 2] {
        let [r, g, b] = self.walls[(draw(seed, draws::WALL) * self.walls.len() as f32) as usize % self.walls.len()];
        let bright = 0.82 + 0.32 * draw(seed, draws::BRIGHTNESS);
        let [x, y, z] = self.trim;
        let wall = Vec3::new(r, g, b) * bright;
        [wall, wall.lerp(Vec3::new(x, y, z), 0.8)]
    }
}

/// A draw between two values.
pub(super) fn between([low, high]: [f32; 2], seed: u32, index: u32) -> f32 {
    low + (high - low) * draw(seed, index)
}

/// 1 with a probability.
pub(super) fn chance(probability: f32, seed: u32, index: u32) -> f32 {
    one_if(draw(seed, index) < probability)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn towns_mix_many_families_and_differ() {
        let met = |town: u32| -> BTreeSet<usize> {
            let heights = [5.0, 12.0, 30.0];
            let families =
                (0..900).map(|seed| Family::of(hash(seed, 7), town, (BuildingForm::Block, heights[seed as usize % 3])));
            families.map(|family| core::ptr::from_ref(family) as usize).collect()
        };
        assert!(met(1).len() >= 10, "{}", met(1).len());
        let all: BTreeSet<usize> = (0..20).flat_map(met).collect();
        assert!(all.len() >= 12, "{}", all.len());
    }
}
