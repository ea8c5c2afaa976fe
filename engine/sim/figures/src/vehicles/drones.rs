//! A small quadrotor: trunk, camera, four arms with motors and two-bladed rotors. All sizes follow the box.

use super::model::Model;
use crate::region::Region;
use cosfly_frames::DVec3;

/// Sizes that the shares are made for, metres.
const QUADROTOR_M: DVec3 = DVec3::new(0.6, 0.6, 0.2);
/// From the middle to the axis of a rotor, along both axes, metres.
const ARM_M: f64 = 0.165;
/// Length of a rotor's half, metres: its tip ends at the side of the box.
const BLADE_M: f64 = 0.135;

/// A quadrotor whose rotors rest, two along it and two across.
pub(super) fn quadrotor(model: &mut Model<'_>) {
    let stretch = model.size_m / QUADROTOR_M;
    let slab = |model: &mut Model<'_>, region: Region, low: [f64; 3], high: [f64; 3]| {
        slab(model, region, stretch * DVec3::from_array(low), stretch * DVec3::from_array(high));
    };
    slab(model, Region::Paint, [-0.12, -0.06, 0.07], [0.12, 0.06, 0.145]);
    slab(model, Region::Trim, [-0.08, -0.045, 0.145], [0.06, 0.045, 0.165]);
    slab(model, Region::Trim, [0.06, -0.03, 0.015], [0.12, 0.03, 0.07]);
    slab(model, Region::Glass, [0.12, -0.018, 0.025], [0.128, 0.018, 0.06]);
    for (x, y) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let (axis_x, axis_y) = (x * ARM_M, y * ARM_M);
        let from = stretch * DVec3::new(0.08 * x, 0.04 * y, 0.12);
        model.bar(Region::Trim, from, stretch * DVec3::new(axis_x, axis_y, 0.15), 0.022 * stretch.min_element());
        slab(model, Region::Metal, [axis_x - 0.02, axis_y - 0.02, 0.13], [axis_x + 0.02, axis_y + 0.02, 0.186]);
        slab(model, Region::Trim, [axis_x - 0.008, axis_y - 0.008, 0.0], [axis_x + 0.008, axis_y + 0.008, 0.14]);
        // Neighbouring rotors turn against each other.
        let (half_x, half_y) = if x * y > 0.0 { (BLADE_M, 0.018) } else { (0.018, BLADE_M) };
        let (low, high) = ([axis_x - half_x, axis_y - half_y, 0.186], [axis_x + half_x, axis_y + half_y, 0.2]);
        slab(model, Region::Trim, low, high);
    }
}

/// A box along the own axes between two corners, metres.
fn slab(model: &mut Model<'_>, region: Region, low: DVec3, high: DVec3) {
    let corner = |k: usize| {
        let pick = |axis: usize| if k >> axis & 1 == 1 { high[axis] } else { low[axis] };
        DVec3::new(pick(0), pick(1), pick(2))
    };
    let middle = 0.5 * (low + high);
    for face in [[0, 2, 6, 4], [1, 3, 7, 5], [0, 1, 5, 4], [2, 3, 7, 6], [0, 1, 3, 2], [4, 5, 7, 6]] {
        model.face(region, &face.map(corner), middle);
    }
}
