//! Row of kind `bus`.

use super::row::{BodyKindRow, Driving};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "bus",
    noun: "bus",
    label: SemanticLabel::Bus,
    is_dressed: false,
    class_size_m: [12.0, 2.5, 3.4],
    driving: Some(Driving {
        sizes_m: [[10.5, 12.0], [2.5, 2.55], [3.0, 3.2]],
        top_mps: 24.0,
        accelerate_mps2: 1.0,
        brake_mps2: 1.6,
        sideways_mps2: 1.2,
    }),
    walking: None,
    lamps: Some([1.0, 1.0]),
};
