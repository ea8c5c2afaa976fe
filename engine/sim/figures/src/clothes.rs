//! Clothes: one palette for everybody, drawn from a person's own seed, so that nobody changes clothes when followed.

use crate::body_shape::BodyShape;
use crate::build::{Build, Hair};
use crate::region::Region;
use crate::umbrella;
use crate::vehicles::Livery;
use cosfly_domain::{Bag, Outfit, Traits};
use cosfly_domain::{Colour, Dye};
use cosfly_frames::{RandomStream, Seed};

/// Colours of a figure, linear RGB.
#[derive(Clone, Copy, Debug)]
pub struct Clothes {
    /// Indexed by the first seven of [`Region`].
    pub colours: [[f32; 3]; 7],
    /// Clothes in words, for texts; no umbrella.
    pub outfit: Outfit,
    /// Bare forearms.
    pub short_sleeves: bool,
    /// Pattern of the top.
    pub pattern: Pattern,
    /// Body and bearing.
    pub build: Build,
}

/// Pattern of a top; most of it has the colour that [`Outfit::top`] names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pattern {
    /// One colour.
    Plain,
    /// Rings around trunk and sleeves, in another colour, linear RGB.
    Rings([f32; 3]),
    /// Lines along trunk and sleeves, in another colour, linear RGB.
    Lines([f32; 3]),
    /// Rings and lines.
    Checks([f32; 3]),
}

/// Outfit of a body, for texts: clothes of a person or rider; of another vehicle, its paint for top and trousers.
pub fn outfit_of(body: BodyShape, seed: &Seed) -> Outfit {
    match body {
        BodyShape::Vehicle { kind, .. } if !kind.row().is_dressed => {
            let paint = Livery::draw(&body, seed).paint;
            Outfit { top: paint, trousers: paint, backpack: false, umbrella: false, traits: None }
        }
        BodyShape::Vehicle { .. } => Outfit { traits: None, ..Clothes::draw(seed).outfit },
        BodyShape::Person { umbrella, .. } => Outfit { umbrella, ..Clothes::draw(seed).outfit },
    }
}

/// Tops that stand out from asphalt, pavement and grass, linear RGB.
const BRIGHT_TOPS: [Dye; 10] = [
    Dye::new(Colour::Red, [0.72, 0.03, 0.03]),
    Dye::new(Colour::Orange, [0.85, 0.45, 0.02]),
    Dye::new(Colour::White, [0.80, 0.78, 0.72]),
    Dye::new(Colour::Blue, [0.03, 0.16, 0.70]),
    Dye::new(Colour::Pink, [0.75, 0.08, 0.35]),
    Dye::new(Colour::Blue, [0.02, 0.45, 0.55]),
    Dye::new(Colour::Yellow, [0.85, 0.70, 0.05]),
    Dye::new(Colour::Purple, [0.35, 0.05, 0.50]),
    Dye::new(Colour::Orange, [0.90, 0.22, 0.05]),
    Dye::new(Colour::Green, [0.05, 0.40, 0.10]),
];
/// Common colours of tops, linear RGB.
const EVERYDAY_TOPS: [Dye; 12] = [
    Dye::new(Colour::Black, [0.03, 0.03, 0.035]),
    Dye::new(Colour::Grey, [0.08, 0.085, 0.09]),
    Dye::new(Colour::Grey, [0.20, 0.20, 0.20]),
    Dye::new(Colour::Grey, [0.45, 0.45, 0.44]),
    Dye::new(Colour::White, [0.62, 0.60, 0.55]),
    Dye::new(Colour::Blue, [0.03, 0.045, 0.10]),
    Dye::new(Colour::Blue, [0.10, 0.16, 0.27]),
    Dye::new(Colour::Blue, [0.30, 0.38, 0.48]),
    Dye::new(Colour::Green, [0.07, 0.09, 0.05]),
    Dye::new(Colour::Brown, [0.16, 0.09, 0.05]),
    Dye::new(Colour::Beige, [0.38, 0.29, 0.19]),
    Dye::new(Colour::Red, [0.20, 0.04, 0.045]),
];
const TROUSERS: [Dye; 6] = [
    Dye::new(Colour::Blue, [0.02, 0.03, 0.08]),
    Dye::new(Colour::Black, [0.015, 0.015, 0.02]),
    Dye::new(Colour::Blue, [0.05, 0.09, 0.22]),
    Dye::new(Colour::Beige, [0.30, 0.24, 0.15]),
    Dye::new(Colour::Grey, [0.12, 0.12, 0.13]),
    Dye::new(Colour::Brown, [0.10, 0.05, 0.03]),
];
const HAIR: [[f32; 3]; 5] =
    [[0.01, 0.008, 0.006], [0.04, 0.02, 0.01], [0.10, 0.05, 0.02], [0.30, 0.20, 0.08], [0.25, 0.25, 0.25]];
const SKIN: [[f32; 3]; 4] = [[0.62, 0.38, 0.27], [0.50, 0.28, 0.18], [0.28, 0.14, 0.08], [0.12, 0.06, 0.035]];
const SHOES: [[f32; 3]; 3] = [[0.02, 0.02, 0.02], [0.60, 0.60, 0.58], [0.12, 0.06, 0.03]];

/// Share of people with a top from [`BRIGHT_TOPS`].
const BRIGHT_SHARE: f64 = 0.25;

