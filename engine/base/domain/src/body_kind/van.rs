//! Row of kind `van`.

use super::row::{BodyKindRow, Driving};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "van",
    noun: "van",
    label: SemanticLabel::Car,
    is_dressed: false,
    class_size_m: [6.5, 2.16, 2.86],
    driving: Some(Driving {
        sizes_m: [[4.8, 5.9], [1.9, 2.05], [1.95, 2.55]],
        top_mps: 36.0,
        accelerate_mps2: 1.3,
        brake_mps2: 2.0,
        sideways_mps2: 2.0,
    }),
    walking: None,
    lamps: Some([1.0, 1.0]),
};
