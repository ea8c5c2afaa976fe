//! Row of season `winter`.

use super::row::SeasonRow;
use crate::vector::Vec3;

pub(super) static ROW: SeasonRow = SeasonRow {
    lawn: [Vec3::new(0.078, 0.092, 0.040), Vec3::new(0.160, 0.140, 0.082)],
    woods: [Vec3::new(0.075, 0.066, 0.054), Vec3::new(0.070, 0.066, 0.060)],
    gaps: [0.30, 0.62, 0.85],
    leaf: Vec3::new(1.0, 1.0, 1.0),
    turned: None,
    is_bare: true,
};
