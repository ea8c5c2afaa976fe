//! Row of kind `car`.

use super::row::{BodyKindRow, Driving};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "car",
    noun: "car",
    label: SemanticLabel::Car,
    is_dressed: false,
    class_size_m: [5.0, 1.8, 1.5],
    driving: Some(Driving {
        sizes_m: [[3.6, 4.85], [1.66, 1.9], [1.42, 1.68]],
        top_mps: 45.0,
        accelerate_mps2: 1.5,
        brake_mps2: 2.0,
        sideways_mps2: 2.2,
    }),
    walking: None,
    lamps: Some([1.0, 1.0]),
};
