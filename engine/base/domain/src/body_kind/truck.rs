//! Row of kind `truck`.

use super::row::{BodyKindRow, Driving, vehicle};
use crate::SemanticLabel;

pub(super) static ROW: BodyKindRow = vehicle(
    "truck",
    SemanticLabel::Truck,
    [7.1, 2.4, 2.4],
    Driving {
        sizes_m: [[6.5, 8.5], [2.3, 2.5], [2.9, 3.5]],
        top_mps: 25.0,
        accelerate_mps2: 0.9,
        brake_mps2: 1.8,
        sideways_mps2: 1.5,
    },
);
