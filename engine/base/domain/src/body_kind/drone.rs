//! Row of kind `drone`.

use super::row::{BodyKindRow, BodyWords};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "drone",
    noun: "drone",
    label: SemanticLabel::Dynamic,
    is_dressed: false,
    class_size_m: [0.6, 0.6, 0.2],
    driving: None,
    lamps: None,
    words: BodyWords {
        english: "drone",
        one_in_english: "another drone",
        chinese: "无人机",
        one_in_chinese: "另一架无人机",
    },
};
