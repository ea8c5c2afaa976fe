//! Row of kind `pedestrian`.

use super::row::BodyKindRow;
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = BodyKindRow {
    name: "pedestrian",
    noun: "person",
    label: SemanticLabel::Pedestrian,
    is_dressed: true,
    class_size_m: [0.478, 0.478, 1.719],
    driving: None,
    lamps: None,
};
