//! Losing the target on purpose.

use super::ranges::{Range, Refusal, ordered};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Losing the target on purpose: whole frames in which no body point is seen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OcclusionConfig {
    /// Number of times that the target is to be lost. The certificate states the time ordered and reached. Default 0.
    #[schemars(range(min = 0, max = 100))]
    pub count: u32,
    /// Shortest loss, seconds. Default 2.
    #[schemars(range(min = 0.1, max = 60.0))]
    pub min_s: f64,
    /// Longest loss, seconds; half-way between the two is aimed at. Default 4.
    #[schemars(range(min = 0.1, max = 60.0))]
    pub max_s: f64,
}

impl Default for OcclusionConfig {
    fn default() -> Self {
        Self { count: 0, min_s: 2.0, max_s: 4.0 }
    }
}

impl OcclusionConfig {
    pub(super) fn ranges(&self) -> [Range; 3] {
        [
            ("occlusion.count", f64::from(self.count), 0.0, 100.0),
            ("occlusion.min_s", self.min_s, 0.1, 60.0),
            ("occlusion.max_s", self.max_s, 0.1, 60.0),
        ]
    }

    pub(super) fn check_order(&self) -> Result<(), Refusal> {
        ordered(("occlusion.min_s", self.min_s), ("occlusion.max_s", self.max_s))
    }
}
