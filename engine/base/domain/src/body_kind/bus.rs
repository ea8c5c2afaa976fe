//! Row of kind `bus`.

use super::row::{BodyKindRow, Driving, vehicle};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = vehicle(
    "bus",
    SemanticLabel::Bus,
    [12.0, 2.5, 3.4],
    Driving {
        sizes_m: [[10.5, 12.0], [2.5, 2.55], [3.0, 3.2]],
        top_mps: 24.0,
        accelerate_mps2: 1.0,
        brake_mps2: 1.6,
        sideways_mps2: 1.2,
    },
);
