//! Several targets at once.

use super::ranges::Range;
use cosfly_surroundings::SeveralTargets;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Several targets at once.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TargetsConfig {
    /// Further walkers to be seen beside each target: those that stay nearest to it. Default 0.
    #[schemars(range(min = 0, max = 8))]
    pub companions: u32,
    /// Which visibility counts. Default `mean`.
    pub visibility: SeveralTargets,
}

impl Default for TargetsConfig {
    fn default() -> Self {
        Self { companions: 0, visibility: SeveralTargets::Mean }
    }
}

impl TargetsConfig {
    pub(super) fn ranges(&self) -> [Range; 1] {
        [("targets.companions", f64::from(self.companions), 0.0, 8.0)]
    }
}
