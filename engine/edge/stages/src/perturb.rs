//! `perturb`: the twin of every expert trajectory, with errors of position and rotation.

use crate::planning::produced;
use crate::ports::{self, TRAJECTORY};
use crate::{single, traffic};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{ParameterError, Result};
use cosfly_domain::PlanOutcome;
use cosfly_experts::artifacts;
use cosfly_experts::world::{check_same_town, link_town, world};
use cosfly_frames::Seed;
use cosfly_pilot::perturb::{PerturbConfig, perturb};
use cosfly_stage::parameters;
use cosfly_stage::{
    InputPort, Inputs, ItemId, ItemRule, Produced, Resources, Stage, StageKind, StagePart, StageProperties, StageRole,
    TaskContext,
};
use cosfly_surroundings::exact::ExactMap;

/// Stage kind `perturb`.
pub struct Perturb;

impl StageKind for Perturb {
    fn name(&self) -> &'static str {
        "perturb"
    }

    fn doc(&self) -> &'static str {
        "Gives every expert trajectory a twin with errors: the paper's jumps, or drift, gusts, late turns, a coarse aim and losses that a drone could fly."
    }

    fn schema(&self) -> serde_json::Value {
        parameters::schema_of::<PerturbConfig>()
    }

    fn ports(&self) -> Vec<InputPort> {
        vec![ports::town(), ports::each("trajectories", TRAJECTORY, false, "The experts, one twin each.")]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let config: PerturbConfig = parameters::read(given)?;
        config.validate().map_err(|(path, message)| parameters::refused_at(&path, message))?;
        let properties = StageProperties {
            version: 7,
            parameters: parameters::canonical(&config),
            inputs: self.ports(),
            items: ItemRule::PerInput("trajectories"),
            bytes_per_frame: 400,
            resources: Resources { memory_mib: 256, batch: 16 },
            ..StageProperties::new(self.name(), StageRole::Changes, TRAJECTORY)
        };
        Ok(single(PerturbStage { config, properties }))
    }
}

struct PerturbStage {
    config: PerturbConfig,
    properties: StageProperties,
}

impl PerturbStage {
    /// The parameters with the kind of one item. Items that count take turns (rejected experts, too, so that no item depends on
    /// another one); each drone of a formation takes turns of its own.
    fn config_of(&self, id: &ItemId) -> PerturbConfig {
        let mut config = self.config.clone();
        if let Some(number) = id.item.number() {
            let order = Seed::of_item(0, id.stage.recipe_name(), id.item.variant().unwrap_or_default());
            config.mixture = config.mixture.of_flight(number, &order);
        }
        config
    }
}

impl Stage for PerturbStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        check_same_town(inputs, "trajectories")?;
        let world = world(inputs)?;
        let artifact = inputs.one("trajectories")?;
        let expert = artifacts::FLIGHT.read(inputs, artifact)?;
        // The expert is published under this name (see `Takes::Named`).
        let expert_id = artifact.id.item.of_stage(&artifact.id.stage).to_string();
        let twin = match expert {
            PlanOutcome::Planned(expert) => {
                let mut movers = traffic::around(inputs, artifact)?.boxes();
                let drones = artifacts::DRONES.find(inputs, artifact)?.unwrap_or_default().join(&mut movers);
                let clearance_m = self.config.clearance_m;
                let map = ExactMap { drones, clearance_m, ..ExactMap::among(&world.exact, &movers) };
                perturb(&expert, &expert_id, map, &self.config_of(&context.id), Seed(context.seed))
            }
            PlanOutcome::Rejected { track, reason } => {
                PlanOutcome::Rejected { track, reason: format!("its expert was rejected: {reason}") }
            }
        };
        artifacts::FLIGHT.put(outputs, &twin)?;
        link_town(inputs, outputs)?;
        traffic::link_moving(artifact, outputs)?;
        Ok(produced(&twin))
    }
}
