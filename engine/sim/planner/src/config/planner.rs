//! The choice of a planner: the optimiser or a baseline.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A planner.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Planner {
    /// The multi-constraint optimiser of the preset.
    #[default]
    Muco,
    /// The paper's A* over voxels of 2 m and time steps.
    Astar,
    /// The path of `astar`, smoothed to the limits of speed, acceleration and jerk.
    AstarSmoothed,
    /// Layered beam search over the same voxels.
    Beam,
    /// The way through the polar lattice, with nothing after it.
    Dp,
}

impl Planner {
    /// Name in recipes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Muco => "muco",
            Self::Astar => "astar",
            Self::AstarSmoothed => "astar_smoothed",
            Self::Beam => "beam",
            Self::Dp => "dp",
        }
    }

    /// Whether a baseline plans in the optimiser's place.
    pub fn is_baseline(self) -> bool {
        self != Self::Muco
    }

    /// Whether flights are made to hold limits of speed, acceleration and jerk.
    pub fn bounds_kinematics(self) -> bool {
        matches!(self, Self::Muco | Self::AstarSmoothed)
    }
}
