//! [`OsmOptions`]: what a recipe may say about OpenStreetMap files.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Options of OpenStreetMap files.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OsmOptions {
    /// Height of a building with neither height nor storeys, metres; garages, sheds and kiosks get at most 3 m. 2 to 100, default 8.
    #[schemars(range(min = 2.0, max = 100.0))]
    pub default_building_height_m: f64,
    /// Height of one storey, where a building states its storeys and no height, metres. 2 to 6, default 3.
    #[schemars(range(min = 2.0, max = 6.0))]
    pub storey_height_m: f64,
    /// Whether to invent pavements on both sides of every street whose file says nothing of pavements. Off by default; a
    /// file with no ground for people at all gets them anyway.
    pub assume_pavements: bool,
    /// Whether traffic keeps to the left, as in Britain, Japan, India or Singapore; files do not say. Default false.
    pub left_hand_traffic: bool,
}

impl Default for OsmOptions {
    fn default() -> Self {
        Self { default_building_height_m: 8.0, storey_height_m: 3.0, assume_pavements: false, left_hand_traffic: false }
    }
}
