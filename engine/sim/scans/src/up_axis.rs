//! [`UpAxis`]: which axis of a file points up.

use cosfly_frames::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Axis of a file that points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum UpAxis {
    /// y up, z towards the viewer: glTF, most OBJ files, `.spz`, scans of phones.
    #[default]
    #[serde(rename = "y")]
    Y,
    /// z up: surveys.
    #[serde(rename = "z")]
    Z,
    /// y down: programs that compute a place from photographs (COLMAP), and most trainers of splats.
    #[serde(rename = "-y")]
    MinusY,
}

impl UpAxis {
    /// A point of the file in the map frame: right-handed, z up.
    pub fn in_map(self, DVec3 { x, y, z }: DVec3) -> DVec3 {
        match self {
            Self::Y => DVec3::new(x, -z, y),
            Self::Z => DVec3::new(x, y, z),
            Self::MinusY => DVec3::new(x, z, -y),
        }
    }
}
