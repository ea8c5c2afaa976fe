//! Row of kind `elder`.

use super::row::{BodyKindRow, Walking};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "elder",
    noun: "old person",
    label: SemanticLabel::Pedestrian,
    is_dressed: true,
    class_size_m: [0.478, 0.478, 1.65],
    driving: None,
    walking: Some(Walking { heights_m: Some([1.5, 1.75]), pace: [0.5, 0.8], outline_m: None }),
    lamps: None,
};
