//! Row of kind `push_chair`.

use super::row::{BodyKindRow, Walking};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "push_chair",
    noun: "push-chair",
    label: SemanticLabel::Pedestrian,
    is_dressed: true,
    class_size_m: [1.5, 0.7, 1.719],
    driving: None,
    walking: Some(Walking { heights_m: None, pace: [0.75, 1.0], outline_m: Some([1.5, 0.7]) }),
    lamps: None,
};
