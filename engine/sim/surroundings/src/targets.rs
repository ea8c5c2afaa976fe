//! Visibility of several targets at once.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Visibility that counts when the target has companions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SeveralTargets {
    /// Mean visibility of all together.
    #[default]
    Mean,
    /// Visibility of the one that is seen least.
    Minimum,
}
