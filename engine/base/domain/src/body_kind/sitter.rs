//! Row of kind `sitter`.

use super::row::{BodyKindRow, Walking, people};

pub(super) static ROW: BodyKindRow = people(
    ["sitter", "seated person"],
    [1.05, 0.65, 1.32],
    Walking { heights_m: Some([1.25, 1.4]), pace: [1.0, 1.0], outline_m: Some([1.05, 0.65]) },
);
