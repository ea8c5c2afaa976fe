//! Baselines as pilots.

use super::seam::{Failure, Pilot};
use cosfly_env::policies::{Knowledge, baseline};
use cosfly_env::{Action, Environment, Policy};

/// A baseline.
pub struct BaselinePilot {
    name: &'static str,
    policy: Option<Box<dyn Policy + Send + Sync>>,
}

impl BaselinePilot {
    /// The baseline of a name.
    pub fn new(name: &'static str) -> Self {
        Self { name, policy: None }
    }
}

impl Pilot for BaselinePilot {
    fn begin(&mut self, environment: &Environment, knowledge: &Knowledge) -> Result<(), String> {
        self.policy = baseline(self.name).map(|baseline| (baseline.make)(environment, knowledge));
        Ok(())
    }

    fn act(&mut self, environment: &Environment) -> Result<Action, Failure> {
        let policy = self.policy.as_mut().ok_or_else(|| Failure::Gone("the episode was not begun".to_owned()))?;
        Ok(policy.act(environment))
    }
}
