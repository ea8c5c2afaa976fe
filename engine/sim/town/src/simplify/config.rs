//! How far the boxes for planning may depart from the exact ones.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Merge, crop and prune of the obstacle boxes that the planner sees. Certificates and pictures use the exact boxes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SimplifyConfig {
    /// Whether to drop boxes inside others and join neighbours. On by default.
    pub merge: bool,
    /// Most empty space that one merged box may hold, as a share of its volume. 0 to 0.9, default 0.1.
    #[schemars(range(min = 0.0, max = 0.9))]
    pub max_empty_share: f64,
    /// No point of an original box ends up farther than this from a kept box, and no point of a merged box lies
    /// farther than this from an original one, metres. 0 to 5, default 0.5.
    #[schemars(range(min = 0.0, max = 5.0))]
    pub tolerance_m: f64,
    /// Whether to drop boxes no larger than the tolerance that lie within it of one kept box. On by default.
    pub prune: bool,
    /// Whether to drop boxes far from all walkable ground. Off by default.
    pub crop: bool,
    /// With `crop`: keep what is within this distance of walkable ground, metres. 10 to 100000, default 200.
    #[schemars(range(min = 10.0, max = 100000.0))]
    pub crop_radius_m: f64,
}

impl Default for SimplifyConfig {
    fn default() -> Self {
        Self { merge: true, max_empty_share: 0.1, tolerance_m: 0.5, prune: true, crop: false, crop_radius_m: 200.0 }
    }
}
