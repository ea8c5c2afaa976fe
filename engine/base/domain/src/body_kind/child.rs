//! Row of kind `child`.

use super::row::{BodyKindRow, Walking};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "child",
    noun: "child",
    label: SemanticLabel::Pedestrian,
    is_dressed: true,
    class_size_m: [0.35, 0.35, 1.25],
    driving: None,
    walking: Some(Walking { heights_m: Some([0.98, 1.45]), pace: [0.75, 1.2], outline_m: None }),
    lamps: None,
};
