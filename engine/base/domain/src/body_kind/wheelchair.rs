//! Row of kind `wheelchair`.

use super::row::{BodyKindRow, PERSON, Walking};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "wheelchair",
    noun: "wheelchair",
    label: SemanticLabel::Rider,
    class_size_m: [1.05, 0.65, 1.32],
    walking: Some(Walking { heights_m: Some([1.25, 1.4]), pace: [0.7, 1.05], outline_m: Some([1.05, 0.65]) }),
    ..PERSON
};
