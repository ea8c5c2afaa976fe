//! Things that people take along: wheelchairs with their users, push-chairs, dogs on a leash.

use super::model::Model;
use super::riders::{SEATED_M, Seat, seated};
use crate::Clothes;
use crate::body_figure::BodyFigure;
use crate::frustum::{SIDES, around};
use crate::region::Region;
use cosfly_frames::{DVec3, real};

/// Length of a leash, metres.
const LEASH_M: f64 = 1.3;

/// A wheelchair with its user, who sits in it.
pub(super) fn wheelchair(model: &mut Model<'_>, clothes: &Clothes) {
    let stretch = model.size_m / SEATED_M;
    let at = |x_m: f64, y_m: f64, z_m: f64| stretch * DVec3::new(x_m, y_m, z_m);
    let share = |x_m: f64, z_m: f64| [x_m / SEATED_M.x, z_m / SEATED_M.z];
    model.hull(
        Region::Trim,
        &[share(-0.24, 0.42), share(0.20, 0.42), share(0.20, 0.50), share(-0.24, 0.50)],
        [0.34; 2],
    );
    model.hull(
        Region::Trim,
        &[share(-0.30, 0.44), share(-0.25, 0.44), share(-0.28, 0.94), share(-0.33, 0.94)],
        [0.32; 2],
    );
    model.hull(
        Region::Trim,
        &[share(0.34, 0.08), share(0.528, 0.08), share(0.528, 0.11), share(0.34, 0.11)],
        [0.26; 2],
    );
    let thick_m = 0.028 * stretch.min_element();
    for side in [-1.0, 1.0] {
        model.spoked_wheel([-0.14 * stretch.x, side * 0.308 * stretch.y], 0.30 * stretch, 0.034 * stretch.y);
        model.spoked_wheel([0.26 * stretch.x, side * 0.21 * stretch.y], 0.09 * stretch, 0.034 * stretch.y);
        for (from, to) in [
            (at(-0.32, side * 0.2, 0.90), at(-0.523, side * 0.2, 0.92)),
            (at(-0.28, side * 0.22, 0.90), at(-0.24, side * 0.22, 0.30)),
            (at(-0.28, side * 0.25, 0.68), at(0.12, side * 0.25, 0.68)),
            (at(0.12, side * 0.25, 0.68), at(0.18, side * 0.22, 0.45)),
            (at(0.18, side * 0.17, 0.46), at(0.40, side * 0.17, 0.10)),
            (at(-0.14, side * 0.30, 0.30), at(0.20, side * 0.22, 0.42)),
            (at(0.18, side * 0.21, 0.42), at(0.26, side * 0.21, 0.09)),
        ] {
            model.bar(Region::Metal, from, to, thick_m);
        }
    }
    let seat = Seat {
        hip: [-0.085, 0.545],
        shoulder: [-0.115, 0.80],
        hand: [0.06, 0.645],
        half_grip: 0.140,
        feet: [[0.212, 0.305]; 2],
        half_stand: 0.075,
        helmet: false,
    };
    seated(model, &seat, clothes);
}

/// A push-chair before the person who pushes it.
pub(super) fn push_chair(model: &mut Model<'_>, clothes: &Clothes, figure: &BodyFigure) {
    model.on_foot(figure.on_foot(), clothes);
    let size_m = model.size_m;
    let share = |x_m: f64, z_m: f64| [x_m / size_m.x, z_m / size_m.z];
    let [handle_x, handle_z] = [0.27 * size_m.z - 0.36, 0.595 * size_m.z];
    let cot = [share(0.20, 0.56), share(0.60, 0.50), share(0.70, 0.58), share(0.70, 0.74), share(0.17, 0.80)];
    model.hull(Region::Paint, &cot, [0.32; 2]);
    let hood = [share(0.16, 0.78), share(0.44, 0.77), share(0.40, 0.98), share(0.30, 1.04), share(0.19, 0.99)];
    model.hull(Region::Trim, &hood, [0.33; 2]);
    let thick_m = 0.03;
    let ends = [-1.0, 1.0].map(|side| DVec3::new(handle_x, 0.24 * side, handle_z));
    model.bar(Region::Trim, ends[0], ends[1], 0.04);
    for (side, end) in [-1.0, 1.0].into_iter().zip(ends) {
        let at = |x_m: f64, z_m: f64| DVec3::new(x_m, 0.24 * side, z_m);
        model.bar(Region::Metal, end, at(0.60, 0.13), thick_m);
        model.bar(Region::Metal, at(0.50, 0.56), at(0.28, 0.13), thick_m);
        for x_m in [0.28, 0.60] {
            model.spoked_wheel([x_m, 0.275 * side], DVec3::splat(0.13), 0.045);
        }
    }
}

