//! The baselines and their names.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A planner to compare with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Baseline {
    /// The paper's A* over voxels of 2 m and timesteps, with the engine's own ray and distance queries.
    AstarFast,
    /// The path of `AstarFast`, made flyable: smoothed to the limits of speed, acceleration and jerk.
    AstarSmoothed,
    /// Layered beam search over the same voxels, in the manner of Track A*.
    Beam,
    /// The way through the polar lattice, with nothing after it.
    Dp,
}

impl Baseline {
    /// All, in the order of tables.
    pub const ALL: [Self; 4] = [Self::AstarFast, Self::AstarSmoothed, Self::Beam, Self::Dp];

    /// Name in tables and on command lines.
    pub fn name(self) -> &'static str {
        match self {
            Self::AstarFast => "astar_fast",
            Self::AstarSmoothed => "astar_smoothed",
            Self::Beam => "beam",
            Self::Dp => "dp",
        }
    }
}
