//! `muco`: expert trajectories from the multi-constraint optimiser.

use crate::expert::{Bodies, Expert, Flown};
use crate::plugins::Plugins;
use crate::ports::{self, TRAJECTORY, WALK};
use crate::quotas::{self, Trial};
use crate::world::{World, check_same_town, link_town, world};
use crate::{codec, companions, formation, traffic};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{ParameterError, Result};
use cosfly_domain::{Around, PlanOutcome};
use cosfly_frames::Seed;
use cosfly_objectives::Objective;
use cosfly_pedestrians::PedestrianPath;
use cosfly_stage::{InputPort, Inputs, ItemRule, Produced, Stage, StageKind, StagePart, StageProperties, TaskContext};
use std::sync::Arc;

/// Stage kind `muco`.
pub struct Muco;

impl StageKind for Muco {
    fn name(&self) -> &'static str {
        "muco"
    }

    fn doc(&self) -> &'static str {
        "Plans expert drone trajectories behind pedestrians, around buildings or along waypoints: cost terms, a safe corridor, a certificate."
    }

    fn schema(&self) -> serde_json::Value {
        Expert::schema()
    }

    fn ports(&self) -> Vec<InputPort> {
        let optional = |port| InputPort { optional: true, ..port };
        vec![ports::town(), optional(paths()), optional(others())]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let expert = Expert::read(given)?;
        let count = expert.config.targets.companions;
        let (mut parts, inputs, items) = match expert.count() {
            None => {
                let ports = vec![ports::town(), paths(), companions::port(count == 0)];
                (vec![companions::part(count, paths(), others())], ports, ItemRule::PerInput("paths"))
            }
            Some(count) => (vec![], vec![ports::town()], ItemRule::Count { prefix: "f", count }),
        };
        let occlusion = expert.config.occlusion.clone();
        let mut parameters = expert.canonical();
        // A flight depends on its own order alone.
        for key in ["share", "beside_look_alike"] {
            parameters["occlusion"].as_object_mut().expect("a table").remove(key);
        }
        let properties = StageProperties {
            kind: self.name().into(),
            version: 6,
            parameters,
            sources: expert.sources(),
            inputs,
            artifact: TRAJECTORY,
            items,
            bytes_per_item: 60_000,
            files_per_item: 1,
            intermediate: &[],
            asks: None,
        };
        if expert.config.drones.count > 1 {
            parts.extend(formation::parts(expert, properties));
            return Ok(parts);
        }
        let mut main = properties.clone();
        if occlusion.has_quota() && expert.count().is_none() {
            let trial = StageProperties {
                version: quotas::TRIALS_VERSION,
                artifact: ports::LOSSES,
                bytes_per_item: 100,
                ..properties
            };
            let trial = MucoStage { expert: expert.clone(), properties: trial, is_trial: true };
            parts.push(StagePart { suffix: quotas::TRIALS, stage: Box::new(trial) });
            parts.push(quotas::orders_part(&occlusion));
            main.inputs.push(quotas::port());
        }
        parts.push(StagePart { suffix: "", stage: Box::new(MucoStage { expert, properties: main, is_trial: false }) });
        Ok(parts)
    }
}

fn paths() -> InputPort {
    ports::each("paths", WALK, false, "The walks to follow, one trajectory each; `objective = \"track\"` needs them.")
}

fn others() -> InputPort {
    ports::gather("others", WALK, false, "The walks that companions are taken from; `targets.companions` needs them.")
}

struct MucoStage {
    expert: Expert,
    properties: StageProperties,
    /// Whether the flights are planned only to learn whether they can lose their targets.
    is_trial: bool,
}

impl Stage for MucoStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        let expert = quotas::ordered(&self.expert, inputs, context)?;
        let Setting { world, around, bodies } = Setting::read(inputs, &expert)?;
        let plugins = Plugins::of_expert(&expert.plugins, &context.sources)?;
        let plugins = plugins.for_item(context.id.to_string());
        let Flown { outcome, notes, warnings } = match expert.flight(&world, bodies, Seed(context.seed), plugins)? {
            Ok(flight) => Flown::of(&flight, &world)?,
            Err(reason) => Flown::none(&reason),
        };
        if self.is_trial {
            let followed = traffic::followed(inputs, inputs.one("paths")?)?;
            Trial::of(&outcome, &expert.config.occlusion, &world.exact, &around, followed.as_ref()).put(outputs)?;
            return Ok(Produced::default());
        }
        outputs.put("trajectory", &codec::encode(TRAJECTORY, &outcome)?)?;
        link_town(inputs, outputs)?;
        if let Some(walk) = inputs.all("paths").first() {
            traffic::put_around(walk, &around, outputs)?;
        }
        let mut produced = produced(&outcome);
        produced.notes.extend(notes);
        produced.warnings.extend(warnings);
        Ok(produced)
    }
}

/// What the flights of an item are planned among.
pub struct Setting {
    /// The town.
    pub world: Arc<World>,
    /// The bodies around the target.
    pub around: Around,
    /// Walk, companions and what moves.
    pub bodies: Bodies,
}

impl Setting {
    /// The setting of a task.
    pub fn read(inputs: &Inputs<'_>, expert: &Expert) -> Result<Self> {
        let world = world(inputs)?;
        if expert.objective.objective != Objective::Track {
            return Ok(Self { world, around: Around::default(), bodies: Bodies::default() });
        }
        check_same_town(inputs, "paths")?;
        let artifact = inputs.one("paths")?;
        let walk: PedestrianPath = codec::decode(WALK, &inputs.read(artifact, "walk")?)?;
        let around = traffic::cut_around(inputs, artifact, &walk.track)?;
        let (companions, movers) = (companions::read(inputs)?, around.boxes());
        Ok(Self { world, around, bodies: Bodies { walk: Some(walk.track), companions, movers } })
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
