//! Row of kind `push_chair`.

use super::row::{BodyKindRow, PERSON, Walking};

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "push_chair",
    noun: "push-chair",
    class_size_m: [1.5, 0.7, 1.719],
    walking: Some(Walking { heights_m: None, pace: [0.75, 1.0], outline_m: Some([1.5, 0.7]) }),
    ..PERSON
};
