//! Part `verdict` of an `inspect` stage: flights that are left out, with their reasons, decided over all of them at once.

use crate::ports::{self, FRAMES, VERDICT};
use crate::rejections::is_rejected;
use cosfly_blobs::OutputSink;
use cosfly_diagnose::Result;
use cosfly_doctor::sources;
use cosfly_doctor::verdict::{Decided, Family, InspectConfig, Verdict, verdict};
use cosfly_domain::{ObstacleKind, Town};
use cosfly_experts::codec;
use cosfly_experts::world::{check_same_town, world};
use cosfly_frames::{DVec3, Seed};
use cosfly_schema::RenderedTrajectory;
use cosfly_stage::parameters;
use cosfly_stage::{
    Fan, InputPort, Inputs, PortSource, Produced, Stage, StagePart, StageProperties, StageRole, TaskContext,
};
use std::collections::BTreeMap;

/// Name of the part, of the port that reads it and of its blob.
const NAME: &str = "verdict";

/// The part of a stage that keeps flights as `config` says.
pub fn part(config: InspectConfig) -> StagePart {
    let doc = "The rendered flights.";
    let properties = StageProperties {
        version: 3,
        parameters: parameters::canonical(&config),
        inputs: vec![ports::town(), ports::without_pictures(ports::gather("frames", FRAMES, false, doc))],
        bytes_per_item: 10_000,
        ..StageProperties::new("inspect", StageRole::Serves, VERDICT)
    };
    StagePart { suffix: NAME, stage: Box::new(VerdictStage { config, properties }) }
}

/// Port through which the stage reads its part.
pub fn port() -> InputPort {
    let port = ports::gather(NAME, VERDICT, false, "The verdict: the part of the same stage.");
    InputPort { fan: Fan::Broadcast, source: PortSource::Sibling(NAME), ..port }
}

/// Verdict at the port of [`port`].
pub fn read(inputs: &Inputs<'_>) -> Result<Verdict> {
    codec::decode(VERDICT, &inputs.read(inputs.one(NAME)?, NAME)?)
}

struct VerdictStage {
    config: InspectConfig,
    properties: StageProperties,
}

impl Stage for VerdictStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        check_same_town(inputs, "frames")?;
        let vehicles = vehicles(&world(inputs)?.town);
        let mut families: BTreeMap<String, Family> = BTreeMap::new();
        for artifact in inputs.all("frames").iter().filter(|it| !is_rejected(it)) {
            context.check_cancelled()?;
            let record = RenderedTrajectory::from_bytes(&inputs.read(artifact, "index")?)?;
            let mut episode = sources::record::episode(&record);
            episode.vehicles.clone_from(&vehicles);
            let family = families.entry(record.flight_of_expert().to_owned()).or_default();
            family.items.push(artifact.name.to_string());
            family.add(&episode, &self.config);
            family.rate(&record);
        }
        let Decided { verdict, notes } = verdict(families, Seed(context.seed), &self.config)?;
        outputs.put(NAME, &codec::encode(VERDICT, &verdict)?)?;
        Ok(Produced { notes, ..Produced::default() })
    }
}

fn vehicles(town: &Town) -> Vec<(DVec3, DVec3, f64)> {
    let cars = town.obstacles.iter().filter(|it| it.kind == ObstacleKind::Car);
    cars.map(|it| (it.shape.center_in_world, it.shape.half_extents_m, it.shape.yaw_rad)).collect()
}
