//! Paint and build of vehicles, drawn from their seeds.

use crate::body_shape::BodyShape;
use crate::region::Region;
use cosfly_domain::{BodyKind, Colour, Dye};
use cosfly_frames::Seed;

/// Paint of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Livery {
    /// Colour of the sheet.
    pub paint: Dye,
    /// Colour of a lorry's box.
    pub cargo: Dye,
    /// Fur of a dog, linear RGB.
    pub fur: [f32; 3],
}

/// Paints with their shares: those of new cars in the world in the early 2020s, by the yearly reports of paint makers.
const PAINTS: [(f64, Dye); 14] = [
    (0.33, Dye::new(Colour::White, [0.64, 0.64, 0.63])),
    (0.20, Dye::new(Colour::Black, [0.018, 0.018, 0.020])),
    (0.10, Dye::new(Colour::Grey, [0.13, 0.135, 0.14])),
    (0.06, Dye::new(Colour::Grey, [0.25, 0.26, 0.27])),
    (0.10, Dye::new(Colour::Grey, [0.48, 0.49, 0.50])),
    (0.05, Dye::new(Colour::Blue, [0.020, 0.050, 0.18])),
    (0.03, Dye::new(Colour::Blue, [0.05, 0.16, 0.42])),
    (0.05, Dye::new(Colour::Red, [0.38, 0.018, 0.018])),
    (0.01, Dye::new(Colour::Green, [0.03, 0.10, 0.05])),
    (0.01, Dye::new(Colour::Green, [0.10, 0.14, 0.08])),
    (0.02, Dye::new(Colour::Brown, [0.12, 0.07, 0.04])),
    (0.02, Dye::new(Colour::Beige, [0.46, 0.40, 0.30])),
    (0.01, Dye::new(Colour::Orange, [0.65, 0.20, 0.02])),
    (0.01, Dye::new(Colour::Yellow, [0.70, 0.52, 0.04])),
];

/// Paints of buses with their shares: those of the fleets of cities and of coaches, which are light or strong, so that people see them.
const FLEETS: [(f64, Dye); 9] = [
    (0.30, Dye::new(Colour::White, [0.64, 0.64, 0.63])),
    (0.18, Dye::new(Colour::Red, [0.40, 0.022, 0.020])),
    (0.12, Dye::new(Colour::Yellow, [0.70, 0.46, 0.03])),
    (0.12, Dye::new(Colour::Blue, [0.04, 0.15, 0.42])),
    (0.08, Dye::new(Colour::Grey, [0.48, 0.49, 0.50])),
    (0.08, Dye::new(Colour::Beige, [0.56, 0.49, 0.34])),
    (0.06, Dye::new(Colour::Green, [0.05, 0.24, 0.09])),
    (0.04, Dye::new(Colour::Green, [0.24, 0.42, 0.06])),
    (0.02, Dye::new(Colour::Orange, [0.62, 0.19, 0.02])),
];

/// Paints of vans with their shares: firms buy most of them, in white.
const FIRMS: [(f64, Dye); 7] = [
    (0.60, Dye::new(Colour::White, [0.64, 0.64, 0.63])),
    (0.12, Dye::new(Colour::Grey, [0.48, 0.49, 0.50])),
    (0.08, Dye::new(Colour::Grey, [0.13, 0.135, 0.14])),
    (0.06, Dye::new(Colour::Black, [0.018, 0.018, 0.020])),
    (0.07, Dye::new(Colour::Blue, [0.020, 0.050, 0.18])),
    (0.04, Dye::new(Colour::Red, [0.38, 0.018, 0.018])),
    (0.03, Dye::new(Colour::Yellow, [0.70, 0.52, 0.04])),
];

/// Furs of dogs, linear RGB.
const FURS: [[f32; 3]; 6] = [
    [0.015, 0.013, 0.012],
    [0.10, 0.055, 0.025],
    [0.30, 0.19, 0.09],
    [0.45, 0.36, 0.24],
    [0.58, 0.56, 0.52],
    [0.13, 0.13, 0.13],
];

