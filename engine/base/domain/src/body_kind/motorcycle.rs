//! Row of kind `motorcycle`.

use super::row::{BodyKindRow, Driving};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "motorcycle",
    noun: "motorcycle",
    label: SemanticLabel::Motorcycle,
    is_dressed: true,
    class_size_m: [2.2, 0.9, 1.5],
    driving: Some(Driving {
        sizes_m: [[2.0, 2.25], [0.75, 0.9], [1.55, 1.7]],
        top_mps: 40.0,
        accelerate_mps2: 2.2,
        brake_mps2: 2.5,
        sideways_mps2: 2.5,
    }),
    walking: None,
    lamps: Some([1.0, 1.0]),
};
