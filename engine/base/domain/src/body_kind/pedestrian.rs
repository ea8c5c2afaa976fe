//! Row of kind `pedestrian`.

use super::row::{BodyKindRow, BodyWords};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "pedestrian",
    noun: "person",
    label: SemanticLabel::Pedestrian,
    is_dressed: true,
    class_size_m: [0.478, 0.478, 1.719],
    driving: None,
    lamps: None,
    words: BodyWords {
        english: "person", one_in_english: "another person", chinese: "人", one_in_chinese: "另一个人"
    },
};
