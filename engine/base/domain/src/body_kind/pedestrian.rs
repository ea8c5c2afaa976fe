//! Row of kind `pedestrian`.

use super::row::{BodyKindRow, PERSON};

pub(super) static ROW: BodyKindRow = PERSON;
