//! Several drones behind one target.

use super::ranges::Range;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Several drones behind one target. Their flights are planned one after the other: each knows those before it, keeps apart from
/// them, looks past them, and is rejected where it would hide the target from one of them or the other way round.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct DronesConfig {
    /// Drones behind each target. Above 1 each flight is an item of its own, such as `p00000-d1` and `p00000-d2`; a higher number
    /// changes no flight of a lower one. Default 1.
    #[schemars(range(min = 1, max = 8))]
    pub count: u32,
    /// Smallest distance between two drones, middle to middle, at any time, metres. Default 6.
    #[schemars(range(min = 0.6, max = 50.0))]
    pub separation_m: f64,
}

impl Default for DronesConfig {
    fn default() -> Self {
        Self { count: 1, separation_m: 6.0 }
    }
}

impl DronesConfig {
    /// Parameters that no single flight depends on; not in its key.
    pub const NOT_IN_KEY: &[&str] = &["count"];

    pub(super) fn ranges(&self) -> [Range; 2] {
        [("drones.count", f64::from(self.count), 1.0, 8.0), ("drones.separation_m", self.separation_m, 0.6, 50.0)]
    }
}
