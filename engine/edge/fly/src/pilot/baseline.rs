//! Baselines as pilots.

use super::seam::{Pilot, PilotFailure};
use cosfly_env::policies::{Knowledge, Variation, baseline};
use cosfly_env::{Action, Environment, Policy};

/// A baseline.
pub struct BaselinePilot {
    name: &'static str,
    variation: Variation,
    policy: Option<Box<dyn Policy + Send + Sync>>,
}

impl BaselinePilot {
    /// The baseline of a name, with changes.
    pub fn new(name: &'static str, variation: Variation) -> Self {
        Self { name, variation, policy: None }
    }
}

impl Pilot for BaselinePilot {
    fn begin(&mut self, environment: &Environment, knowledge: &Knowledge) -> Result<(), String> {
        self.policy = baseline(self.name).map(|baseline| self.variation.of(baseline, environment, knowledge));
        Ok(())
    }

    fn act(&mut self, environment: &Environment) -> Result<Action, PilotFailure> {
        let policy = self.policy.as_mut().ok_or_else(|| PilotFailure::Gone("the episode was not begun".to_owned()))?;
        Ok(policy.act(environment))
    }
}
