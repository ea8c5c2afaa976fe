//! Additions to a town whose file has streets and nothing beside them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Seeded buildings, street trees and lamps on the land beside the streets. Everything made here is flagged as
/// synthetic in all metadata.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FillConfig {
    /// Whether to put up buildings along the streets, pavements first, then roads within about 50 m of one. Off by default.
    pub buildings: bool,
    /// Whether to plant trees just beyond the pavements' outer edge. Off by default.
    pub trees: bool,
    /// Whether to put lamps just beyond the pavements' outer edge. Off by default.
    pub lamps: bool,
    /// Share of the lots that get a building; the rest stay open. 0 to 1, default 0.9.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub building_density: f64,
    /// Lowest building, metres. 3 to 300, default 8.
    #[schemars(range(min = 3.0, max = 300.0))]
    pub min_height_m: f64,
    /// Highest building, metres; not below `min_height_m`. 3 to 300, default 30.
    #[schemars(range(min = 3.0, max = 300.0))]
    pub max_height_m: f64,
    /// Smallest gap between a pavement's edge and the building behind it, metres; at bends and crossing streets up to
    /// 0.4 m less. 0.5 to 50, default 1.
    #[schemars(range(min = 0.5, max = 50.0))]
    pub min_setback_m: f64,
    /// Largest gap between a pavement's edge and the building behind it, metres. 0.5 to 50, default 4.
    #[schemars(range(min = 0.5, max = 50.0))]
    pub max_setback_m: f64,
    /// Least distance between street trees, metres. 3 to 1000, default 10.
    #[schemars(range(min = 3.0, max = 1000.0))]
    pub tree_spacing_m: f64,
    /// Least distance between lamps, metres. 3 to 1000, default 28.
    #[schemars(range(min = 3.0, max = 1000.0))]
    pub lamp_spacing_m: f64,
}

impl Default for FillConfig {
    fn default() -> Self {
        Self {
            buildings: false,
            trees: false,
            lamps: false,
            building_density: 0.9,
            min_height_m: 8.0,
            max_height_m: 30.0,
            min_setback_m: 1.0,
            max_setback_m: 4.0,
            tree_spacing_m: 10.0,
            lamp_spacing_m: 28.0,
        }
    }
}

impl FillConfig {
    /// Whether anything is to be invented.
    pub fn is_on(&self) -> bool {
        self.buildings || self.trees || self.lamps
    }
}
