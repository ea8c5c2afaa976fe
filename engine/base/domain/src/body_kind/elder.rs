//! Row of kind `elder`.

use super::row::{BodyKindRow, PERSON, Walking};

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "elder",
    noun: "old person",
    class_size_m: [0.478, 0.478, 1.65],
    walking: Some(Walking { heights_m: Some([1.5, 1.75]), pace: [0.5, 0.8], outline_m: None }),
    ..PERSON
};
