//! `pedestrians`: people who walk the town's pavements and crossings.

use crate::ports::{self, WALK};
use crate::single;
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, ParameterError, Result};
use cosfly_experts::area_pictures;
use cosfly_experts::artifacts;
use cosfly_experts::memo::Memo;
use cosfly_experts::world::{link_town, world};
use cosfly_film::followed_on;
use cosfly_frames::Seed;
use cosfly_pedestrians::{PedestrianConfig, PedestrianError, WalkableGrid, walk};
use cosfly_stage::parameters;
use cosfly_stage::{
    InputPort, Inputs, ItemLength, ItemRule, Produced, Resources, Stage, StageKind, StagePart, StageProperties,
    StageRole, TaskContext,
};

/// Stage kind `pedestrians`.
pub struct Pedestrians;

impl StageKind for Pedestrians {
    fn name(&self) -> &'static str {
        "pedestrians"
    }

    fn doc(&self) -> &'static str {
        "Simulates people who walk the town's pavements and crossings: routes, smoothing, variable speed, stops."
    }

    fn schema(&self) -> serde_json::Value {
        parameters::schema_of::<PedestrianConfig>()
    }

    fn ports(&self) -> Vec<InputPort> {
        vec![ports::town()]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let mut config: PedestrianConfig = parameters::read(given)?;
        config.check().map_err(|rule| parameters::refused_at(&rule.path.join("."), rule.message))?;
        let (count, sources) = (config.count, area_pictures::take_sources(&mut config.areas, ""));
        let canonical = parameters::without(parameters::canonical(&config), PedestrianConfig::NOT_IN_KEY);
        let properties = StageProperties {
            version: 1,
            parameters: canonical,
            inputs: self.ports(),
            sources,
            items: ItemRule::Count { prefix: "p", count },
            bytes_per_frame: 60,
            length: Some(ItemLength::new(config.frames, config.dt_s)),
            resources: Resources { memory_mib: 512, batch: 16 },
            ..StageProperties::new(self.name(), StageRole::World, WALK)
        };
        Ok(single(PedestrianStage { config, properties, grid: Memo::default() }))
    }
}

struct PedestrianStage {
    config: PedestrianConfig,
    properties: StageProperties,
    grid: Memo<WalkableGrid>,
}

impl Stage for PedestrianStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        let world = world(inputs)?;
        let digest = inputs.one("town")?.blobs["town"].digest;
        let refused = |error: PedestrianError| refusal(error, &world.town.name);
        let build = || {
            let areas = area_pictures::with_pixels(&self.config.areas, &context.sources)?;
            WalkableGrid::build(&world.town, &PedestrianConfig { areas, ..self.config.clone() }).map_err(refused)
        };
        let grid = self.grid.get(digest, build)?;
        let path = walk(&grid, &self.config, Seed(context.seed)).map_err(refused)?;
        artifacts::WALK.put(outputs, &path)?;
        let kind = self.config.kinds.draw(&Seed(context.seed));
        if let Some(followed) = followed_on(&path.track, kind)? {
            artifacts::FOLLOWED.put(outputs, &followed)?;
        }
        link_town(inputs, outputs)?;
        Ok(Produced::default())
    }
}

fn refusal(error: PedestrianError, town: &str) -> Box<Diagnostic> {
    let diagnostic =
        Diagnostic::new("pedestrians-refused", Fault::Input, format!("{error}")).because(format!("in town `{town}`"));
    diagnostic.hint(error.hint())
}
