//! Knowledge of the future that the expert has.

use super::ranges::Range;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Knowledge that the expert has of the future of its target and of all that moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Foresight {
    /// All of it, as in the paper.
    #[default]
    Expected,
    /// Nothing: it plans again and again as it flies, and predicts that everybody goes on at their present velocity.
    Causal,
}

/// The planning of `foresight = "causal"`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CausalConfig {
    /// Time that is predicted and planned ahead, seconds. Default 8.
    #[schemars(range(min = 1.0, max = 60.0))]
    pub horizon_s: f64,
    /// Time that is flown before the next plan, seconds; at least one frame. Default 0.5.
    #[schemars(range(min = 0.0, max = 5.0))]
    pub replan_s: f64,
}

impl Default for CausalConfig {
    fn default() -> Self {
        Self { horizon_s: 8.0, replan_s: 0.5 }
    }
}

impl CausalConfig {
    pub(super) fn ranges(&self) -> [Range; 2] {
        [("causal.horizon_s", self.horizon_s, 1.0, 60.0), ("causal.replan_s", self.replan_s, 0.0, 5.0)]
    }
}
