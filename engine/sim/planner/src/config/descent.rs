//! The gradient descent of `preset = "paper"`.

use super::ranges::{Range, RangeRefusal, ordered};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The descent (paper, section 3.3 and appendix B).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct DescentConfig {
    /// Largest number of iterations. Default 40.
    #[schemars(range(min = 0, max = 1000))]
    pub iterations: u32,
    /// Finite-difference step, metres: large enough to cross a canopy's edge. Default 0.5.
    #[schemars(range(min = 0.001, max = 0.9))]
    pub difference_m: f64,
    /// Learning rate at the start, and its cap. Default 0.05.
    #[schemars(range(min = 0.000_001, max = 10.0))]
    pub rate: f64,
    /// Learning rate at which the descent stops. Default 0.001.
    #[schemars(range(min = 0.000_000_1, max = 10.0))]
    pub min_rate: f64,
    /// Largest displacement of a waypoint in one iteration, metres. Default 0.5.
    #[schemars(range(min = 0.01, max = 1.0))]
    pub max_move_m: f64,
}

impl Default for DescentConfig {
    fn default() -> Self {
        Self { iterations: 40, difference_m: 0.5, rate: 0.05, min_rate: 0.001, max_move_m: 0.5 }
    }
}

impl DescentConfig {
    pub(super) fn ranges(&self) -> [Range; 5] {
        [
            ("descent.iterations", f64::from(self.iterations), 0.0, 1000.0),
            ("descent.difference_m", self.difference_m, 0.001, 0.9),
            ("descent.rate", self.rate, 0.000_001, 10.0),
            ("descent.min_rate", self.min_rate, 0.000_000_1, 10.0),
            ("descent.max_move_m", self.max_move_m, 0.01, 1.0),
        ]
    }

    pub(super) fn check_order(&self) -> Result<(), RangeRefusal> {
        ordered(("descent.min_rate", self.min_rate), ("descent.rate", self.rate))
    }
}
