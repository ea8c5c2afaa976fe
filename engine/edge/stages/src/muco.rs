//! `muco`: expert trajectories from the multi-constraint optimiser.

use crate::expert::{Companion, Expert, nearest_companions};
use crate::plugins::Plugins;
use crate::ports::{self, TRAJECTORY, WALK};
use crate::world::{check_same_town, link_town, world};
use crate::{codec, single};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, ParameterError, Result};
use cosfly_frames::{Seed, TargetTrack};
use cosfly_pedestrians::PedestrianPath;
use cosfly_planner::PlanOutcome;
use cosfly_planner::objectives::Objective;
use cosfly_planner::objectives::config::DT_S;
use cosfly_stage::{InputPort, Inputs, ItemRule, Produced, Stage, StageKind, StagePart, StageProperties, TaskContext};

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
        let (inputs, items) = match expert.count() {
            None => {
                let optional = expert.config.targets.companions == 0;
                let ports = vec![ports::town(), paths(), InputPort { optional, ..others() }];
                (ports, ItemRule::PerInput("paths"))
            }
            Some(count) => (vec![ports::town()], ItemRule::Count { prefix: "f", count }),
        };
        let properties = StageProperties {
            kind: self.name().into(),
            version: 2,
            parameters: expert.canonical(),
            sources: expert.sources(),
            inputs,
            artifact: TRAJECTORY,
            items,
            bytes_per_item: 60_000,
        };
        Ok(single(MucoStage { expert, properties }))
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
}

impl Stage for MucoStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        let world = world(inputs)?;
        let (walk, companions) = if self.expert.objective.objective == Objective::Track {
            check_same_town(inputs, "paths")?;
            let walk: PedestrianPath = codec::decode(WALK, &inputs.read(inputs.one("paths")?, "walk")?)?;
            let companions = self.companions(inputs, &walk.track)?;
            (Some(walk.track), companions)
        } else {
            (None, vec![])
        };
        let plugins = Plugins::of_expert(&self.expert.plugins, &context.sources)?;
        let plugins = plugins.for_item(context.id.to_string());
        let flight = self.expert.flight(&world, walk, companions, Seed(context.seed), plugins)?;
        let (outcome, findings) = match flight {
            Ok(flight) => {
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
        outputs.put("trajectory", &codec::encode(TRAJECTORY, &outcome)?)?;
        link_town(inputs, outputs)?;
        let mut produced = produced(&outcome);
        produced.notes.extend(findings.0);
        produced.warnings.extend(findings.1);
        Ok(produced)
    }
}

impl MucoStage {
    /// The walks that stay nearest to the one at `paths`.
    fn companions(&self, inputs: &Inputs<'_>, track: &TargetTrack) -> Result<Vec<Companion>> {
        let count = self.expert.config.targets.companions as usize;
        if count == 0 {
            return Ok(vec![]);
        }
        check_same_town(inputs, "others")?;
        let own = inputs.one("paths")?;
        let mut others = vec![];
        for artifact in inputs.all("others").iter().filter(|it| it.id != own.id) {
            let walk =
                inputs.decoded(artifact, "walk", |bytes| codec::decode::<PedestrianPath>(WALK, bytes))?.track.clone();
            if (walk.len(), walk.dt_s) != (track.len(), track.dt_s) {
                let message = format!(
                    "`{}` has {} steps of {} s, `{}` has {} of {} s: they cannot be companions",
                    artifact.id,
                    walk.len(),
                    walk.dt_s,
                    own.id,
                    track.len(),
                    track.dt_s
                );
                return Err(Diagnostic::new("companions-differ", Fault::Recipe, message)
                    .hint("connect `inputs.others` to walkers with the same `steps` and `dt_s`"));
            }
            others.push((artifact.name.to_string(), walk));
        }
        if others.len() < count {
            let message = format!(
                "`targets.companions` is {count}, but `inputs.others` brings {} walks beside `{}`",
                others.len(),
                own.id
            );
            return Err(Diagnostic::new("companions-few", Fault::Recipe, message)
                .hint("raise the walkers' `count`, or ask for fewer companions"));
        }
        Ok(nearest_companions(track, others, count))
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
