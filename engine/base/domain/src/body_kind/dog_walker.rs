//! Row of kind `dog_walker`.

use super::row::{BodyKindRow, Walking, people};

pub(super) static ROW: BodyKindRow = people(
    ["dog_walker", "person with a dog"],
    [1.6, 0.92, 1.719],
    Walking { heights_m: None, pace: [0.7, 1.05], outline_m: Some([1.6, 0.92]) },
);
