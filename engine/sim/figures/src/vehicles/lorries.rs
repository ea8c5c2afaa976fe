//! Lorries: a cab and a box, a tipping body or a tank. Outlines are shares of length (ahead of the middle) and height.

use super::cars::{mirrors, shell};
use super::coaches::{axles, lamps};
use super::model::Model;
use super::shapes::{LARGE, STRAIGHT, Section, Shape, deck, roof};
use crate::region::Region;
use Region::{Cargo as C, Glass as G, HeadLamp as H, Paint as P, Trim as T};
use cosfly_frames::{DVec3, RandomStream, real};

/// Sides of a tank.
const SIDES: usize = 14;

const CAB: Shape = Shape {
    foot: 0.11,
    tumble: 0.94,
    drop: 0.045,
    narrow: 0.05,
    axles: [-0.30, 0.385],
    wheel: 0.145,
    sections: CAB_SECTIONS,
    ..LARGE
};

const CAB_SECTIONS: &[Section] = &[
    roof(0.275, 0.45, 0.775, [P, P, P]),
    roof(0.335, 0.45, 0.80, [P, G, P]),
    roof(0.43, 0.445, 0.80, [P, P, P]),
    roof(0.452, 0.44, 0.77, [P, G, G]),
    deck(0.488, 0.405, 0.42, [H, P, T]),
    deck(0.496, 0.36, 0.375, [H, P, P]),
    deck(0.5, 0.24, 0.25, [P, P, P]),
];

/// Body of a lorry that carries its load.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Load {
    Box,
    Tipper,
    Tank,
}

impl Load {
    /// The body of a lorry by chance: most have boxes.
    pub fn draw(looks: &mut RandomStream) -> Self {
        match looks.index(10) {
            0..=5 => Self::Box,
            6..=7 => Self::Tipper,
            _ => Self::Tank,
        }
    }
}

/// A lorry of one of three kinds.
pub(super) fn lorry(model: &mut Model<'_>, looks: &mut RandomStream) {
    shell(model, &CAB).draw(model);
    mirrors(model, &CAB, 0.40, T);
    model.hull(T, &[[-0.47, 0.14], [0.30, 0.14], [0.30, 0.285], [-0.47, 0.285]], [0.32, 0.32]);
    lamps(model, [0.17, 0.23], [0.29, 0.33]);
    model.cross_panel(T, [[0.5, 0.245], [0.5, 0.34]], [-0.62, 0.62], STRAIGHT);
    let [rear, front] = CAB.axles;
    let two = [rear + 0.05, front];
    let three = [rear - 0.06, rear + 0.08, front];
    let places: &[f64] = match Load::draw(looks) {
        Load::Box => {
            boxed(model);
            &two
        }
        Load::Tipper => {
            tipper(model);
            &three
        }
        Load::Tank => {
            tanker(model);
            &two
        }
    };
    axles(model, CAB.wheel, places);
}

/// A box with a dark edge below, and a shield above the cab.
fn boxed(model: &mut Model<'_>) {
    model.hull(C, &[[-0.5, 0.28], [0.255, 0.28], [0.255, 1.0], [-0.5, 1.0]], STRAIGHT);
    model.cross_panel(T, [[-0.5, 0.285], [-0.5, 0.31]], [-0.98, 0.98], STRAIGHT);
    model.side_panels(T, &[[-0.495, 0.285], [0.25, 0.285], [0.25, 0.305], [-0.495, 0.305]], STRAIGHT);
    model.hull(P, &[[0.275, 0.76], [0.42, 0.79], [0.30, 0.97], [0.275, 0.97]], [0.40, 0.34]);
    guards(model);
}

/// An open body that tips: four walls around a load.
fn tipper(model: &mut Model<'_>) {
    let wall = [[-0.5, 0.30], [0.25, 0.30], [0.25, 0.66], [-0.49, 0.66]];
    model.hull(P, &wall, STRAIGHT);
    model.cross_top(T, [-0.475, 0.235], 0.662, 0.46);
    for x in [-0.42, -0.29, -0.16, -0.03, 0.10] {
        model.side_panels(T, &[[x, 0.32], [x + 0.015, 0.32], [x + 0.015, 0.65], [x, 0.65]], STRAIGHT);
    }
    // A shield above the cab keeps the load back.
    model.hull(P, &[[0.235, 0.62], [0.26, 0.62], [0.26, 1.0], [0.235, 1.0]], [0.46, 0.46]);
    model.hull(P, &[[0.25, 0.96], [0.43, 0.96], [0.43, 1.0], [0.25, 1.0]], [0.44, 0.44]);
    guards(model);
}

/// A tank on its side.
fn tanker(model: &mut Model<'_>) {
    let size_m = model.size_m;
    let (middle_m, radius_m) = (0.62 * size_m.z, DVec3::new(0.0, 0.475 * size_m.y, 0.325 * size_m.z));
    let spot = |k: usize, x: f64, share: f64| {
        let (sin, cos) = real::sin_cos(real::TAU * k as f64 / SIDES as f64);
        let normal = DVec3::new(0.0, cos / radius_m.y, sin / radius_m.z).normalize_or_zero();
        (DVec3::new(x * size_m.x, share * radius_m.y * cos, middle_m + share * radius_m.z * sin), normal)
    };
    let rings = [(-0.498, 0.72), (-0.475, 1.0), (0.225, 1.0), (0.25, 0.72)];
    for (number, pair) in rings.windows(2).enumerate() {
        for k in 0..SIDES {
            let [a, b] = [k, k + 1].map(|k| spot(k, pair[0].0, pair[0].1));
            let [d, c] = [k, k + 1].map(|k| spot(k, pair[1].0, pair[1].1));
            if number == 1 {
                model.round(C, [a, b, c, d]);
            } else {
                model.face(C, &[a.0, b.0, c.0, d.0], DVec3::Z * middle_m);
            }
        }
    }
    for (x, share) in [rings[0], rings[3]] {
        let around: [DVec3; SIDES] = core::array::from_fn(|k| spot(k, x, share).0);
        model.face(C, &around, DVec3::Z * middle_m);
    }
    let (from, to) = (-0.40 * size_m.x, 0.16 * size_m.x);
    for sign in [-1.0, 1.0] {
        let at = |x_m: f64| DVec3::new(x_m, sign * 0.12 * size_m.y, 0.9925 * size_m.z);
        model.bar(Region::Metal, at(from), at(to), 0.015 * size_m.z);
    }
    for x in [-0.30, -0.12, 0.06] {
        let lid = [[x - 0.025, 0.93], [x + 0.025, 0.93], [x + 0.025, 0.985], [x - 0.025, 0.985]];
        model.hull(T, &lid, [0.08, 0.08]);
    }
    guards(model);
}

/// Guards between the axles, and mudguards.
fn guards(model: &mut Model<'_>) {
    model.hull(T, &[[-0.12, 0.13], [0.22, 0.13], [0.22, 0.24], [-0.12, 0.24]], [0.46, 0.46]);
    model.hull(T, &[[-0.498, 0.16], [-0.485, 0.16], [-0.485, 0.28], [-0.498, 0.28]], [0.48, 0.48]);
}
