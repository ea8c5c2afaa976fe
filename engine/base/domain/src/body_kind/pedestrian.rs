//! Row of kind `pedestrian`.

use super::row::{BodyKindRow, Walking};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "pedestrian",
    noun: "person",
    label: SemanticLabel::Pedestrian,
    is_dressed: true,
    class_size_m: [0.478, 0.478, 1.719],
    driving: None,
    walking: Some(Walking { heights_m: None, pace: [1.0, 1.0], outline_m: None }),
    lamps: None,
};
