//! Parameters of the toy stage kinds.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Places where streets are crossed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Crossing {
    /// Anywhere.
    #[default]
    Free,
    /// Only where the ground is painted.
    ZebraOnly,
}

/// Either a fixed number or a range, told apart by `kind`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Pause {
    /// Never stops.
    None,
    /// Stops at random.
    Random {
        /// Chance of a stop per second.
        #[schemars(range(min = 0.0, max = 1.0))]
        chance: f64,
    },
}

/// Walking speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Speed {
    /// Slowest speed.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub min_mps: f64,
    /// Fastest speed. Not below the slowest.
    #[schemars(range(max = 10.0))]
    pub max_mps: f64,
}

impl Default for Speed {
    fn default() -> Self {
        Self { min_mps: 0.5, max_mps: 2.0 }
    }
}

/// Parameters of the toy walkers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct WalkersConfig {
    /// Number of paths. Asking for more renames none.
    #[schemars(range(min = 1))]
    pub count: u64,
    /// Distance kept from obstacles.
    #[schemars(range(min = 0.0))]
    pub margin_m: f64,
    /// Walking speed.
    pub speed: Speed,
    /// Places where streets are crossed.
    pub crossing: Crossing,
    /// Stops on the way.
    pub pause: Pause,
    /// A colour as red, green, blue.
    pub colour: Option<[u8; 3]>,
    /// Waypoints that every path visits.
    #[schemars(length(max = 3))]
    pub visits: Vec<Speed>,
    /// Name of the crowd.
    #[schemars(length(min = 1))]
    pub crowd: String,
    /// Version of the crowd, such as `1.0`.
    #[schemars(regex(pattern = r"^[0-9]+\.[0-9]+$"))]
    pub version: String,
    /// Shares by age.
    pub shares: BTreeMap<String, f64>,
    /// True for people who look around.
    pub curious: bool,
}

impl Default for WalkersConfig {
    fn default() -> Self {
        Self {
            count: 4,
            margin_m: 0.5,
            speed: Speed::default(),
            crossing: Crossing::Free,
            pause: Pause::None,
            colour: None,
            visits: vec![],
            crowd: "people".into(),
            version: "1.0".into(),
            shares: BTreeMap::new(),
            curious: false,
        }
    }
}

/// Parameters of the toy map.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MapConfig {
    /// The town's file.
    #[schemars(length(min = 1))]
    pub source: String,
}

/// No parameters.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NoConfig {}

/// A file that is optional in the schema.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TracksConfig {
    /// The tracks. Default "".
    pub file: String,
}
