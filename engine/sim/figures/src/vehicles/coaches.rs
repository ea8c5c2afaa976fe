//! Cars, vans, lorries and buses. Outlines are shares of length (forward of the middle) and height.

use super::model::Model;
use super::wheels::{Axle, turn_rad};
use crate::region::Region;

/// Half width of straight sheet, as a share of the width: wheels reach a little farther.
const STRAIGHT: [f64; 2] = [0.494, 0.494];

/// A lorry with a box behind its cab.
pub(super) fn truck(model: &mut Model<'_>, phase_rad: f64) {
    let cab = [[0.27, 0.12], [0.49, 0.12], [0.5, 0.20], [0.5, 0.42], [0.475, 0.74], [0.44, 0.80], [0.27, 0.80]];
    model.hull(Region::Paint, &cab, [0.49, 0.48]);
    model.cross_panel(Region::Glass, [[0.4985, 0.44], [0.4775, 0.71]], [-0.9, 0.9], [0.49, 0.48]);
    model.side_panels(Region::Glass, &[[0.34, 0.46], [0.475, 0.46], [0.455, 0.70], [0.34, 0.70]], [0.49, 0.48]);
    model.hull(Region::Cargo, &[[-0.5, 0.28], [0.25, 0.28], [0.25, 1.0], [-0.5, 1.0]], STRAIGHT);
    model.hull(Region::Trim, &[[-0.47, 0.14], [0.28, 0.14], [0.28, 0.285], [-0.47, 0.285]], [0.32, 0.32]);
    lamps(model, [0.22, 0.28], [0.29, 0.33]);
    axles(model, 0.14, &[-0.36, -0.22, 0.38], phase_rad);
}

/// A city bus.
pub(super) fn bus(model: &mut Model<'_>, phase_rad: f64) {
    let outline = [
        [-0.495, 0.09],
        [0.495, 0.09],
        [0.5, 0.14],
        [0.5, 0.88],
        [0.485, 1.0],
        [-0.485, 1.0],
        [-0.5, 0.92],
        [-0.5, 0.14],
    ];
    model.hull(Region::Paint, &outline, STRAIGHT);
    model.cross_panel(Region::Glass, [[0.5, 0.34], [0.5, 0.86]], [-0.94, 0.94], STRAIGHT);
    model.cross_panel(Region::Glass, [[-0.5, 0.52], [-0.5, 0.84]], [-0.85, 0.85], STRAIGHT);
    const PANES: usize = 7;
    for pane in 0..PANES {
        let from = -0.47 + 0.94 * pane as f64 / PANES as f64;
        let to = from + 0.94 / PANES as f64 - 0.012;
        model.side_panels(Region::Glass, &[[from, 0.42], [to, 0.42], [to, 0.82], [from, 0.82]], STRAIGHT);
    }
    for door in [-0.02, 0.40] {
        let to = door + 0.075;
        model.side_panel(Region::Trim, &[[door, 0.12], [to, 0.12], [to, 0.42], [door, 0.42]], STRAIGHT, 1.0);
    }
    lamps(model, [0.17, 0.23], [0.24, 0.34]);
    axles(model, 0.155, &[-0.27, 0.27], phase_rad);
}

/// Lamps at both ends between two heights each, and the number plates.
fn lamps(model: &mut Model<'_>, front: [f64; 2], rear: [f64; 2]) {
    for (x, region, [low, high]) in [(0.5, Region::HeadLamp, front), (-0.5, Region::TailLamp, rear)] {
        for sign in [-1.0, 1.0] {
            model.cross_panel(region, [[x, low], [x, high]], [sign * 0.58, sign * 0.90], STRAIGHT);
        }
        let low = if x > 0.0 { low - 0.06 } else { low - 0.08 };
        model.cross_panel(Region::Plate, [[x, low], [x, low + 0.05]], [-0.27, 0.27], STRAIGHT);
    }
}

/// Axles at shares of the length, with wheels of a share of the height.
fn axles(model: &mut Model<'_>, wheel: f64, places: &[f64], phase_rad: f64) {
    let radius_m = wheel * model.size_m.z;
    let turn_rad = turn_rad(phase_rad, model.size_m.z, radius_m);
    for x in places {
        model.axle(&Axle { x_m: x * model.size_m.x, radius_m, arch_from_m: None, turn_rad });
    }
}
