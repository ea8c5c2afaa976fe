//! Row of kind `car`.

use super::row::{BodyKindRow, Driving, vehicle};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = vehicle(
    "car",
    SemanticLabel::Car,
    [5.0, 1.8, 1.5],
    Driving {
        sizes_m: [[3.6, 4.85], [1.66, 1.9], [1.42, 1.68]],
        top_mps: 45.0,
        accelerate_mps2: 1.5,
        brake_mps2: 2.0,
        sideways_mps2: 2.2,
    },
);
