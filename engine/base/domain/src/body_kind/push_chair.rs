//! Row of kind `push_chair`.

use super::row::{BodyKindRow, Walking, people};

pub(super) static ROW: BodyKindRow = people(
    ["push_chair", "push-chair"],
    [1.5, 0.7, 1.719],
    Walking { heights_m: None, pace: [0.75, 1.0], outline_m: Some([1.5, 0.7]) },
);
