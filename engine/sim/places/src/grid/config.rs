//! Size and density of a generated town.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A downtown of our own: a loose grid of streets with curves, buildings, trees and furniture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct GenerateConfig {
    /// Streets that run north-south. 4 to 12, default 5.
    #[schemars(range(min = 4, max = 12))]
    pub columns: u32,
    /// Streets that run east-west. 4 to 12, default 5.
    #[schemars(range(min = 4, max = 12))]
    pub rows: u32,
    /// Smallest distance between neighbouring streets, metres. 60 to 300, default 68.
    #[schemars(range(min = 60.0, max = 300.0))]
    pub min_spacing_m: f64,
    /// Largest distance between neighbouring streets, metres. 60 to 300, default 90.
    #[schemars(range(min = 60.0, max = 300.0))]
    pub max_spacing_m: f64,
    /// Share of the lots that carry a building. 0 to 1, default 0.92.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub building_density: f64,
    /// Share of the pavements that are lined with trees. 0 to 1, default 0.85.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub tree_density: f64,
    /// Lowest building, metres. 3 to 300, default 8.
    #[schemars(range(min = 3.0, max = 300.0))]
    pub min_height_m: f64,
    /// Highest building, metres. 3 to 300, default 45.
    #[schemars(range(min = 3.0, max = 300.0))]
    pub max_height_m: f64,
}

impl Default for GenerateConfig {
    fn default() -> Self {
        Self {
            columns: 5,
            rows: 5,
            min_spacing_m: 68.0,
            max_spacing_m: 90.0,
            building_density: 0.92,
            tree_density: 0.85,
            min_height_m: 8.0,
            max_height_m: 45.0,
        }
    }
}

impl GenerateConfig {
    /// Configuration with every value inside its range and no range upside down, so that generation cannot fail.
    pub fn clamped(&self) -> Self {
        let finite = |value: f64, low: f64, high: f64| if value.is_nan() { low } else { value.clamp(low, high) };
        let min_spacing_m = finite(self.min_spacing_m, 60.0, 300.0);
        let min_height_m = finite(self.min_height_m, 3.0, 300.0);
        Self {
            columns: self.columns.clamp(4, 12),
            rows: self.rows.clamp(4, 12),
            min_spacing_m,
            max_spacing_m: finite(self.max_spacing_m, min_spacing_m, 300.0),
            building_density: finite(self.building_density, 0.0, 1.0),
            tree_density: finite(self.tree_density, 0.0, 1.0),
            min_height_m,
            max_height_m: finite(self.max_height_m, min_height_m, 300.0),
        }
    }
}
