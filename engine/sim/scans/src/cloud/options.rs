//! [`CloudOptions`]: the few choices that all formats of point clouds leave to the user.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Options of point clouds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CloudOptions {
    /// Side of the cells in which shapes become solid boxes, metres. 0.2 to 10. Default: 0.5; up to 2 for clouds of sparse points.
    #[schemars(range(min = 0.2, max = 10.0))]
    pub voxel_m: Option<f64>,
    /// Length of the file's unit, metres: 0.3048 for feet. 0.000001 to 1000. Default: what the file says, else 1.
    #[schemars(range(min = 0.000001, max = 1000.0))]
    pub unit_m: Option<f64>,
}
