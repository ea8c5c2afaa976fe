//! Outcome of planning a flight.

use crate::flight::Flight;
use crate::world::World;
use cosfly_domain::PlanOutcome;
use cosfly_frames::TargetTrack;
use cosfly_objectives::config::DT_S;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Outcome of a flight, with notes by name and warnings.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Flown {
    /// The flight, or the reason why there is none.
    pub outcome: PlanOutcome,
    /// Notes, by name.
    pub notes: BTreeMap<String, String>,
    /// Warnings.
    pub warnings: Vec<String>,
}

impl Flown {
    /// Plans a flight.
    ///
    /// # Errors
    /// Failures of a plugin.
    pub fn of(flight: &Flight, world: &Arc<World>) -> cosfly_diagnose::Result<Self> {
        let (outcome, said) = flight.plan(world)?;
        let (notes, mut warnings) = match &outcome {
            PlanOutcome::Planned(trajectory) => flight.findings(world, trajectory),
            PlanOutcome::Rejected { .. } => Default::default(),
        };
        warnings.extend(said);
        Ok(Self { outcome, notes, warnings })
    }

    /// No flight, for a reason.
    pub fn none(reason: &str) -> Self {
        let track = TargetTrack { dt_s: DT_S, height_m: 0.0, radius_m: 0.0, states: vec![] };
        let outcome = PlanOutcome::Rejected { track, reason: reason.to_owned() };
        Self { outcome, notes: BTreeMap::new(), warnings: vec![] }
    }
}
