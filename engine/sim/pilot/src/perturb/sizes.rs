//! Sizes of departures: of jumps, and of perturbations that a drone could fly.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Probabilities, lengths and limits of kind `jumps`.
#[derive(Clone, Copy)]
pub struct JumpSizes<'a> {
    /// Probability per frame that drone and aim are displaced.
    pub position_probability: f64,
    /// Probability per frame that the view is turned.
    pub rotation_probability: f64,
    /// Length of the drone's displacement.
    pub drone_offset: &'a OffsetRange,
    /// Length of the displacement of the point aimed at.
    pub aim_offset: &'a OffsetRange,
    /// Largest turn of the view, degrees.
    pub max_rotation_deg: f64,
    /// Distance from obstacles that displaced drones keep, metres.
    pub clearance_m: f64,
    /// Height above the target's feet that displaced drones keep, metres.
    pub min_height_m: f64,
}

/// Length of a displacement, drawn uniformly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OffsetRange {
    /// Smallest, metres. Default 2.
    #[schemars(range(min = 0.0, max = 50.0))]
    pub min_m: f64,
    /// Largest, metres. Default 3.
    #[schemars(range(min = 0.0, max = 50.0))]
    pub max_m: f64,
}

impl Default for OffsetRange {
    fn default() -> Self {
        Self { min_m: 2.0, max_m: 3.0 }
    }
}

/// Sizes and limits of perturbations that a drone could fly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FlyableConfig {
    /// All kinds that a drone could fly: standard deviation of the drift along each horizontal axis, metres; along the vertical
    /// axis it is 0.4 times as large. With 0 the twins of kinds `aim` and `search` fly the expert's own way. Default 2.5.
    #[schemars(range(min = 0.0, max = 20.0))]
    pub drift_m: f64,
    /// Time constant of the drift, seconds. Default 6.
    #[schemars(range(min = 0.5, max = 1000.0))]
    pub drift_s: f64,
    /// Kind `gusts`: mean time from the end of a gust to the next one, seconds. Default 8.
    #[schemars(range(min = 1.0, max = 1000.0))]
    pub gust_every_s: f64,
    /// Kind `gusts`: largest acceleration by a gust, m/s^2; the smallest is a third of it. Default 4.
    #[schemars(range(min = 0.0, max = 20.0))]
    pub gust_mps2: f64,
    /// Kind `timing`: standard deviation of the time by which the drone is early or late, seconds. Default 0.8.
    #[schemars(range(min = 0.0, max = 5.0))]
    pub timing_s: f64,
    /// Kind `aim`: mean time by which the aim is late, seconds. Default 1.
    #[schemars(range(min = 0.0, max = 3.0))]
    pub aim_lag_s: f64,
    /// Kind `aim`: standard deviation of the aim, degrees, along each axis of the picture. Default 9.
    #[schemars(range(min = 0.0, max = 30.0))]
    pub aim_deg: f64,
    /// Kind `search`: mean time from the end of a search to the next loss, seconds. Default 12.
    #[schemars(range(min = 1.0, max = 1000.0))]
    pub search_every_s: f64,
    /// Kind `search`: longest time from a loss until the camera returns, seconds; the shortest is half of it. Default 6.
    #[schemars(range(min = 1.0, max = 60.0))]
    pub search_s: f64,
    /// Kind `search`: angle to both sides by which the camera looks for the target, degrees. Default 35.
    #[schemars(range(min = 0.0, max = 180.0))]
    pub search_deg: f64,
    /// Largest speed, m/s: displacements that lead beyond it are made smaller, and the certificate states it. Default 14.
    #[schemars(range(min = 0.1, max = 100.0))]
    pub max_speed_mps: f64,
    /// Largest acceleration, m/s^2, in the same way. Default 9.
    #[schemars(range(min = 0.1, max = 100.0))]
    pub max_acceleration_mps2: f64,
    /// Largest rate of yaw and of pitch, degrees/s. Default 60.
    #[schemars(range(min = 5.0, max = 1000.0))]
    pub max_rate_deg_s: f64,
}

impl Default for FlyableConfig {
    fn default() -> Self {
        Self {
            drift_m: 2.5,
            drift_s: 6.0,
            gust_every_s: 8.0,
            gust_mps2: 4.0,
            timing_s: 0.8,
            aim_lag_s: 1.0,
            aim_deg: 9.0,
            search_every_s: 12.0,
            search_s: 6.0,
            search_deg: 35.0,
            max_speed_mps: 14.0,
            max_acceleration_mps2: 9.0,
            max_rate_deg_s: 60.0,
        }
    }
}

impl FlyableConfig {
    /// Path, value, and the ends of its range, of every number.
    pub(super) fn ranges(&self) -> [(&'static str, f64, f64, f64); 13] {
        [
            ("flyable.drift_m", self.drift_m, 0.0, 20.0),
            ("flyable.drift_s", self.drift_s, 0.5, 1000.0),
            ("flyable.gust_every_s", self.gust_every_s, 1.0, 1000.0),
            ("flyable.gust_mps2", self.gust_mps2, 0.0, 20.0),
            ("flyable.timing_s", self.timing_s, 0.0, 5.0),
            ("flyable.aim_lag_s", self.aim_lag_s, 0.0, 3.0),
            ("flyable.aim_deg", self.aim_deg, 0.0, 30.0),
            ("flyable.search_every_s", self.search_every_s, 1.0, 1000.0),
            ("flyable.search_s", self.search_s, 1.0, 60.0),
            ("flyable.search_deg", self.search_deg, 0.0, 180.0),
            ("flyable.max_speed_mps", self.max_speed_mps, 0.1, 100.0),
            ("flyable.max_acceleration_mps2", self.max_acceleration_mps2, 0.1, 100.0),
            ("flyable.max_rate_deg_s", self.max_rate_deg_s, 5.0, 1000.0),
        ]
    }
}
