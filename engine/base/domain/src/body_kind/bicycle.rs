//! Row of kind `bicycle`.

use super::row::{BodyKindRow, Driving};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "bicycle",
    noun: "bicycle",
    label: SemanticLabel::Bicycle,
    is_dressed: true,
    class_size_m: [1.6, 0.65, 1.7],
    driving: Some(Driving {
        sizes_m: [[1.7, 1.85], [0.58, 0.68], [1.65, 1.85]],
        top_mps: 5.5,
        accelerate_mps2: 0.9,
        brake_mps2: 1.8,
        sideways_mps2: 1.6,
    }),
    walking: None,
    lamps: Some([0.35, 0.4]),
};
