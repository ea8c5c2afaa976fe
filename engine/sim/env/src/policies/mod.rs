//! Baselines: policies of our own to compare others with, one file each.
//!
//! To add one, write its file and add two lines here: its `mod` and its entry in [`BASELINES`].

mod causal;
mod constant_velocity;
mod expert;
mod follow;
mod hold;
mod plan;
mod random;
mod variation;

pub use plan::FollowedPlan;
pub use variation::Variation;

use crate::action::Action;
use crate::environment::Environment;
use cosfly_frames::DVec3;
use cosfly_planner::MucoConfig;
use std::sync::Arc;

/// Answers observations, one episode from its beginning.
pub trait Policy {
    /// Action for the present observation of an environment. A policy that is no expert reads its observation alone.
    fn act(&mut self, environment: &Environment) -> Action;
}

/// Knowledge of baselines about an episode, beside its environment.
#[derive(Clone)]
pub struct Knowledge {
    /// Waypoints of the expert's flight, one per frame of the target's track; empty where there is none. World frame, metres.
    pub flight: Arc<[DVec3]>,
    /// Parameters of the expert.
    pub config: Arc<MucoConfig>,
}

/// A baseline.
pub struct Baseline {
    /// Name on the command line.
    pub name: &'static str,
    /// Description, half a sentence.
    pub doc: &'static str,
    /// Inputs: `state`, `map` (boxes of the town), or `world`, which is more than a drone can know.
    pub sees: &'static [&'static str],
    /// The policy for the episode of an environment.
    pub make: fn(&Environment, &Knowledge) -> Box<dyn Policy + Send + Sync>,
}

/// All baselines, sorted by name.
pub const BASELINES: &[Baseline] = &[
    causal::BASELINE,
    constant_velocity::BASELINE,
    expert::BASELINE,
    follow::BASELINE,
    hold::BASELINE,
    random::BASELINE,
];

/// The baseline of a name.
pub fn baseline(name: &str) -> Option<&'static Baseline> {
    BASELINES.iter().find(|baseline| baseline.name == name)
}
