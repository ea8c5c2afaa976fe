//! Row of kind `wheelchair`.

use super::row::{BodyKindRow, Walking};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "wheelchair",
    noun: "wheelchair",
    label: SemanticLabel::Rider,
    is_dressed: true,
    class_size_m: [1.05, 0.65, 1.32],
    driving: None,
    walking: Some(Walking { heights_m: Some([1.25, 1.4]), pace: [0.7, 1.05], outline_m: Some([1.05, 0.65]) }),
    lamps: None,
};
