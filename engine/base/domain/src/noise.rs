//! [`Noise`] of a sensor: read noise of equal strength everywhere, and shot noise that grows with brightness.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Noise of the sensor on colour, with deviation `sqrt(gaussian^2 + shot^2 v / 255)` at code `v`; drawn anew per frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Noise {
    /// Standard deviation everywhere, steps of 8-bit colour; 0: none.
    #[schemars(range(min = 0, max = 64))]
    pub gaussian: f64,
    /// Standard deviation at white, steps of 8-bit colour; falls with the root of brightness; 0: none.
    #[schemars(range(min = 0, max = 64))]
    pub shot: f64,
}

impl Noise {
    /// Whether it adds nothing.
    pub fn is_none(&self) -> bool {
        self.gaussian == 0.0 && self.shot == 0.0
    }
}
