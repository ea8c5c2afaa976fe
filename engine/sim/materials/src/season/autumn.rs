//! Row of season `autumn`.

use super::row::SeasonRow;
use crate::vector::Vec3;

pub(super) static ROW: SeasonRow = SeasonRow {
    lawn: [Vec3::new(0.064, 0.098, 0.032), Vec3::new(0.165, 0.150, 0.072)],
    woods: [Vec3::new(0.110, 0.085, 0.034), Vec3::new(0.090, 0.078, 0.044)],
    gaps: [0.52, 0.70, 0.75],
    leaf: Vec3::new(1.0, 1.0, 1.0),
    turned: Some([1.4, -0.1]),
    is_bare: false,
};
