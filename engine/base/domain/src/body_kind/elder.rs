//! Row of kind `elder`.

use super::row::{BodyKindRow, Walking, people};

pub(super) static ROW: BodyKindRow = people(
    ["elder", "old person"],
    [0.478, 0.478, 1.65],
    Walking { heights_m: Some([1.5, 1.75]), pace: [0.5, 0.8], outline_m: None },
);
