//! Surroundings among which the flights of an item are planned, and the notes on them.

use crate::{companions, traffic};
use cosfly_diagnose::Result;
use cosfly_domain::{Around, PlanOutcome};
use cosfly_experts::world::{check_same_town, world};
use cosfly_experts::{RecipeExpert, artifacts};
use cosfly_flight::{MovingBodies, World};
use cosfly_objectives::Objective;
use cosfly_stage::{Inputs, Produced};
use std::sync::Arc;

/// Surroundings among which the flights of an item are planned.
pub struct Setting {
    /// The town.
    pub world: Arc<World>,
    /// The bodies around the target.
    pub around: Around,
    /// Walk, companions and what moves.
    pub bodies: MovingBodies,
}

impl Setting {
    /// The setting of a task.
    pub fn read(inputs: &Inputs<'_>, expert: &RecipeExpert) -> Result<Self> {
        let world = world(inputs)?;
        if expert.expert.objective.objective != Objective::Track {
            return Ok(Self { world, around: Around::default(), bodies: MovingBodies::default() });
        }
        check_same_town(inputs, "walks")?;
        let artifact = inputs.one("walks")?;
        let walk = artifacts::WALK.read(inputs, artifact)?;
        let around = traffic::cut_around(inputs, artifact, &walk.track)?;
        let (companions, movers) = (companions::read(inputs)?, around.boxes());
        Ok(Self { world, around, bodies: MovingBodies { walk: Some(walk.track), companions, movers } })
    }
}

/// Notes or rejection of a trajectory.
pub fn produced(outcome: &PlanOutcome) -> Produced {
    match outcome {
        PlanOutcome::Planned(trajectory) => Produced {
            notes: [("visibility".to_owned(), format!("{:.3}", trajectory.certificate.mean_visibility))].into(),
            ..Produced::default()
        },
        PlanOutcome::Rejected { reason, .. } => Produced::rejected(reason),
    }
}