impl Livery {
    /// The livery that the seed of a body draws.
    pub fn draw(body: &BodyShape, seed: &Seed) -> Self {
        let mut stream = seed.stream("livery");
        let mut draw = |paints: &[(f64, Dye)]| {
            let mut left = stream.unit();
            let of_share = |(share, _): &&(f64, Dye)| {
                left -= share;
                left < 0.0
            };
            paints.iter().find(of_share).unwrap_or(&paints[0]).1
        };
        let paints: &[(f64, Dye)] = match body {
            BodyShape::Vehicle { kind: BodyKind::Bus, .. } => &FLEETS,
            BodyShape::Vehicle { kind: BodyKind::Van, .. } => &FIRMS,
            _ => &PAINTS,
        };
        let (paint, other) = (draw(paints), draw(&PAINTS));
        // Most boxes of lorries are white.
        let cargo = if stream.chance(0.6) { PAINTS[0].1 } else { other };
        let fur = FURS[seed.stream("fur").index(FURS.len())];
        Self { paint, cargo, fur }
    }

    /// Colours of all regions, linear RGB; those of people are black.
    pub fn colours(&self, body: &BodyShape) -> [[f32; 3]; Region::COUNT] {
        let mut colours = [[0.0; 3]; Region::COUNT];
        // The frame of a two-wheeler is seen as its paint, all the rest is black.
        let has_dog = matches!(body, BodyShape::Vehicle { kind: BodyKind::DogWalker, .. });
        let is_light = matches!(body, BodyShape::Vehicle { kind: BodyKind::Bicycle | BodyKind::EScooter, .. });
        for (region, colour) in [
            (Region::Paint, if has_dog { self.fur } else { self.paint.linear_rgb }),
            (Region::Cargo, self.cargo.linear_rgb),
            (Region::Trim, [0.014; 3]),
            (Region::Glass, [0.020, 0.023, 0.025]),
            (Region::Tyre, [0.012; 3]),
            (Region::Metal, if is_light { [0.30; 3] } else { [0.26, 0.265, 0.27] }),
            (Region::Plate, [0.62, 0.62, 0.58]),
            (Region::HeadLamp, [0.34, 0.35, 0.36]),
            (Region::TailLamp, [0.24, 0.008, 0.010]),
        ] {
            colours[region as usize] = colour;
        }
        colours
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::DVec3;

    fn share_of(kind: BodyKind, name: Colour) -> f64 {
        let body = BodyShape::Vehicle { kind, size_m: DVec3::ONE };
        let drawn = (0..4000).filter(|it| Livery::draw(&body, &Seed([3; 32]).child("car", *it)).paint.name == name);
        drawn.count() as f64 / 4000.0
    }

    #[test]
    fn paints_have_their_shares() {
        for paints in [&PAINTS[..], &FLEETS, &FIRMS] {
            assert!((paints.iter().map(|(share, _)| share).sum::<f64>() - 1.0).abs() < 1e-9);
        }
        for (name, share) in [(Colour::White, 0.33), (Colour::Black, 0.20), (Colour::Grey, 0.26), (Colour::Red, 0.05)] {
            let drawn = share_of(BodyKind::Car, name);
            assert!((drawn - share).abs() < 0.03, "{name:?}: {drawn}");
        }
        for (kind, name, share) in [(BodyKind::Bus, Colour::Red, 0.18), (BodyKind::Van, Colour::White, 0.60)] {
            let drawn = share_of(kind, name);
            assert!((drawn - share).abs() < 0.03, "{kind:?} {name:?}: {drawn}");
        }
    }

    #[test]
    fn no_bus_is_black_brown_or_dark_grey() {
        for number in 0..2000 {
            let body = BodyShape::Vehicle { kind: BodyKind::Bus, size_m: DVec3::ONE };
            let paint = Livery::draw(&body, &Seed([8; 32]).child("bus", number)).paint;
            assert!(!matches!(paint.name, Colour::Black | Colour::Brown), "{number}");
            assert!(paint.linear_rgb.iter().fold(0.0, |most: f32, it| most.max(*it)) > 0.2, "{number}: {paint:?}");
        }
    }
}
