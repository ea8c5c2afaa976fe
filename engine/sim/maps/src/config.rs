//! [`MapConfig`]: what a recipe says about a map.

use crate::fill::FillConfig;
use crate::simplify::SimplifyConfig;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How a map file becomes a town.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MapConfig {
    /// The map file, relative to the recipe. OpenDRIVE (`.xodr`).
    pub source: String,
    /// Name of the town in all metadata and of its folder: letters, digits, `.`, `_`, `-`. Default: the file's name without its extension.
    pub name: Option<String>,
    /// Let pedestrians use road shoulders in a town that has no pavements. Off by default: such a town is refused.
    pub shoulders_as_sidewalks: bool,
    /// Make poles and plates of the file's signals (signs and traffic lights). On by default.
    pub signals: bool,
    /// Paint lane lines and crossings. On by default.
    pub road_marks: bool,
    /// Let pedestrians cross the carriageway where a junction arm has pavements but no marked crossing, and join
    /// parts of the walkable ground that are at most 25 m apart (all flagged as synthetic). On by default.
    pub unmarked_crossings: bool,
    /// Longest piece of road surface in one quad, metres; bends are cut finer by themselves. 0.5 to 1000, default 50.
    #[schemars(range(min = 0.5, max = 1000.0))]
    pub sample_step_m: f64,
    /// What to invent beside the streets of a town whose file has nothing there. Nothing by default.
    pub fill: FillConfig,
    /// Merge, crop and prune of the boxes that the planner sees.
    pub simplify: SimplifyConfig,
}

impl Default for MapConfig {
    fn default() -> Self {
        Self {
            source: String::new(),
            name: None,
            shoulders_as_sidewalks: false,
            signals: true,
            road_marks: true,
            unmarked_crossings: true,
            sample_step_m: 50.0,
            fill: FillConfig::default(),
            simplify: SimplifyConfig::default(),
        }
    }
}
