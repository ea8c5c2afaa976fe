//! `traffic`: people and vehicles who move together through the town, and the walks of those who are followed.

use super::moving::{followed, traffic_of};
use crate::ports::{self, TRAFFIC, WALK};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, ParameterError, Result};
use cosfly_domain::{Body, Followed};
use cosfly_experts::area_pictures;
use cosfly_experts::artifacts;
use cosfly_experts::memo::Memo;
use cosfly_experts::world::{check_same_town, link_town, world};
use cosfly_frames::Seed;
use cosfly_pedestrians::{Crowd, WalkableGrid, path_of};
use cosfly_stage::parameters;
use cosfly_stage::{
    Artifact, Fan, InputPort, Inputs, ItemLength, ItemRule, Produced, Source, Stage, StageKind, StagePart,
    StageProperties, StageRole, TaskContext,
};
use cosfly_traffic::{Avoided, Follow, SimulatedTraffic, TrackFile, TrafficConfig, simulate_traffic};
use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;
use std::sync::Arc;

/// Blob of a walk that was taken out of traffic, with the whole [`cosfly_domain::Traffic`]; and the part that makes it.
const BODIES: &str = artifacts::TRAFFIC.blob;
/// Port of the walks of those who are avoided.
const AVOID: &str = "avoid";

/// Stage kind `traffic`.
pub struct TrafficKind;

impl StageKind for TrafficKind {
    fn name(&self) -> &'static str {
        "traffic"
    }

    fn doc(&self) -> &'static str {
        "Moves people and vehicles through the town together, none through another; flights follow some of them among all others."
    }

    fn schema(&self) -> serde_json::Value {
        parameters::schema_of::<TrafficConfig>()
    }

    fn ports(&self) -> Vec<InputPort> {
        let doc = "Walks that are made before: everybody moves around these people. They are no part of this traffic.";
        vec![ports::town(), InputPort { optional: true, ..ports::gather(AVOID, WALK, true, doc) }]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let mut config: TrafficConfig = parameters::read(given)?;
        config.check().map_err(|rule| parameters::refused_at(&rule.path.join("."), rule.message))?;
        let sources = take_sources(&mut config);
        let properties = |parameters, inputs, bytes_per_frame| StageProperties {
            version: 10,
            parameters,
            inputs,
            bytes_per_frame,
            length: Some(ItemLength::new(config.frames, config.dt_s)),
            files_per_item: 2,
            ..StageProperties::new(self.name(), StageRole::World, WALK)
        };
        let bytes = 20 * u64::from(config.people.count);
        let bodies = properties(parameters_of_bodies(&config), self.ports(), bytes);
        let bodies = StageProperties { sources, artifact: TRAFFIC, role: StageRole::Serves, ..bodies };
        let doc = "Everybody: the part of the same stage.";
        let inputs = vec![ports::town(), ports::sibling(BODIES, TRAFFIC, Fan::Broadcast, doc)];
        let items = ItemRule::Count { prefix: "t", count: config.follow.count };
        // One walk does not depend on how many there are.
        let parameters = parameters::without(parameters::canonical(&config.follow), Follow::NOT_IN_KEY);
        let walks = properties(parameters, inputs, 60);
        let walks = StageProperties { items, ..walks };
        let config = Arc::new(config);
        Ok(vec![
            StagePart {
                suffix: BODIES,
                stage: Box::new(BodiesStage { config: Arc::clone(&config), properties: bodies }),
            },
            StagePart { suffix: "", stage: Box::new(WalksStage { config, properties: walks, grid: Memo::default() }) },
        ])
    }
}

/// Files of recorded tracks, then the two of SUMO, then the pictures of areas. Their names are left out of the parameters: contents count.
fn take_sources(config: &mut TrafficConfig) -> Vec<Source> {
    let mut sources = vec![];
    for (number, recorded) in config.recorded.iter_mut().enumerate() {
        sources.push(Source::new(format!("recorded.{number}.source"), std::mem::take(&mut recorded.source)));
    }
    if let Some(sumo) = &mut config.sumo {
        sources.push(Source::new("sumo.source", std::mem::take(&mut sumo.source)));
        sources.push(Source::new("sumo.net", std::mem::take(&mut sumo.net)));
    }
    sources.extend(area_pictures::take_sources(&mut config.people.areas, "people."));
    sources
}

