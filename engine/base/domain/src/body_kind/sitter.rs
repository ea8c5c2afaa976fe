//! Row of kind `sitter`.

use super::row::{BodyKindRow, PERSON, Walking};

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "sitter",
    noun: "seated person",
    class_size_m: [1.05, 0.65, 1.32],
    walking: Some(Walking { heights_m: Some([1.25, 1.4]), pace: [1.0, 1.0], outline_m: Some([1.05, 0.65]) }),
    ..PERSON
};
