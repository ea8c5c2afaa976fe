//! [`MeshOptions`]: the choices that all formats of meshes leave to the user.

use crate::up_axis::UpAxis;
use cosfly_frames::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Advice on coordinates that count from the centre of the Earth.
pub const IN_A_PLAN: &str = "export the file with the axes of a plan: x to the east, y up, z to the south, metres";

/// Options of meshes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MeshOptions {
    /// Axis of the file that points up: `y`, `z` or `-y` (y down). Default: `y` for meshes, `z` for point clouds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub up_axis: Option<UpAxis>,
    /// Side of the cells in which shapes become solid boxes, metres. 0.2 to 10. Default: 0.5; up to 2 for clouds of sparse points.
    #[schemars(range(min = 0.2, max = 10.0))]
    pub voxel_m: Option<f64>,
    /// Length of the file's unit, metres: 0.3048 for feet. 0.000001 to 1000. Default: what the file says, else 1.
    #[schemars(range(min = 0.000001, max = 1000.0))]
    pub unit_m: Option<f64>,
    /// Whether meshes without telling names are one surface, as photogrammetry makes it: their ground is told by its shape.
    #[serde(skip_serializing_if = "core::ops::Not::not")]
    pub one_surface: bool,
}

impl MeshOptions {
    /// A point of the file in the map frame (right-handed, z up), metres.
    pub fn in_map(&self, point: DVec3) -> DVec3 {
        self.up_axis.unwrap_or(UpAxis::Y).in_map(point * self.unit_m.unwrap_or(1.0))
    }
}
