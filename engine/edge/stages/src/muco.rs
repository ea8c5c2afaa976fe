//! `muco`: expert trajectories from the multi-constraint optimiser.

use crate::ports::{self, TRAJECTORY, WALK};
use crate::world::{check_same_town, link_town, world};
use crate::{codec, parameters, single};
use cosfly_diagnose::Result;
use cosfly_frames::Seed;
use cosfly_pedestrians::PedestrianPath;
use cosfly_planner::{MucoConfig, PlanOutcome, plan};
use cosfly_stage::{
    InputPort, Inputs, ItemRule, OutputSink, ParameterError, Produced, Stage, StageKind, StagePart, StageProperties,
    TaskContext,
};

/// The kind.
pub struct Muco;

impl StageKind for Muco {
    fn name(&self) -> &'static str {
        "muco"
    }

    fn doc(&self) -> &'static str {
        "Plans an expert drone trajectory behind every pedestrian: nine cost terms, safety layers, a certificate."
    }

    fn schema(&self) -> serde_json::Value {
        parameters::schema_of::<MucoConfig>()
    }

    fn ports(&self) -> Vec<InputPort> {
        vec![ports::town(), ports::each("paths", WALK, false, "The walks to follow, one trajectory each.")]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let config: MucoConfig = parameters::read(given)?;
        config.validate().map_err(|(path, message)| parameters::refused_at(&path, message))?;
        let properties = StageProperties {
            kind: self.name().into(),
            version: 1,
            parameters: parameters::canonical(&config),
            sources: vec![],
            inputs: self.ports(),
            artifact: TRAJECTORY,
            items: ItemRule::PerInput("paths"),
            bytes_per_item: 60_000,
        };
        Ok(single(MucoStage { config, properties }))
    }
}

struct MucoStage {
    config: MucoConfig,
    properties: StageProperties,
}

impl Stage for MucoStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        check_same_town(inputs, "paths")?;
        let world = world(inputs)?;
        let walk: PedestrianPath = codec::decode(WALK, &inputs.read(inputs.one("paths")?, "walk")?)?;
        let ground = |x: f64, y: f64| world.ground.ground_height_m(x, y).unwrap_or(0.0);
        let outcome =
            plan(&walk.track, &world.exact, &world.town.planning_boxes, &ground, &self.config, Seed(context.seed));
        outputs.put("trajectory", &codec::encode(TRAJECTORY, &outcome)?)?;
        link_town(inputs, outputs)?;
        Ok(produced(&outcome))
    }
}

/// What the summary says of a trajectory.
pub fn produced(outcome: &PlanOutcome) -> Produced {
    match outcome {
        PlanOutcome::Planned(trajectory) => Produced {
            notes: [("visibility".to_owned(), format!("{:.3}", trajectory.certificate.mean_visibility))].into(),
            ..Produced::default()
        },
        PlanOutcome::Rejected { reason, .. } => Produced { rejected: Some(reason.clone()), ..Produced::default() },
    }
}
