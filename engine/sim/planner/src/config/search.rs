//! The global search for the start.

use super::ranges::Range;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The global search: a shortest path over a lattice of viewpoints around the moving target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SearchConfig {
    /// Effort of the search: `escalating` (the default) tries the fast lattice first, with half the altitudes, four
    /// fifths of the radii and twice the time between viewpoints, and the full one where that is not good enough.
    pub effort: SearchEffort,
    /// Directions around the target. Default 96.
    #[schemars(range(min = 8, max = 360))]
    pub azimuths: u32,
    /// Altitudes between the lowest and the highest. Default 8.
    #[schemars(range(min = 1, max = 8))]
    pub altitudes: u32,
    /// Horizontal distances between the smallest and the largest. Default 10.
    #[schemars(range(min = 1, max = 12))]
    pub radii: u32,
    /// Frames between searched viewpoints; those between are interpolated (paper: 5 to 10). At
    /// short time steps they are half a second apart at least. Default 1.
    #[schemars(range(min = 1, max = 10))]
    pub keyframe_frames: u32,
    /// Cost of moving relative to the target, per square metre and frame. Default 1.
    #[schemars(range(min = 0.001, max = 1000.0))]
    pub relative_motion: f64,
    /// Cost of moving at all, per square metre and frame. Default 1.2.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub absolute_motion: f64,
    /// Boxes further than this from the path (seen from above) are left out of planning, metres. Default 45.
    #[schemars(range(min = 5.0, max = 500.0))]
    pub filter_radius_m: f64,
}

/// Effort of the global search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SearchEffort {
    /// The fast lattice; the full one where it finds nothing, nothing valid, or too little visibility.
    #[default]
    Escalating,
    /// The fast lattice, and the full one only where it finds nothing valid.
    Fast,
    /// The full lattice at once.
    Quality,
}

impl Default for SearchConfig {
    fn default() -> Self {
        Self {
            effort: SearchEffort::Escalating,
            azimuths: 96,
            altitudes: 8,
            radii: 10,
            keyframe_frames: 1,
            relative_motion: 1.0,
            absolute_motion: 1.2,
            filter_radius_m: 45.0,
        }
    }
}

impl SearchConfig {
    pub(super) fn ranges(&self) -> [Range; 7] {
        [
            ("search.azimuths", f64::from(self.azimuths), 8.0, 360.0),
            ("search.altitudes", f64::from(self.altitudes), 1.0, 8.0),
            ("search.radii", f64::from(self.radii), 1.0, 12.0),
            ("search.keyframe_frames", f64::from(self.keyframe_frames), 1.0, 10.0),
            ("search.relative_motion", self.relative_motion, 0.001, 1000.0),
            ("search.absolute_motion", self.absolute_motion, 0.0, 1000.0),
            ("search.filter_radius_m", self.filter_radius_m, 5.0, 500.0),
        ]
    }
}
