//! `muco`: expert trajectories from the multi-constraint optimiser.

use crate::expert::{Bodies, Expert, drones_before};
use crate::other_drones::DronesBefore;
use crate::plugins::Plugins;
use crate::ports::{self, TRAJECTORY, WALK};
use crate::quotas::{self, Trial};
use crate::world::{check_same_town, link_town, world};
use crate::{codec, companions, traffic};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{ParameterError, Result};
use cosfly_frames::{Seed, TargetTrack};
use cosfly_objectives::Objective;
use cosfly_objectives::config::DT_S;
use cosfly_pedestrians::PedestrianPath;
use cosfly_planner::PlanOutcome;
use cosfly_stage::{InputPort, Inputs, ItemRule, Produced, Stage, StageKind, StagePart, StageProperties, TaskContext};
use cosfly_world::Around;

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
                let items = match expert.drones() {
                    alone if alone.is_empty() => ItemRule::PerInput("paths"),
                    variants => ItemRule::PerVariant { port: "paths", variants },
                };
                (vec![companions::part(count, paths(), others())], ports, items)
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
            version: 4,
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
        let mut main = properties.clone();
        if occlusion.has_quota() && expert.count().is_none() {
            let trial = StageProperties { artifact: ports::LOSSES, bytes_per_item: 100, ..properties };
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
        let world = world(inputs)?;
        let mut around = Around::default();
        let bodies = if self.expert.objective.objective == Objective::Track {
            check_same_town(inputs, "paths")?;
            let artifact = inputs.one("paths")?;
            let walk: PedestrianPath = codec::decode(WALK, &inputs.read(artifact, "walk")?)?;
            around = traffic::cut_around(inputs, artifact, &walk.track)?;
            let (companions, movers) = (companions::read(inputs)?, around.boxes());
            Bodies { walk: Some(walk.track), companions, movers, drones_before: drones_before(&context.id.item) }
        } else {
            Bodies::default()
        };
        let mut expert = self.expert.clone();
        if quotas::order(inputs, context)? == Some(false) {
            expert.config.occlusion.count = 0;
        }
        let plugins = Plugins::of_expert(&expert.plugins, &context.sources)?;
        let plugins = plugins.for_item(context.id.to_string());
        let flight = expert.flight(&world, bodies, Seed(context.seed), plugins)?;
        let mut before = DronesBefore::default();
        let (outcome, findings) = match flight {
            Ok(flight) => {
                before = flight.drones_before();
                let (outcome, said) = flight.plan(&world)?;
                let (notes, mut warnings) = match &outcome {
                    PlanOutcome::Planned(trajectory) => flight.findings(&world, trajectory),
                    PlanOutcome::Rejected { .. } => Default::default(),
                };
                warnings.extend(said);
                (outcome, (notes, warnings))
            }
            Err(reason) => {
                let track = TargetTrack { dt_s: DT_S, height_m: 0.0, radius_m: 0.0, states: vec![] };
                (PlanOutcome::Rejected { track, reason }, Default::default())
            }
        };
        if self.is_trial {
            let followed = traffic::followed(inputs, inputs.one("paths")?)?;
            Trial::of(&outcome, &expert.config.occlusion, &around, followed.as_ref()).put(outputs)?;
            return Ok(Produced::default());
        }
        outputs.put("trajectory", &codec::encode(TRAJECTORY, &outcome)?)?;
        link_town(inputs, outputs)?;
        if let Some(walk) = inputs.all("paths").first() {
            traffic::put_around(walk, &around, outputs)?;
        }
        before.put(outputs)?;
        let mut produced = produced(&outcome);
        produced.notes.extend(findings.0);
        produced.warnings.extend(findings.1);
        Ok(produced)
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
