//! [`FlySettings`]: the table `[tool.fly]` of a recipe: the drone that flies its episodes, the air, the latency.

use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_drone::models::{self, DroneModel, MODELS};
use cosfly_env::{Blackouts, DroneSettings, EnvironmentSettings, SuiteTable};
use cosfly_recipe::Recipe;

/// Settings of the drone in a suite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlySettings {
    /// Model.
    pub drone: DroneModel,
    /// Speed of the mean wind, m/s.
    pub wind_mps: f64,
    /// Whether the wind carries gusts.
    pub gusts: bool,
    /// Number of stretches of an episode in which the camera sees nothing, each of two to four seconds.
    pub blackouts: u32,
    /// Time from an observation to the effect of the action that answers it, milliseconds.
    pub latency_ms: u32,
}

impl Default for FlySettings {
    fn default() -> Self {
        Self { drone: MODELS[0], wind_mps: 0.0, gusts: false, blackouts: 0, latency_ms: 0 }
    }
}

impl FlySettings {
    /// The table `[tool.fly]` of a recipe, whose keys and ranges the recipe's reader has checked.
    ///
    /// # Errors
    /// `fly-settings` where the values do not fit together.
    pub fn of(recipe: &Recipe) -> Result<Self> {
        let Some(table) = recipe.tool.get("fly") else { return Ok(Self::default()) };
        let refused = |message: String| {
            let message = format!("[tool.fly] of `{}`: {message}", recipe.path.display());
            Diagnostic::new("fly-settings", Fault::Recipe, message)
                .hint("choose a quadrotor, such as drone = \"pelican\"")
        };
        let given: SuiteTable = serde_json::from_value(table.clone()).map_err(|error| refused(error.to_string()))?;
        let drone = models::model(&given.drone).map_err(refused)?;
        if drone.parameters.is_none() && (given.wind_mps > 0.0 || given.gusts) {
            return Err(refused("wind does not move a point mass".to_owned()));
        }
        let SuiteTable { wind_mps, gusts, blackouts, latency_ms, .. } = given;
        Ok(Self { drone, wind_mps, gusts, blackouts, latency_ms })
    }
}

impl FlySettings {
    /// Settings of environments, with these of the suite.
    pub fn environment(&self) -> EnvironmentSettings {
        let defaults = EnvironmentSettings::default();
        let drone = DroneSettings { model: self.drone, wind_mps: self.wind_mps, gusts: self.gusts, sensors: false };
        let blackouts = Blackouts { count: self.blackouts, ..defaults.blackouts };
        EnvironmentSettings { drone, blackouts, latency_s: f64::from(self.latency_ms) / 1000.0, ..defaults }
    }
}
