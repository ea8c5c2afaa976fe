//! Cars, vans, lorries and buses. Outlines are shares of length (forward of the middle) and height.

use super::livery::CarBody;
use super::model::Model;
use crate::region::Region;

/// Half width of straight sheet, as a share of the width: wheels reach a little farther.
const STRAIGHT: [f64; 2] = [0.494, 0.494];

/// A passenger car.
pub(super) fn car(model: &mut Model<'_>, body: CarBody) {
    let (back_foot, back_top, roof_back) = match body {
        CarBody::Saloon => (-0.40, -0.27, -0.20),
        CarBody::Hatchback => (-0.47, -0.40, -0.34),
    };
    let lower = [
        [-0.47, 0.14],
        [0.46, 0.14],
        [0.5, 0.26],
        [0.5, 0.44],
        [0.455, 0.53],
        [0.20, 0.60],
        [-0.36, 0.63],
        [-0.47, 0.62],
        [-0.5, 0.56],
        [-0.5, 0.26],
    ];
    model.hull(Region::Paint, &lower, STRAIGHT);
    let cabin = [0.56, 0.375];
    let (windscreen, rear) = ([[0.25, 0.58], [0.09, 0.96]], [[back_foot, 0.58], [back_top, 0.96]]);
    let outline = [rear[0], windscreen[0], windscreen[1], [0.03, 1.0], [roof_back, 1.0], rear[1]];
    model.hull(Region::Paint, &outline, cabin);
    for pane in [windscreen, rear] {
        let at = |t: f64| [pane[0][0] + t * (pane[1][0] - pane[0][0]), pane[0][1] + t * (pane[1][1] - pane[0][1])];
        model.cross_panel(Region::Glass, [at(0.14), at(0.96)], [-0.88, 0.88], cabin);
    }
    let back = |z: f64| back_foot + (back_top - back_foot) * (z - 0.58) / 0.38 + 0.035;
    model.side_panels(Region::Glass, &[[-0.055, 0.65], [0.185, 0.65], [0.082, 0.93], [-0.055, 0.93]], cabin);
    model.side_panels(Region::Glass, &[[back(0.65), 0.65], [-0.08, 0.65], [-0.08, 0.93], [back(0.93), 0.93]], cabin);
    lamps(model, [0.32, 0.42], [0.44, 0.54]);
    let radius_m = 0.215 * model.size_m.z;
    let width_m = 0.12 * model.size_m.y;
    for x in [-0.30, 0.31] {
        model.wheels(x * model.size_m.x, radius_m, width_m);
    }
}

/// A van: one box with a short nose.
pub(super) fn van(model: &mut Model<'_>) {
    let sides = [0.494, 0.46];
    let outline = [
        [-0.49, 0.10],
        [0.47, 0.10],
        [0.5, 0.18],
        [0.5, 0.36],
        [0.42, 0.48],
        [0.29, 0.90],
        [0.20, 1.0],
        [-0.48, 1.0],
        [-0.5, 0.93],
        [-0.5, 0.18],
    ];
    model.hull(Region::Paint, &outline, sides);
    model.cross_panel(Region::Glass, [[0.41, 0.512], [0.302, 0.861]], [-0.9, 0.9], sides);
    model.cross_panel(Region::Glass, [[-0.5, 0.58], [-0.5, 0.86]], [-0.8, 0.8], sides);
    model.side_panels(Region::Glass, &[[0.16, 0.54], [0.375, 0.54], [0.285, 0.83], [0.16, 0.83]], sides);
    lamps(model, [0.26, 0.34], [0.30, 0.42]);
    let (radius_m, width_m) = (0.15 * model.size_m.z, 0.12 * model.size_m.y);
    for x in [-0.30, 0.32] {
        model.wheels(x * model.size_m.x, radius_m, width_m);
    }
}

/// A lorry with a box behind its cab.
pub(super) fn truck(model: &mut Model<'_>) {
    let cab = [[0.27, 0.12], [0.49, 0.12], [0.5, 0.20], [0.5, 0.42], [0.475, 0.74], [0.44, 0.80], [0.27, 0.80]];
    model.hull(Region::Paint, &cab, [0.49, 0.48]);
    model.cross_panel(Region::Glass, [[0.4985, 0.44], [0.4775, 0.71]], [-0.9, 0.9], [0.49, 0.48]);
    model.side_panels(Region::Glass, &[[0.34, 0.46], [0.475, 0.46], [0.455, 0.70], [0.34, 0.70]], [0.49, 0.48]);
    model.hull(Region::Cargo, &[[-0.5, 0.28], [0.25, 0.28], [0.25, 1.0], [-0.5, 1.0]], STRAIGHT);
    model.hull(Region::Trim, &[[-0.47, 0.14], [0.28, 0.14], [0.28, 0.285], [-0.47, 0.285]], [0.32, 0.32]);
    lamps(model, [0.22, 0.28], [0.29, 0.33]);
    let (radius_m, width_m) = (0.14 * model.size_m.z, 0.14 * model.size_m.y);
    for x in [-0.36, -0.22, 0.38] {
        model.wheels(x * model.size_m.x, radius_m, width_m);
    }
}

/// A city bus.
pub(super) fn bus(model: &mut Model<'_>) {
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
    let (radius_m, width_m) = (0.155 * model.size_m.z, 0.12 * model.size_m.y);
    for x in [-0.27, 0.27] {
        model.wheels(x * model.size_m.x, radius_m, width_m);
    }
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