/// Parameters that the bodies depend on, for keys: those who are followed as far as others are dressed like them.
fn parameters_of_bodies(config: &TrafficConfig) -> serde_json::Value {
    let all = parameters::canonical(config);
    if config.look_alikes.shares.is_empty() {
        parameters::without(all, TrafficConfig::NOT_IN_KEY_OF_BODIES)
    } else {
        all
    }
}

fn track_file(path: &Path) -> TrackFile {
    let (shown, path) = (path.display().to_string(), path.to_owned());
    TrackFile { shown, open: Box::new(move || Ok(Box::new(File::open(&path)?))) }
}

/// People at the port of walks that are made before; all bodies of a traffic that one of them was taken out of.
fn avoided(inputs: &Inputs<'_>) -> Result<Avoided> {
    let mut avoided = Avoided::default();
    for walks in inputs.all(AVOID).chunk_by(|a, b| a.id.stage == b.id.stage) {
        match walks.first().map_or(Ok(None), |walk| traffic_of(inputs, walk))? {
            Some(traffic) => avoided.add_traffic(&traffic),
            None => walks.iter().try_for_each(|walk| {
                avoided.add_walk(&*artifacts::WALK.shared(inputs, walk)?, followed(inputs, walk)?.as_ref())
            })?,
        }
    }
    Ok(avoided)
}

struct BodiesStage {
    config: Arc<TrafficConfig>,
    properties: StageProperties,
}

impl Stage for BodiesStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        check_same_town(inputs, AVOID)?;
        let world = world(inputs)?;
        let name = context.id.stage.recipe_name();
        let mut config = TrafficConfig::clone(&self.config);
        let tracks = config.recorded.len() + 2 * usize::from(config.sumo.is_some());
        let (tracks, pictures) = context.sources.split_at(tracks);
        config.people.areas = area_pictures::with_pixels(&config.people.areas, pictures)?;
        let files: Vec<TrackFile> = tracks.iter().map(|path| track_file(path)).collect();
        let check = || context.check_cancelled();
        let SimulatedTraffic { traffic, about, warnings, avoided, left_out } =
            simulate_traffic(&config, (name, Seed(context.seed)), &world.town, &files, avoided(inputs)?, &check)?;
        artifacts::TRAFFIC.put(outputs, &traffic)?;
        link_town(inputs, outputs)?;
        let mut notes = BTreeMap::from([("bodies".to_owned(), traffic.bodies.len().to_string())]);
        if !about.is_empty() {
            notes.insert("traffic".to_owned(), about);
        }
        if avoided > 0 {
            let words = format!("{avoided}; {left_out} bodies left out, through whom one of them walks");
            notes.insert("avoided".to_owned(), words);
        }
        Ok(Produced { notes, warnings, ..Produced::default() })
    }
}

struct WalksStage {
    config: Arc<TrafficConfig>,
    properties: StageProperties,
    grid: Memo<Option<WalkableGrid>>,
}

impl Stage for WalksStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        let artifact = inputs.one(BODIES)?;
        let traffic = traffic_of(inputs, artifact)?.ok_or_else(|| missing(artifact))?;
        let number = self.config.follow.number(&traffic, context.id.item.number().unwrap_or(0) as usize)?;
        let body: &Body = &traffic.bodies[number as usize];
        let track = traffic.track(number).ok_or_else(|| missing(artifact))?;
        let digest = inputs.one("town")?.blobs[artifacts::TOWN.blob].digest;
        let world = world(inputs)?;
        let grid = || Ok::<_, Box<Diagnostic>>(Crowd::grid(&world.town, &self.config.people).ok());
        let grid = self.grid.get(digest, grid)?;
        let path = path_of(Option::as_ref(&grid).map(WalkableGrid::ground), track);
        artifacts::WALK.put(outputs, &path)?;
        artifacts::FOLLOWED
            .put(outputs, &Followed { traffic: traffic.name.clone(), number, plan: body.plan.clone() })?;
        outputs.link(BODIES, artifact.blobs[BODIES])?;
        link_town(inputs, outputs)?;
        let notes = [("body".to_owned(), format!("{} {number}", body.plan.kind.name()))].into();
        Ok(Produced { notes, ..Produced::default() })
    }
}

fn missing(artifact: &Artifact) -> Box<Diagnostic> {
    Diagnostic::new("artifact-decode", Fault::Bug, format!("`{}` holds no traffic", artifact.id))
}
