//! [`RecordedConfig`]: how a file of tracks is read and placed in a town.

use crate::{HeightRange, PedestrianConfigRule, RadiusRange};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Formats of recorded tracks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RecordedFormat {
    /// GPX tracks whose points have times.
    Gpx,
    /// GeoJSON: line strings with `coordTimes`, `times` or `coordinateProperties.times`, or points with `time` and `id`.
    Geojson,
    /// ETH and UCY matrices: frame, id, x, z, y and velocities, metres.
    Obsmat,
    /// Columns `t`, `id`, `x`, `y`, metres, between commas, semicolons or white space; other columns need a header.
    Csv,
}

impl RecordedFormat {
    /// The format that the first characters show.
    pub(crate) fn recognised(text: &str) -> Self {
        let start = text.trim_start();
        let first_line = start.lines().next().unwrap_or_default();
        match start.chars().next() {
            Some('<') => Self::Gpx,
            Some('{' | '[') => Self::Geojson,
            _ if first_line.contains([',', ';']) || first_line.split_whitespace().count() != 8 => Self::Csv,
            _ => Self::Obsmat,
        }
    }
}

/// Recorded people: format, clock, place in the town, bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("x-gone" = { "fastest_mps": "write `max_speed_mps`", "longest_gap_s": "write `max_gap_s`" }))]
pub struct RecordedConfig {
    /// Format of the file. Without it, the content decides.
    pub format: Option<RecordedFormat>,
    /// Frames in a second, where times are frame numbers: of `obsmat` files 25 where it is left out; without it, times of CSV
    /// files are seconds.
    #[schemars(range(min = 0.001, max = 10_000.0))]
    pub rate_hz: Option<f64>,
    /// Time of the recording at the first frame, seconds after its first point. Default 0.
    #[schemars(range(min = 0.0, max = 1e9))]
    pub start_s: f64,
    /// World place of the recording's origin: x, y, metres. For files in metres. Default [0, 0].
    pub origin_m: [f64; 2],
    /// Turn of the recording about its origin from x towards y of the world, degrees. For files in metres. Default 0.
    #[schemars(range(min = -360.0, max = 360.0))]
    pub turn_deg: f64,
    /// Whether y of the recording is to the left of x, as on paper; the world has y to the right. For files in metres. Default true.
    pub y_is_left: bool,
    /// Nobody is faster, m/s: at a jump the track is parted, and the person is two people. Default 8.
    #[schemars(range(min = 0.1, max = 100.0))]
    pub max_speed_mps: f64,
    /// Longest time between two points of one track, seconds: at a longer gap the track is parted. Default 30.
    #[schemars(range(min = 0.01, max = 3600.0))]
    pub max_gap_s: f64,
    /// Body height.
    pub height: HeightRange,
    /// Body radius seen from above, at most: where two recorded people come nearer, their radii are smaller.
    pub radius: RadiusRange,
}

impl Default for RecordedConfig {
    fn default() -> Self {
        Self {
            format: None,
            rate_hz: None,
            start_s: 0.0,
            origin_m: [0.0, 0.0],
            turn_deg: 0.0,
            y_is_left: true,
            max_speed_mps: 8.0,
            max_gap_s: 30.0,
            height: HeightRange::default(),
            radius: RadiusRange::default(),
        }
    }
}

impl RecordedConfig {
    /// Checks the ranges and the rules between values.
    ///
    /// # Errors
    /// The first broken rule.
    pub fn check(&self) -> Result<(), PedestrianConfigRule> {
        let far_m = 1e7;
        let numbers: [(&'static [&'static str], f64, f64, f64); 11] = [
            (&["rate_hz"], self.rate_hz.unwrap_or(1.0), 0.001, 10_000.0),
            (&["start_s"], self.start_s, 0.0, 1e9),
            (&["origin_m"], self.origin_m[0], -far_m, far_m),
            (&["origin_m"], self.origin_m[1], -far_m, far_m),
            (&["turn_deg"], self.turn_deg, -360.0, 360.0),
            (&["max_speed_mps"], self.max_speed_mps, 0.1, 100.0),
            (&["max_gap_s"], self.max_gap_s, 0.01, 3600.0),
            (&["height", "min_m"], self.height.min_m, 0.5, 3.0),
            (&["height", "max_m"], self.height.max_m, 0.5, 3.0),
            (&["radius", "min_m"], self.radius.min_m, 0.05, 2.0),
            (&["radius", "max_m"], self.radius.max_m, 0.05, 2.0),
        ];
        for (path, value, min, max) in numbers {
            PedestrianConfigRule::within(path, value, min, max)?;
        }
        PedestrianConfigRule::in_order(&["height", "min_m"], self.height.min_m, "max_m", self.height.max_m)?;
        PedestrianConfigRule::in_order(&["radius", "min_m"], self.radius.min_m, "max_m", self.radius.max_m)
    }
}
