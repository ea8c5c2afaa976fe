//! Wanted position of the drone relative to its target.

use super::ranges::{Range, RangeRefusal, ordered};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Wanted position of the drone relative to its target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ViewConfig {
    /// Best distance from drone to the target's feet, metres. Default 28.
    #[schemars(range(min = 2.0, max = 200.0))]
    pub distance_m: f64,
    /// Best angle of the line of sight below the horizon, degrees. Default 45.
    #[schemars(range(min = 5.0, max = 85.0))]
    pub pitch_deg: f64,
    /// Altitude below which a strong penalty holds, metres above ground; the search starts here. Default 20.
    #[schemars(range(min = 0.5, max = 200.0))]
    pub min_altitude_m: f64,
    /// Altitude above which a light penalty holds, metres above ground. Default 20.
    #[schemars(range(min = 0.5, max = 200.0))]
    pub preferred_altitude_m: f64,
    /// Highest altitude that is searched, metres above ground. Default 40.
    #[schemars(range(min = 0.5, max = 400.0))]
    pub max_altitude_m: f64,
    /// Smallest horizontal distance that is searched, metres. Default 4.
    #[schemars(range(min = 0.5, max = 200.0))]
    pub min_radius_m: f64,
    /// Largest horizontal distance that is searched, metres. Default 38.
    #[schemars(range(min = 1.0, max = 400.0))]
    pub max_radius_m: f64,
    /// Distance from obstacles below which the soft safety cost acts, metres. Default 8.
    #[schemars(range(min = 0.1, max = 50.0))]
    pub safety_influence_m: f64,
    /// Half-angle of the sector behind the walker that is searched, degrees; 180 allows every side
    /// (the viewpoint weight still prefers the rear). Default 180.
    #[schemars(range(min = 10.0, max = 180.0))]
    pub rear_sector_deg: f64,
    /// Half-angle of the sector behind the walker in which flights start, degrees (paper: 60); 180 allows every side.
    /// Default 60.
    #[schemars(range(min = 10.0, max = 180.0))]
    pub start_sector_deg: f64,
}

impl Default for ViewConfig {
    fn default() -> Self {
        Self {
            distance_m: 28.0,
            pitch_deg: 45.0,
            min_altitude_m: 20.0,
            preferred_altitude_m: 20.0,
            max_altitude_m: 40.0,
            min_radius_m: 4.0,
            max_radius_m: 38.0,
            safety_influence_m: 8.0,
            rear_sector_deg: 180.0,
            start_sector_deg: 60.0,
        }
    }
}

impl ViewConfig {
    pub(super) fn ranges(&self) -> [Range; 10] {
        [
            ("view.distance_m", self.distance_m, 2.0, 200.0),
            ("view.pitch_deg", self.pitch_deg, 5.0, 85.0),
            ("view.min_altitude_m", self.min_altitude_m, 0.5, 200.0),
            ("view.preferred_altitude_m", self.preferred_altitude_m, 0.5, 200.0),
            ("view.max_altitude_m", self.max_altitude_m, 0.5, 400.0),
            ("view.min_radius_m", self.min_radius_m, 0.5, 200.0),
            ("view.max_radius_m", self.max_radius_m, 1.0, 400.0),
            ("view.safety_influence_m", self.safety_influence_m, 0.1, 50.0),
            ("view.rear_sector_deg", self.rear_sector_deg, 10.0, 180.0),
            ("view.start_sector_deg", self.start_sector_deg, 10.0, 180.0),
        ]
    }

    /// Bands must not be upside down.
    pub(super) fn check_order(&self) -> Result<(), RangeRefusal> {
        let min_altitude = ("view.min_altitude_m", self.min_altitude_m);
        let preferred_altitude = ("view.preferred_altitude_m", self.preferred_altitude_m);
        let max_altitude = ("view.max_altitude_m", self.max_altitude_m);
        ordered(min_altitude, max_altitude)?;
        ordered(min_altitude, preferred_altitude)?;
        ordered(preferred_altitude, max_altitude)?;
        ordered(("view.min_radius_m", self.min_radius_m), ("view.max_radius_m", self.max_radius_m))
    }
}
