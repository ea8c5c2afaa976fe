//! Colours of things, drawn from their seeds.

use super::pattern::{draw, hash};
use super::thing_form::ThingForm;
use super::vector::Vec3;
use cosfly_domain::ObstacleKind;

/// Car paints, linear RGB.
const PAINTS: [Vec3; 8] = [
    Vec3::new(0.55, 0.55, 0.57),
    Vec3::new(0.03, 0.03, 0.035),
    Vec3::new(0.68, 0.68, 0.66),
    Vec3::new(0.40, 0.03, 0.03),
    Vec3::new(0.03, 0.08, 0.28),
    Vec3::new(0.18, 0.19, 0.20),
    Vec3::new(0.05, 0.14, 0.10),
    Vec3::new(0.45, 0.38, 0.28),
];

/// Stripes of awnings, linear RGB.
const CLOTHS: [Vec3; 4] = [
    Vec3::new(0.42, 0.05, 0.04),
    Vec3::new(0.04, 0.20, 0.09),
    Vec3::new(0.05, 0.11, 0.33),
    Vec3::new(0.50, 0.30, 0.05),
];
/// What lies in crates, linear RGB.
pub(crate) const FRUIT: [Vec3; 5] = [
    Vec3::new(0.50, 0.09, 0.03),
    Vec3::new(0.52, 0.25, 0.03),
    Vec3::new(0.16, 0.30, 0.06),
    Vec3::new(0.32, 0.22, 0.10),
    Vec3::new(0.46, 0.40, 0.30),
];
/// Light of bulbs, linear RGB: warm, sodium, cold; the first are the most frequent.
const BULBS: [[f32; 3]; 3] = [[1.0, 0.78, 0.45], [1.0, 0.58, 0.20], [0.86, 0.92, 1.0]];

/// Strength of a street lamp's bulb by the lamp's seed: bulbs age, and one in thirty is out.
pub fn bulb(seed: u32) -> f32 {
    if draw(seed, 9) < 1.0 / 30.0 { 0.0 } else { 0.72 + 0.56 * draw(seed, 10) }
}

