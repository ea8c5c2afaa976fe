//! [`SuiteTable`]: what a recipe says of the flights of its suite.

use cosfly_drone::models::MODELS;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

/// Fastest mean wind, m/s.
pub const MOST_WIND_MPS: f64 = 30.0;
/// Most blackouts of an episode.
pub const MOST_BLACKOUTS: u32 = 10;
/// Longest time from an observation to the effect of its action, milliseconds.
pub const MOST_LATENCY_MS: u32 = 5000;

/// Drone, air and latency of `cosfly fly` and of environments, where the command line does not say otherwise. Runs do not read the
/// table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SuiteTable {
    /// Drone that flies the episodes. Default `point-mass`.
    #[schemars(schema_with = "drones")]
    pub drone: String,
    /// Speed of the mean wind that moves a quadrotor, m/s; each episode draws its direction. Default 0.
    #[schemars(range(min = 0.0, max = MOST_WIND_MPS))]
    pub wind_mps: f64,
    /// Whether the wind carries gusts. Default false.
    pub gusts: bool,
    /// Number of stretches of an episode in which the camera sees nothing, each of two to four seconds. Default 0.
    #[schemars(range(min = 0, max = MOST_BLACKOUTS))]
    pub blackouts: u32,
    /// Time from an observation to the effect of the action that answers it, milliseconds. Default 0.
    #[schemars(range(min = 0, max = MOST_LATENCY_MS))]
    pub latency_ms: u32,
}

impl Default for SuiteTable {
    fn default() -> Self {
        Self { drone: MODELS[0].name.to_owned(), wind_mps: 0.0, gusts: false, blackouts: 0, latency_ms: 0 }
    }
}

fn drones(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "string", "enum": MODELS.iter().map(|model| model.name).collect::<Vec<_>>() })
}
