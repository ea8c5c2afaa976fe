//! Row of kind `drone`.

use super::row::BodyKindRow;
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "drone",
    noun: "drone",
    label: SemanticLabel::Dynamic,
    is_dressed: false,
    class_size_m: [0.6, 0.6, 0.2],
    driving: None,
    walking: None,
    lamps: None,
};