/// Paints of containers and their shares, linear RGB: red oxide, blue, dark blue, grey, green, orange, red, white.
const CONTAINERS: [(f32, Vec3); 9] = [
    (0.17, Vec3::new(0.20, 0.055, 0.035)),
    (0.16, Vec3::new(0.04, 0.13, 0.33)),
    (0.12, Vec3::new(0.025, 0.045, 0.13)),
    (0.12, Vec3::new(0.34, 0.35, 0.35)),
    (0.10, Vec3::new(0.04, 0.16, 0.085)),
    (0.10, Vec3::new(0.52, 0.17, 0.03)),
    (0.10, Vec3::new(0.36, 0.03, 0.03)),
    (0.08, Vec3::new(0.60, 0.60, 0.57)),
    (0.05, Vec3::new(0.05, 0.26, 0.28)),
];
/// Paints of hulls, of cabins and of what children play on, linear RGB.
const HULLS: [Vec3; 6] = [
    Vec3::new(0.62, 0.62, 0.60),
    Vec3::new(0.03, 0.07, 0.20),
    Vec3::new(0.62, 0.62, 0.60),
    Vec3::new(0.30, 0.04, 0.035),
    Vec3::new(0.05, 0.17, 0.13),
    Vec3::new(0.24, 0.12, 0.055),
];
const SHIPS: [Vec3; 4] = [
    Vec3::new(0.035, 0.055, 0.11),
    Vec3::new(0.22, 0.035, 0.03),
    Vec3::new(0.045, 0.05, 0.055),
    Vec3::new(0.05, 0.17, 0.15),
];
const CABINS: [Vec3; 2] = [Vec3::new(0.64, 0.64, 0.62), Vec3::new(0.58, 0.55, 0.48)];
const PAINTED: [Vec3; 5] = [
    Vec3::new(0.50, 0.05, 0.04),
    Vec3::new(0.58, 0.36, 0.03),
    Vec3::new(0.04, 0.17, 0.42),
    Vec3::new(0.09, 0.30, 0.07),
    Vec3::new(0.55, 0.20, 0.03),
];
/// Colour of a thing, and which of several looks it has.
pub(crate) fn tint_of((kind, form): (ObstacleKind, ThingForm), seed: u32, center: Vec3) -> (Vec3, usize) {
    let pick = |index: u32, count: usize| (draw(seed, index) * count as f32) as usize % count;
    match form {
        ThingForm::Plain => plain_tint(kind, seed, center),
        ThingForm::Container => {
            let mut left = draw(seed, 12);
            let paint = CONTAINERS.iter().find(|(share, _)| {
                left -= share;
                left < 0.0
            });
            let (_, paint) = paint.unwrap_or(&CONTAINERS[0]);
            // Sun and salt take the colour out of some.
            let faded = 0.45 * draw(seed, 13) * draw(seed, 13);
            ((*paint * (0.85 + 0.3 * draw(seed, 14))).lerp(Vec3::splat(0.30), faded), 0)
        }
        ThingForm::Ship => (SHIPS[pick(15, SHIPS.len())], pick(16, 3)),
        ThingForm::Hull | ThingForm::Rim => (HULLS[pick(15, HULLS.len())], pick(16, 3)),
        ThingForm::Cabin => (CABINS[pick(17, CABINS.len())], 0),
        ThingForm::Glass => (Vec3::new(0.13, 0.155, 0.16), 0),
        ThingForm::Pool => (Vec3::new(0.03, 0.075, 0.075), 0),
        ThingForm::Sheet => {
            ([Vec3::splat(0.30), Vec3::new(0.22, 0.10, 0.07), Vec3::new(0.13, 0.20, 0.17)][pick(18, 3)], 0)
        }
        ThingForm::Paint => (PAINTED[pick(19, PAINTED.len())], 0),
        ThingForm::White => (Vec3::splat(0.66), 0),
    }
}

fn plain_tint(kind: ObstacleKind, seed: u32, center: Vec3) -> (Vec3, usize) {
    let pick = |index: u32, count: usize| (draw(seed, index) * count as f32) as usize % count;
    match kind {
        ObstacleKind::Lamp => {
            let [r, g, b] = BULBS[usize::from(draw(seed, 11) > 0.6) + usize::from(draw(seed, 11) > 0.85)];
            (Vec3::new(r, g, b) * bulb(seed), 0)
        }
        ObstacleKind::Car => (PAINTS[pick(2, PAINTS.len())], 0),
        ObstacleKind::TrafficLight => {
            let choice = pick(3, 3);
            ([Vec3::new(0.9, 0.05, 0.03), Vec3::new(0.9, 0.5, 0.03), Vec3::new(0.03, 0.8, 0.25)][choice], choice)
        }
        ObstacleKind::TrafficSign => {
            let signs = [Vec3::new(0.02, 0.12, 0.45), Vec3::new(0.55, 0.03, 0.03), Vec3::new(0.65, 0.45, 0.02)];
            (signs[pick(4, 3)], 0)
        }
        ObstacleKind::Wall | ObstacleKind::Bridge | ObstacleKind::Building => {
            (Vec3::new(0.36, 0.33, 0.29) * (0.8 + 0.4 * draw(seed, 5)), 0)
        }
        ObstacleKind::Stall => {
            let fruit = hash(seed, center.x.to_bits() ^ center.y.to_bits()) as usize % FRUIT.len();
            (CLOTHS[pick(4, CLOTHS.len())], fruit)
        }
        ObstacleKind::Static | ObstacleKind::Bench => {
            let woods = [Vec3::new(0.16, 0.115, 0.075), Vec3::new(0.065, 0.095, 0.07), Vec3::splat(0.20)];
            (woods[pick(6, 3)], 0)
        }
        _ => (Vec3::splat(0.2), 0),
    }
}