impl Clothes {
    /// The clothes that a seed draws.
    pub fn draw(seed: &Seed) -> Self {
        let mut stream = seed.stream("clothes");
        let tops: &[Dye] = if stream.chance(BRIGHT_SHARE) { &BRIGHT_TOPS } else { &EVERYDAY_TOPS };
        let [top, bag_cloth] = [(); 2].map(|()| one_of(&mut stream, tops));
        let trousers = one_of(&mut stream, &TROUSERS);
        let [skin, hair, shoes] = [&SKIN[..], &HAIR, &SHOES].map(|palette| one_of(&mut stream, palette));
        let backpack = stream.chance(0.35);
        let short_sleeves = stream.chance(0.45);
        let build = Build::draw(seed);
        let bag = match (backpack, build.shoulder_bag) {
            (true, _) => Bag::Backpack,
            (false, true) => Bag::Shoulder,
            (false, false) => Bag::None,
        };
        let traits = Some(Traits { bag, build: build.body_build(), gait: build.gait() });
        let outfit = Outfit { top, trousers, backpack, umbrella: false, traits };
        let head = match build.hair {
            Hair::Bald => skin,
            Hair::Cap | Hair::Hat => one_of(&mut seed.stream("cap"), tops).linear_rgb,
            Hair::Short | Hair::Long | Hair::Bun => hair,
        };
        let bag_colour = bag_cloth.linear_rgb.map(|c| 0.5 * c);
        let umbrella = umbrella::colour(seed);
        let colours = [skin, head, top.linear_rgb, trousers.linear_rgb, shoes, bag_colour, umbrella];
        Self { colours, outfit, short_sleeves, pattern: Pattern::draw(seed, top), build }
    }

    /// True for a top that stands out from asphalt, pavement and grass.
    pub fn stand_out(&self) -> bool {
        BRIGHT_TOPS.contains(&self.outfit.top)
    }
}

impl Pattern {
    fn draw(seed: &Seed, top: Dye) -> Self {
        let mut stream = seed.stream("pattern");
        let other = one_of(&mut stream, &EVERYDAY_TOPS).linear_rgb;
        // As much lighter or darker than the top as cloth of two colours is.
        let second = [0, 1, 2].map(|k| 0.5 * top.linear_rgb[k] + 0.5 * other[k]);
        match stream.unit() {
            share if share < 0.10 => Self::Rings(second),
            share if share < 0.16 => Self::Lines(second),
            share if share < 0.25 => Self::Checks(second),
            _ => Self::Plain,
        }
    }
}

/// Seed of the clothes of somebody who is followed: with the probability `stands_out` a seed whose clothes stand out, else
/// the person's own. The first draws decide and do not depend on `stands_out`: a higher value changes the clothes of more
/// people, and of no other.
pub fn clothes_seed_of_target(own: &Seed, stands_out: f64) -> Seed {
    if !own.stream("stands out").chance(stands_out) {
        return *own;
    }
    let mut drawn = (0..100).map(|number| own.child("bright clothes", number));
    drawn.find(|seed| Clothes::draw(seed).stand_out()).unwrap_or(*own)
}

/// Seed of the looks of an old person, whose own seed is given: hair is grey, or hidden.
pub fn grey_haired(own: &Seed) -> Seed {
    let is_old = |seed: &Seed| {
        let clothes = Clothes::draw(seed);
        clothes.colours[Region::Hair as usize] == HAIR[4] || matches!(clothes.build.hair, Hair::Cap | Hair::Hat)
    };
    (0..100).map(|number| own.child("grey hair", number)).find(is_old).unwrap_or(*own)
}

fn one_of<T: Copy>(stream: &mut RandomStream, palette: &[T]) -> T {
    palette[stream.index(palette.len())]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seeds() -> impl Iterator<Item = Seed> {
        (0..400).map(|number| Seed([5; 32]).child("person", number))
    }

    #[test]
    fn a_quarter_of_all_people_stand_out_and_targets_as_many_as_asked_for() {
        let share = |stands_out: f64| {
            let clothes = seeds().map(|own| Clothes::draw(&clothes_seed_of_target(&own, stands_out)));
            clothes.filter(Clothes::stand_out).count() as f64 / 400.0
        };
        assert!((share(0.0) - BRIGHT_SHARE).abs() < 0.08, "{}", share(0.0));
        assert!((share(0.5) - 0.625).abs() < 0.08, "{}", share(0.5));
        assert_eq!(share(1.0), 1.0);
    }

    #[test]
    fn nobody_changes_clothes_when_followed_unless_that_is_asked_for() {
        assert!(seeds().all(|own| clothes_seed_of_target(&own, 0.0) == own));
    }

    #[test]
    fn names_fit_their_colours() {
        let brightness = |rgb: [f32; 3]| 0.21 * rgb[0] + 0.72 * rgb[1] + 0.07 * rgb[2];
        for Dye { name, linear_rgb: rgb } in BRIGHT_TOPS.iter().chain(&EVERYDAY_TOPS).chain(&TROUSERS) {
            match name {
                Colour::Black => assert!(brightness(*rgb) < 0.05),
                Colour::White => assert!(brightness(*rgb) > 0.5),
                Colour::Red => assert!(rgb[0] > 2.0 * rgb[1].max(rgb[2])),
                Colour::Green => assert!(rgb[1] > rgb[0].max(rgb[2])),
                Colour::Blue => assert!(rgb[2] > rgb[0].max(rgb[1])),
                _ => {}
            }
        }
    }
}
