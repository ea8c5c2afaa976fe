//! [`CloudOptions`]: the few choices that all formats of point clouds leave to the user.

use crate::up_axis::UpAxis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Options of point clouds.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CloudOptions {
    /// Axis of the file that points up: `y`, `z` or `-y` (y down). Default: `y` for meshes, `z` for point clouds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub up_axis: Option<UpAxis>,
    /// Side of the cells in which shapes become solid boxes, metres. 0.2 to 10. Default: 0.5; up to 2 for clouds of sparse points.
    #[schemars(range(min = 0.2, max = 10.0))]
    pub voxel_m: Option<f64>,
    /// Height of the steps in which boxes follow roofs, metres: boxes stand over a roof by less than one step; higher steps are
    /// fewer boxes. 0.25 to 5. Default: 1, or the side of the cells where these are wider; 0.75 at most on pitched roofs.
    #[schemars(range(min = 0.25, max = 5.0))]
    pub step_m: Option<f64>,
    /// Length of the file's unit, metres: 0.3048 for feet. 0.000001 to 1000. Default: what the file says, else 1.
    #[schemars(range(min = 0.000001, max = 1000.0))]
    pub unit_m: Option<f64>,
    /// Whether the middles of Gaussian splats (PLY) count as points. Their surfaces are thick, and glass and sky have some, too. Default: refused.
    #[serde(skip_serializing_if = "core::ops::Not::not")]
    pub splats_as_points: bool,
}
