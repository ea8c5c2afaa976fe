//! Buses and coaches. Outlines are shares of length (forward of the middle) and height.

use super::cars::{mirrors, shell};
use super::model::Model;
use super::shapes::{LARGE, STRAIGHT, Shape, deck, roof};
use super::wheels::{Axle, Rim};
use crate::region::Region;
use Region::{Glass as G, Paint as P, TailLamp as R, Trim as T};
use cosfly_frames::RandomStream;

/// Body of a city bus.
const CITY: Shape = Shape {
    tumble: 0.965,
    drop: 0.075,
    axles: [-0.24, 0.27],
    wheel: 0.155,
    sections: &[
        roof(-0.5, 0.45, 0.90, [R, P, P]),
        roof(-0.492, 0.45, 0.935, [P, P, P]),
        roof(-0.46, 0.42, 0.945, [P, G, P]),
        roof(-0.325, 0.40, 0.945, [P, T, P]),
        roof(-0.315, 0.40, 0.945, [P, G, P]),
        roof(-0.175, 0.40, 0.945, [P, T, P]),
        roof(-0.165, 0.40, 0.945, [P, G, P]),
        roof(-0.025, 0.40, 0.945, [P, T, P]),
        roof(-0.015, 0.40, 0.945, [P, G, P]),
        roof(0.125, 0.40, 0.945, [P, T, P]),
        roof(0.135, 0.40, 0.945, [P, G, P]),
        roof(0.275, 0.40, 0.945, [P, T, P]),
        roof(0.285, 0.40, 0.945, [P, G, P]),
        roof(0.38, 0.40, 0.945, [P, T, P]),
        roof(0.39, 0.38, 0.945, [P, G, P]),
        roof(0.472, 0.37, 0.94, [P, G, P]),
        roof(0.49, 0.36, 0.925, [P, G, G]),
        deck(0.499, 0.31, 0.33, [P, P, P]),
        deck(0.5, 0.26, 0.27, [P, P, P]),
    ],
    ..LARGE
};

/// Body of a coach: higher, with dark panes in one band and a raked front.
const COACH: Shape = Shape {
    foot: 0.085,
    tumble: 0.93,
    drop: 0.085,
    axles: [-0.26, 0.275],
    sections: &[
        roof(-0.5, 0.50, 0.90, [R, P, P]),
        roof(-0.492, 0.50, 0.945, [P, P, P]),
        roof(-0.455, 0.50, 0.96, [P, G, P]),
        roof(-0.26, 0.50, 0.97, [P, T, P]),
        roof(-0.255, 0.50, 0.97, [P, G, P]),
        roof(-0.07, 0.50, 0.97, [P, T, P]),
        roof(-0.065, 0.50, 0.97, [P, G, P]),
        roof(0.12, 0.50, 0.97, [P, T, P]),
        roof(0.125, 0.50, 0.97, [P, G, P]),
        roof(0.31, 0.49, 0.97, [P, T, P]),
        roof(0.315, 0.47, 0.97, [P, G, P]),
        roof(0.42, 0.40, 0.96, [P, G, P]),
        roof(0.455, 0.36, 0.945, [P, G, G]),
        deck(0.492, 0.30, 0.33, [P, P, P]),
        deck(0.5, 0.20, 0.21, [P, P, P]),
    ],
    ..LARGE
};

