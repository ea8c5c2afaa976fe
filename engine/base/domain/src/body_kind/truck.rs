//! Row of kind `truck`.

use super::row::{BodyKindRow, Driving};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "truck",
    noun: "truck",
    label: SemanticLabel::Truck,
    is_dressed: false,
    class_size_m: [7.1, 2.4, 2.4],
    driving: Some(Driving {
        sizes_m: [[6.5, 8.5], [2.3, 2.5], [2.9, 3.5]],
        top_mps: 25.0,
        accelerate_mps2: 0.9,
        brake_mps2: 1.8,
        sideways_mps2: 1.5,
    }),
    walking: None,
    lamps: Some([1.0, 1.0]),
};
