//! Row of kind `van`.

use super::row::{BodyKindRow, Driving, vehicle};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = vehicle(
    "van",
    SemanticLabel::Car,
    [6.5, 2.16, 2.86],
    Driving {
        sizes_m: [[4.8, 5.9], [1.9, 2.05], [1.95, 2.55]],
        top_mps: 36.0,
        accelerate_mps2: 1.3,
        brake_mps2: 2.0,
        sideways_mps2: 2.0,
    },
);
