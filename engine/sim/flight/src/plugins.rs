//! Cost terms and objectives that others made, as a flight uses them.

use crate::world::World;
use cosfly_diagnose::Result;
use cosfly_frames::Seed;
use cosfly_objectives::reference::Reference;
use cosfly_planner::{MucoConfig, WeightedTerm};
use std::sync::Arc;

/// Reference drawn by an objective's plugin.
pub struct DrawnReference {
    /// Places to be at, and points to look at.
    pub reference: Reference,
    /// Notes for the summary.
    pub notes: Vec<(String, String)>,
    /// Warnings of the plugin.
    pub warnings: Vec<String>,
}

/// Terms of one flight.
pub struct OpenTerms {
    /// The terms.
    pub terms: Vec<WeightedTerm>,
    /// Their warnings for users after planning, or the first failure of a term, which makes the flight invalid.
    pub warnings: Box<dyn FnOnce() -> Result<Vec<String>>>,
}

/// Plugins of an expert.
pub trait FlightPlugins: Send + Sync {
    /// New instances of all terms, for one flight.
    ///
    /// # Errors
    /// Failures of a plugin.
    fn open_terms(&self, world: &Arc<World>, seed: Seed) -> Result<OpenTerms>;

    /// Reference that the objective draws within `bounds` (least x, least y, most x, most y, metres); `Err` inside is its own
    /// reason why there is nothing to fly.
    ///
    /// # Errors
    /// Failures of the plugin.
    fn draw_reference(
        &self,
        world: &Arc<World>,
        config: &MucoConfig,
        bounds: [f64; 4],
        seed: Seed,
    ) -> Result<std::result::Result<DrawnReference, String>>;
}

/// No plugins.
pub struct NoPlugins;

impl FlightPlugins for NoPlugins {
    fn open_terms(&self, _: &Arc<World>, _: Seed) -> Result<OpenTerms> {
        Ok(OpenTerms { terms: vec![], warnings: Box::new(|| Ok(vec![])) })
    }

    fn draw_reference(
        &self,
        _: &Arc<World>,
        _: &MucoConfig,
        _: [f64; 4],
        _: Seed,
    ) -> Result<std::result::Result<DrawnReference, String>> {
        Ok(Err("no plugin is given".to_owned()))
    }
}
