//! Part `planners` of a `dataset` stage: other planners behind the walks of a few published flights, for the report. An item
//! of its own, so that a new title plans nothing anew.

use crate::group_notes;

use crate::ports::{self, PLANNERS};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::Result;
use cosfly_domain::Trajectory;
use cosfly_experts::codec;
use cosfly_experts::world::world_of;
use cosfly_flight::comparison::{ComparedFlight, Means, PlannerFigures, compared};
use cosfly_report::PlannerRow;
use cosfly_schema::RenderedTrajectory;
use cosfly_stage::{
    Artifact, Fan, InputPort, Inputs, PortSource, Produced, Resources, Stage, StagePart, StageProperties, StageRole,
    TaskContext,
};
use std::collections::BTreeMap;

/// Name of the part, of the port that reads it and of its blob.
const NAME: &str = "planners";
/// Walks on which planners are compared; more would make publishing slow.
const COMPARED: usize = 3;

/// The part of a stage that gathers pictures at the port `frames`.
pub fn part(frames: InputPort) -> StagePart {
    let properties = StageProperties {
        version: 2,
        inputs: vec![frames, group_notes::port()],
        bytes_per_item: 2_000,
        resources: Resources { memory_mib: 2048, batch: 1 },
        ..StageProperties::new("dataset", StageRole::Serves, PLANNERS)
    };
    StagePart { suffix: NAME, stage: Box::new(PlannersStage { properties }) }
}

/// Port through which the stage reads its part.
pub fn port() -> InputPort {
    let doc = "The comparison of planners: the part of the same stage.";
    let port = ports::gather(NAME, PLANNERS, false, doc);
    InputPort { fan: Fan::Broadcast, source: PortSource::Sibling(NAME), ..port }
}

/// Rows at the port of [`port`].
pub fn read(inputs: &Inputs<'_>) -> Result<Vec<PlannerRow>> {
    codec::decode(PLANNERS, &inputs.read(inputs.one(NAME)?, NAME)?)
}

struct PlannersStage {
    properties: StageProperties,
}

impl Stage for PlannersStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        let rows: Vec<PlannerRow> = compared(&chosen(inputs, context)?).into_iter().map(row).collect();
        outputs.put(NAME, &codec::encode(PLANNERS, &rows)?)?;
        Ok(Produced::default())
    }
}

/// Experts behind a few pedestrians that are spread over the dataset; one of those that differ in their weather only.
fn chosen(inputs: &Inputs<'_>, context: &TaskContext) -> Result<Vec<ComparedFlight>> {
    let record = |frames: &Artifact| RenderedTrajectory::from_bytes(&inputs.read(frames, "index")?);
    // A flight is called like its item.
    let items: BTreeMap<String, &Artifact> =
        inputs.all("frames").iter().map(|frames| (frames.name.to_string(), frames)).collect();
    // By town and pedestrian.
    let mut experts: BTreeMap<(String, String), Vec<&Artifact>> = BTreeMap::new();
    for group in group_notes::read(inputs) {
        for flight in group?.flights {
            let frames = items.get(&flight.trajectory_id).filter(|_| flight.expert_id.is_none());
            if let Some(frames) = frames {
                experts.entry((flight.town, flight.pedestrian_id)).or_default().push(frames);
            }
        }
        context.check_cancelled()?;
    }
    let experts: Vec<Vec<&Artifact>> = experts.into_values().collect();
    let count = COMPARED.min(experts.len());
    let mut chosen: Vec<ComparedFlight> = vec![];
    for at in 0..count {
        for frames in &experts[(2 * at + 1) * experts.len() / (2 * count)] {
            let RenderedTrajectory { trajectory, around, town, pedestrian_id, .. } = record(frames)?;
            let way = |flight: &Trajectory| -> Vec<_> {
                flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect()
            };
            if chosen.iter().all(|other| way(&other.trajectory) != way(&trajectory)) {
                let planner = frames.name.stage().map(ToString::to_string).unwrap_or_default();
                let (walk, world) = ((town.geometry_digest, pedestrian_id), world_of(inputs, frames)?);
                chosen.push(ComparedFlight { trajectory, around, walk, world, planner });
            }
        }
    }
    Ok(chosen)
}

fn row(figures: PlannerFigures) -> PlannerRow {
    let known = |of: fn(&Means) -> f64| figures.means.as_ref().map(of);
    PlannerRow {
        visible: known(|it| it.visible),
        half_visible: known(|it| it.half_visible),
        distance_m: known(|it| it.distance_m),
        length_m: known(|it| it.length_m),
        nearest_m: known(|it| it.nearest_m),
        acceleration_mps2: known(|it| it.acceleration_mps2),
        jerk_mps3: known(|it| it.jerk_mps3),
        sound: figures.sound,
        planned: figures.planned,
        asked: figures.asked,
        costs: figures.costs,
        refusal: figures.refusal,
        planner: figures.planner,
    }
}
