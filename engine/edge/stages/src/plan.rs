//! `plan`: expert trajectories, from the multi-constraint optimiser (MuCO) or from another planner.

use crate::planning::{Setting, produced};
use crate::ports::{self, TRAJECTORY, WALK};
use crate::quotas;
use crate::{companions, formation, traffic};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{ParameterError, Result};
use cosfly_experts::plugins::Plugins;
use cosfly_experts::world::link_town;
use cosfly_experts::{RecipeExpert, artifacts};
use cosfly_flight::Flown;
use cosfly_flight::losses::Trial;
use cosfly_frames::Seed;
use cosfly_planner::config::OcclusionConfig;
use cosfly_stage::parameters;
use cosfly_stage::{
    InputPort, Inputs, ItemRule, Produced, Resources, Stage, StageKind, StagePart, StageProperties, StageRole,
    TaskContext,
};
use std::sync::Arc;

/// Stage kind `plan`.
pub struct Plan;

impl StageKind for Plan {
    fn name(&self) -> &'static str {
        "plan"
    }

    fn doc(&self) -> &'static str {
        "Plans expert drone trajectories behind pedestrians, around buildings or along waypoints: cost terms, a safe corridor, a certificate."
    }

    fn gone(&self) -> &'static [(&'static str, &'static str)] {
        &[("muco", "plan"), ("paths", "walks")]
    }

    fn schema(&self) -> serde_json::Value {
        RecipeExpert::schema()
    }

    fn ports(&self) -> Vec<InputPort> {
        let optional = |port| InputPort { optional: true, ..port };
        vec![ports::town(), optional(walks()), optional(others())]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let expert = RecipeExpert::read(given)?;
        let count = expert.expert.config.targets.companions;
        let (mut parts, inputs, items) = match expert.count() {
            None => {
                let ports = vec![ports::town(), walks(), companions::port(count == 0)];
                (vec![companions::part(count, walks(), others())], ports, ItemRule::PerInput("walks"))
            }
            Some(count) => (vec![], vec![ports::town()], ItemRule::Count { prefix: "f", count }),
        };
        let occlusion = expert.expert.config.occlusion.clone();
        let mut parameters = expert.canonical();
        parameters["occlusion"] = parameters::without(parameters["occlusion"].take(), OcclusionConfig::NOT_IN_KEY);
        let properties = StageProperties {
            version: 7,
            parameters,
            sources: expert.sources(),
            inputs,
            items,
            bytes_per_frame: 300,
            resources: Resources { memory_mib: 512, batch: 4 },
            ..StageProperties::new(self.name(), StageRole::Plans, TRAJECTORY)
        };
        if expert.expert.config.drones.count > 1 {
            parts.extend(formation::parts(expert, properties));
            return Ok(parts);
        }
        let mut main = properties.clone();
        if occlusion.has_quota() && expert.count().is_none() {
            let trial = StageProperties {
                version: quotas::TRIALS_VERSION,
                artifact: ports::LOSSES,
                bytes_per_item: 100,
                bytes_per_frame: 0,
                role: StageRole::Serves,
                ..properties
            };
            let trial = PlanStage { expert: expert.clone(), properties: trial, is_trial: true };
            parts.push(StagePart { suffix: quotas::TRIALS, stage: Box::new(trial) });
            parts.push(quotas::orders_part(&occlusion));
            main.inputs.push(quotas::port());
        }
        parts.push(StagePart { suffix: "", stage: Box::new(PlanStage { expert, properties: main, is_trial: false }) });
        Ok(parts)
    }
}

fn walks() -> InputPort {
    ports::each("walks", WALK, false, "The walks to follow, one trajectory each; `objective = \"track\"` needs them.")
}

fn others() -> InputPort {
    ports::gather("others", WALK, false, "The walks that companions are taken from; `targets.companions` needs them.")
}

struct PlanStage {
    expert: RecipeExpert,
    properties: StageProperties,
    /// Whether the flights are planned only to learn whether they can lose their targets.
    is_trial: bool,
}

impl Stage for PlanStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        let expert = quotas::ordered(&self.expert, inputs, context)?;
        let Setting { world, around, bodies } = Setting::read(inputs, &expert)?;
        let plugins = Plugins::of_expert(&expert.plugins, &context.sources)?;
        let plugins = Arc::new(plugins.for_item(context.id.to_string()));
        let flight = expert.expert.flight(&world, bodies, Seed(context.seed), plugins)?;
        let Flown { outcome, notes, warnings } = match flight {
            Ok(flight) => Flown::of(&flight, &world)?,
            Err(reason) => Flown::none(&reason),
        };
        if self.is_trial {
            let followed = traffic::followed(inputs, inputs.one("walks")?)?;
            let occlusion = &expert.expert.config.occlusion;
            let trial = Trial::of(&outcome, occlusion, &world.exact, &around, followed.as_ref());
            artifacts::LOSSES.put(outputs, &trial)?;
            return Ok(Produced::default());
        }
        artifacts::FLIGHT.put(outputs, &outcome)?;
        link_town(inputs, outputs)?;
        if let Some(walk) = inputs.all("walks").first() {
            traffic::put_around(walk, &around, outputs)?;
        }
        let mut produced = produced(&outcome);
        produced.notes.extend(notes);
        produced.warnings.extend(warnings);
        Ok(produced)
    }
}
