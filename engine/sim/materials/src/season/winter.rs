//! Row of season `winter`.

use super::row::SeasonRow;
use crate::vector::Vec3;

pub(super) static ROW: SeasonRow = SeasonRow {
    lawn: [Vec3::new(0.092, 0.118, 0.046), Vec3::new(0.175, 0.155, 0.088)],
    woods: [Vec3::new(0.075, 0.066, 0.054), Vec3::new(0.070, 0.066, 0.060)],
    gaps: [0.30, 0.62, 0.85],
    leaf: Vec3::new(1.0, 1.0, 1.0),
    turned: None,
    is_bare: true,
};
