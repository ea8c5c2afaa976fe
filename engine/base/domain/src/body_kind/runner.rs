//! Row of kind `runner`.

use super::row::{BodyKindRow, Walking, people};

pub(super) static ROW: BodyKindRow =
    people(["runner", "runner"], [0.478, 0.478, 1.719], Walking { heights_m: None, pace: [1.8, 2.4], outline_m: None });