/// A city bus or a coach.
pub(super) fn bus(model: &mut Model<'_>, looks: &mut RandomStream) {
    let is_city = looks.chance(0.65);
    let shape = if is_city { &CITY } else { &COACH };
    shell(model, shape).draw(model);
    mirrors(model, shape, 0.42, T);
    lamps(model, [0.17, 0.23], [0.24, 0.34]);
    if is_city {
        destination(model, shape, looks);
        // Doors of two leaves.
        for door in [-0.41, -0.045, 0.375] {
            for leaf in [door, door + 0.052] {
                let to = leaf + 0.048;
                model.side_panel(G, &[[leaf, 0.11], [to, 0.11], [to, 0.41], [leaf, 0.41]], STRAIGHT, 1.0);
            }
        }
        // Air is cooled on the roof.
        for [from, to] in [[-0.36, -0.20], [0.08, 0.22]] {
            let pod = [[from, 0.94], [to, 0.94], [to - 0.01, 1.0], [from + 0.01, 1.0]];
            model.hull(Region::Cargo, &pod, [0.34, 0.34]);
        }
        hatches(model, &[-0.08, 0.34], 0.947);
        model.cross_panel(T, [[-0.5, 0.40], [-0.5, 0.44]], [-0.6, 0.6], STRAIGHT);
        axles(model, shape.wheel, &shape.axles);
    } else {
        for x in [-0.14, 0.04] {
            let lid = [[x, 0.14], [x + 0.16, 0.14], [x + 0.16, 0.145], [x, 0.145]];
            model.side_panels(T, &lid, STRAIGHT);
        }
        // Air is cooled on the roof, too, in the colour of the body.
        let pod = [[-0.30, 0.965], [-0.10, 0.965], [-0.115, 1.0], [-0.285, 1.0]];
        model.hull(P, &pod, [0.34, 0.34]);
        hatches(model, &[-0.40, 0.06, 0.28], 0.972);
        let [rear, front] = shape.axles;
        axles(model, shape.wheel, &[rear - 0.115, rear, front]);
    }
    model.cross_panel(G, [[-0.5, 0.56], [-0.5, 0.84]], [-0.85, 0.85], STRAIGHT);
}

/// Panes in the roof from these places on, at a height: one looks up through them, and gets out through them.
fn hatches(model: &mut Model<'_>, places: &[f64], height: f64) {
    for from in places {
        model.cross_top(G, [*from, from + 0.066], height, 0.15);
    }
}

/// The lit number and the name of where a bus goes, above the windscreen.
fn destination(model: &mut Model<'_>, shape: &Shape, looks: &mut RandomStream) {
    let top = shape.sections.iter().rfind(|section| section.roofed).map_or(0.9, |section| section.top - shape.drop);
    let heights = [[0.5, top - 0.07], [0.5, top]];
    model.cross_panel(T, [[0.5, top - 0.085], [0.5, top + 0.015]], [-0.78, 0.78], STRAIGHT);
    let name = 0.1 + 0.5 * looks.unit();
    for ys in [[-0.70, -0.60], [-0.57, -0.47], [-0.25, name - 0.2], [name - 0.14, name]] {
        model.cross_panel(Region::HeadLamp, heights, ys, STRAIGHT);
    }
}

/// Lamps at both ends between two heights each, and the number plates.
pub(super) fn lamps(model: &mut Model<'_>, front: [f64; 2], rear: [f64; 2]) {
    for (x, region, [low, high]) in [(0.5, Region::HeadLamp, front), (-0.5, Region::TailLamp, rear)] {
        for sign in [-1.0, 1.0] {
            model.cross_panel(region, [[x, low], [x, high]], [sign * 0.58, sign * 0.90], STRAIGHT);
        }
        let low = if x > 0.0 { low - 0.06 } else { low - 0.08 };
        model.cross_panel(Region::Plate, [[x, low], [x, low + 0.05]], [-0.27, 0.27], STRAIGHT);
    }
}

/// Axles at shares of the length, with wheels of a share of the height.
pub(super) fn axles(model: &mut Model<'_>, wheel: f64, places: &[f64]) {
    let radius_m = wheel * model.size_m.z;
    let arch_from_m = Some(0.10 * model.size_m.z);
    for x in places {
        let (x_m, half_width_m) = (x * model.size_m.x, 0.5 * model.size_m.y);
        model.axle(&Axle { x_m, half_width_m, radius_m, arch_from_m, rim: Rim::Plate });
    }
}
