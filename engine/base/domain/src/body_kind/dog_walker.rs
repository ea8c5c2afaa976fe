//! Row of kind `dog_walker`.

use super::row::{BodyKindRow, PERSON, Walking};

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "dog_walker",
    noun: "person with a dog",
    class_size_m: [1.6, 0.92, 1.719],
    walking: Some(Walking { heights_m: None, pace: [0.7, 1.05], outline_m: Some([1.6, 0.92]) }),
    ..PERSON
};
