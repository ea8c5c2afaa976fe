//! Row of kind `child`.

use super::row::{BodyKindRow, PERSON, Walking};

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "child",
    noun: "child",
    class_size_m: [0.35, 0.35, 1.25],
    walking: Some(Walking { heights_m: Some([0.98, 1.45]), pace: [0.75, 1.2], outline_m: None }),
    ..PERSON
};
