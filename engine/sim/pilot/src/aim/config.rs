//! Parameters of the aim, their defaults and ranges.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Aim of the camera at the target. The defaults are a pilot's; `framing_deg`, `tremor_deg`, `lag_s` and `lag_deviation_s` of 0
/// keep the target exactly in the middle of the picture, as the paper's experts do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("x-gone" = { "lag_spread_s": "write `lag_deviation_s`" }))]
pub struct AimConfig {
    /// Standard deviation of the framing, degrees, along each axis of the picture: the slow wander of the optical axis away
    /// from the target (an Ornstein-Uhlenbeck process, smoothed so that its rate is continuous). Default 8.5.
    #[schemars(range(min = 0.0, max = 30.0))]
    pub framing_deg: f64,
    /// Time constant of the framing, seconds. Default 20.
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub framing_s: f64,
    /// Standard deviation of the quick error of the aim, degrees, along each axis of the picture; its time constant is 1 s.
    /// Default 0.2.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub tremor_deg: f64,
    /// Mean time by which the aim is behind the target, seconds; negative values lead. Default 0.3.
    #[schemars(range(min = -3.0, max = 3.0))]
    pub lag_s: f64,
    /// Standard deviation of that time, seconds: above `lag_s` the aim leads at times. Default 0.2.
    #[schemars(range(min = 0.0, max = 3.0))]
    pub lag_deviation_s: f64,
    /// Largest angle of framing and quick error together, degrees. Default 18.
    #[schemars(range(min = 0.0, max = 45.0))]
    pub max_deg: f64,
    /// Largest rate of yaw and of pitch, degrees/s. Default 60.
    #[schemars(range(min = 5.0, max = 1000.0))]
    pub max_rate_deg_s: f64,
}

impl Default for AimConfig {
    fn default() -> Self {
        Self {
            framing_deg: 8.5,
            framing_s: 20.0,
            tremor_deg: 0.2,
            lag_s: 0.3,
            lag_deviation_s: 0.2,
            max_deg: 18.0,
            max_rate_deg_s: 60.0,
        }
    }
}

impl AimConfig {
    /// An aim that keeps the target exactly in the middle of the picture.
    pub fn exact() -> Self {
        let none = Self { framing_deg: 0.0, tremor_deg: 0.0, lag_s: 0.0, lag_deviation_s: 0.0, ..Self::default() };
        Self { max_rate_deg_s: 1000.0, ..none }
    }

    /// Refuses values out of range: (path of the parameter, what is wrong).
    pub fn validate(&self) -> Result<(), (String, String)> {
        for (path, value, low, high) in [
            ("framing_deg", self.framing_deg, 0.0, 30.0),
            ("framing_s", self.framing_s, 0.1, 1000.0),
            ("tremor_deg", self.tremor_deg, 0.0, 10.0),
            ("lag_s", self.lag_s, -3.0, 3.0),
            ("lag_deviation_s", self.lag_deviation_s, 0.0, 3.0),
            ("max_deg", self.max_deg, 0.0, 45.0),
            ("max_rate_deg_s", self.max_rate_deg_s, 5.0, 1000.0),
        ] {
            if !(low..=high).contains(&value) {
                return Err((path.to_owned(), format!("`{path}` is {value}; it must be between {low} and {high}")));
            }
        }
        Ok(())
    }
}