/// A dog on a leash at the right of the person, a little ahead.
pub(super) fn dog(model: &mut Model<'_>, clothes: &Clothes, figure: &BodyFigure) {
    model.on_foot(figure.on_foot(), clothes);
    let size = figure.clothes_seed.stream("dog").uniform(0.6, 1.0);
    let at = |x: f64, y: f64, z: f64| DVec3::new(0.27 + size * x, 0.27 + size * y, size * z);
    let section = |[x, z, half]: [f64; 3]| (at(x, 0.0, z), size * half);
    // Trunk, neck, head, tail.
    loft(
        model,
        &[[-0.29, 0.43, 0.05], [-0.24, 0.43, 0.085], [-0.05, 0.44, 0.085], [0.12, 0.42, 0.105], [0.25, 0.46, 0.07]]
            .map(section),
    );
    loft(model, &[[0.18, 0.46, 0.07], [0.34, 0.60, 0.05]].map(section));
    loft(model, &[[0.29, 0.62, 0.045], [0.36, 0.63, 0.062], [0.42, 0.605, 0.04], [0.52, 0.585, 0.028]].map(section));
    loft(model, &[[-0.27, 0.46, 0.026], [-0.36, 0.56, 0.02], [-0.43, 0.64, 0.012]].map(section));
    let trot = if figure.state.speed_mps > 0.0 { 0.09 } else { 0.0 };
    for (number, (x, y)) in [(0.17, -0.06), (0.17, 0.06), (-0.22, 0.06), (-0.22, -0.06)].into_iter().enumerate() {
        let swing = trot * real::sin(2.0 * figure.gait_phase_rad + if number % 2 == 0 { 0.0 } else { real::PI });
        model.bar(Region::Paint, at(x, y, 0.42), at(x + swing, y, 0.0), 0.05 * size);
    }
    for side in [-1.0, 1.0] {
        model.bar(Region::Paint, at(0.34, 0.045 * side, 0.66), at(0.32, 0.06 * side, 0.73), 0.03 * size);
    }
    let height_m = model.size_m.z;
    let hand = DVec3::new(0.18 * height_m - 0.40, 0.138 * height_m - 0.12, 0.51 * height_m);
    // A slack leash hangs in a parabola.
    let collar = at(0.27, 0.0, 0.58);
    let apart_m = (collar - hand).length();
    let sag_m = apart_m * (0.375 * (LEASH_M / apart_m - 1.0)).max(0.0).sqrt();
    let point = |share: f64| hand.lerp(collar, share) - DVec3::Z * (4.0 * sag_m * share * (1.0 - share));
    for piece in 0..8 {
        model.bar(Region::Trim, point(0.125 * f64::from(piece)), point(0.125 * f64::from(piece + 1)), 0.014);
    }
}

/// A round body of fur through sections across its length, each with its half width.
fn loft(model: &mut Model<'_>, sections: &[(DVec3, f64)]) {
    let around = around();
    let corner = |(middle, half_m): &(DVec3, f64), k: usize| {
        let (sin, cos) = around[k % SIDES];
        *middle + DVec3::new(0.0, half_m * cos, 1.15 * half_m * sin)
    };
    for pair in sections.windows(2) {
        let inside = 0.5 * (pair[0].0 + pair[1].0);
        for k in 0..SIDES {
            let corners = [corner(&pair[0], k), corner(&pair[0], k + 1), corner(&pair[1], k + 1), corner(&pair[1], k)];
            model.face(Region::Paint, &corners, inside);
        }
    }
    for (end, next) in [(0, 1), (sections.len() - 1, sections.len() - 2)] {
        let corners: [DVec3; SIDES] = core::array::from_fn(|k| corner(&sections[end], k));
        model.face(Region::Paint, &corners, sections[next].0);
    }
}
