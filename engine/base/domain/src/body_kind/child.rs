//! Row of kind `child`.

use super::row::{BodyKindRow, Walking, people};

pub(super) static ROW: BodyKindRow = people(
    ["child", "child"],
    [0.35, 0.35, 1.25],
    Walking { heights_m: Some([0.98, 1.45]), pace: [0.75, 1.2], outline_m: None },
);
