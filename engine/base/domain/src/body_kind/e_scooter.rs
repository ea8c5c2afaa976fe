//! Row of kind `e_scooter`.

use super::row::{BodyKindRow, Driving, vehicle};
use crate::SemanticLabel;

const DRIVING: Driving = Driving {
    sizes_m: [[1.08, 1.22], [0.57, 0.64], [1.72, 2.0]],
    top_mps: 5.6,
    accelerate_mps2: 1.1,
    brake_mps2: 2.0,
    sideways_mps2: 1.4,
};
const VEHICLE: BodyKindRow = vehicle("e_scooter", SemanticLabel::Bicycle, [1.2, 0.5, 1.7], DRIVING);
pub(super) static ROW: BodyKindRow = BodyKindRow { noun: "e-scooter", is_dressed: true, ..VEHICLE };
