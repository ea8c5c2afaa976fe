//! People who sit on a chair.

use super::model::Model;
use super::riders::{SEATED_M, Seat, seated};
use crate::Clothes;
use crate::region::Region;
use cosfly_frames::DVec3;

/// A person on a chair of wood and steel, who looks ahead.
pub(super) fn sitter(model: &mut Model<'_>, clothes: &Clothes) {
    let stretch = model.size_m / SEATED_M;
    let at = |x_m: f64, y_m: f64, z_m: f64| stretch * DVec3::new(x_m, y_m, z_m);
    let share = |x_m: f64, z_m: f64| [x_m / SEATED_M.x, z_m / SEATED_M.z];
    let [seat_m, back_m] = [
        [[-0.26, 0.43], [0.18, 0.43], [0.18, 0.47], [-0.26, 0.47]],
        [[-0.29, 0.56], [-0.26, 0.56], [-0.32, 0.88], [-0.35, 0.88]],
    ];
    model.hull(Region::Paint, &seat_m.map(|[x, z]| share(x, z)), [0.33; 2]);
    model.hull(Region::Paint, &back_m.map(|[x, z]| share(x, z)), [0.32; 2]);
    let thick_m = 0.03 * stretch.min_element();
    for side in [-1.0, 1.0] {
        for (from, to) in [
            (at(-0.34, side * 0.2, 0.88), at(-0.25, side * 0.2, 0.43)),
            (at(-0.24, side * 0.2, 0.44), at(-0.33, side * 0.2, 0.0)),
            (at(0.16, side * 0.2, 0.44), at(0.20, side * 0.2, 0.0)),
        ] {
            model.bar(Region::Metal, from, to, thick_m);
        }
    }
    let seat = Seat {
        hip: [-0.085, 0.535],
        shoulder: [-0.125, 0.80],
        hand: [0.09, 0.575],
        half_grip: 0.075,
        feet: [[0.205, 0.2475], [0.185, 0.2475]],
        half_stand: 0.07,
        helmet: false,
    };
    seated(model, &seat, clothes);
}
