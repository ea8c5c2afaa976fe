//! Limits that a flight must never exceed.

use super::ranges::Range;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Rates of yaw and pitch that are allowed unless the recipe says otherwise, degrees per second.
pub(super) const VIEW_RATE_DEG_S: f64 = 60.0;

/// Limits that a flight must never exceed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LimitsConfig {
    /// Smallest distance from obstacles along the whole swept path, metres. Default 1.5.
    #[schemars(range(min = 0.1, max = 10.0))]
    pub clearance_m: f64,
    /// Largest speed, m/s. Default 12.
    #[schemars(range(min = 0.5, max = 50.0))]
    pub speed_mps: f64,
    /// Largest acceleration, m/s^2. Default 6.
    #[schemars(range(min = 0.1, max = 100.0))]
    pub acceleration_mps2: f64,
    /// Largest jerk, m/s^3. Default 12.
    #[schemars(range(min = 0.1, max = 1000.0))]
    pub jerk_mps3: f64,
    /// Largest yaw rate of the camera, degrees per second from frame to frame. Default 60; with `preset = "paper"` no limit.
    #[schemars(range(min = 1.0, max = 3600.0))]
    pub yaw_rate_deg_s: Option<f64>,
    /// Largest pitch rate of the camera, degrees per second from frame to frame. Default 60; with `preset = "paper"` no limit.
    #[schemars(range(min = 1.0, max = 3600.0))]
    pub pitch_rate_deg_s: Option<f64>,
    /// Reject flights beyond the limits of speed, acceleration, jerk, yaw rate or pitch rate; if false they are published
    /// with the violation in their certificate. Clearance is always required. Default true.
    pub require_kinematics: bool,
}

impl Default for LimitsConfig {
    fn default() -> Self {
        Self {
            clearance_m: 1.5,
            speed_mps: 12.0,
            acceleration_mps2: 6.0,
            jerk_mps3: 12.0,
            yaw_rate_deg_s: None,
            pitch_rate_deg_s: None,
            require_kinematics: true,
        }
    }
}

impl LimitsConfig {
    pub(super) fn ranges(&self) -> [Range; 6] {
        [
            ("limits.clearance_m", self.clearance_m, 0.1, 10.0),
            ("limits.speed_mps", self.speed_mps, 0.5, 50.0),
            ("limits.acceleration_mps2", self.acceleration_mps2, 0.1, 100.0),
            ("limits.jerk_mps3", self.jerk_mps3, 0.1, 1000.0),
            ("limits.yaw_rate_deg_s", self.yaw_rate_deg_s.unwrap_or(VIEW_RATE_DEG_S), 1.0, 3600.0),
            ("limits.pitch_rate_deg_s", self.pitch_rate_deg_s.unwrap_or(VIEW_RATE_DEG_S), 1.0, 3600.0),
        ]
    }
}
