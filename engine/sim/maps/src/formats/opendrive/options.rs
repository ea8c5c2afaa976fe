//! Options of OpenDRIVE maps.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Options of OpenDRIVE maps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OpenDriveOptions {
    /// Let pedestrians use road shoulders beside pavements, too. Off by default; a town that has no pavements lets them
    /// use its shoulders anyway (`assume_ground`).
    pub shoulders_as_sidewalks: bool,
    /// Let pedestrians of a town that has no pavements use its shoulders; where it has none either, invent pavements of
    /// 2 m beside the carriageways. On by default; off, such a town is refused.
    pub assume_ground: bool,
    /// Make poles and plates of the file's signals (signs and traffic lights). On by default.
    pub signals: bool,
    /// Paint lane lines and crossings. On by default.
    pub road_marks: bool,
    /// Let pedestrians cross the carriageway where a junction arm has pavements but no marked crossing, and join
    /// parts of the walkable ground that are at most 25 m apart (all flagged as synthetic). On by default.
    pub unmarked_crossings: bool,
    /// Roofs of the buildings that have an outline. The format has no roofs. `auto`, the default: as `pitched` in
    /// georeferenced maps, as surveys state the height of the eaves, else as `flat`.
    pub roofs: Roofs,
    /// Longest piece of road surface in one quad, metres; bends are cut finer by themselves. 0.5 to 1000, default 50.
    #[schemars(range(min = 0.5, max = 1000.0))]
    pub sample_step_m: f64,
}

/// Roofs of buildings whose file gives outlines and heights only.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Roofs {
    /// `pitched` in georeferenced maps, else `flat`.
    #[default]
    Auto,
    /// Buildings end level at their stated height.
    Flat,
    /// A gable of 45 degrees, at most 8 m high, stands on the stated height of buildings at least 2.5 m high with
    /// wings 4 to 20 m wide; where wings meet, planes rise from every wall. The guess is noted in `synthetic_notes`.
    Pitched,
}

impl Default for OpenDriveOptions {
    fn default() -> Self {
        Self {
            shoulders_as_sidewalks: false,
            assume_ground: true,
            signals: true,
            road_marks: true,
            unmarked_crossings: true,
            roofs: Roofs::default(),
            sample_step_m: 50.0,
        }
    }
}
