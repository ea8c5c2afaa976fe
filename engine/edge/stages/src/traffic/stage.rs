//! `traffic`: people and vehicles who move together through the town, and the walks of those who are followed.

use super::avoided::{self, Avoided};
use super::config::TrafficConfig;
use super::moving::traffic_of;
use super::population;
use crate::memo::Memo;
use crate::ports::{self, TRAFFIC, WALK};
use crate::world::{check_same_town, link_town, world};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, ParameterError, Result};
use cosfly_domain::{Body, Followed, Traffic, Traits};
use cosfly_experts::artifacts;
use cosfly_figures::{BodyShape, outfit_of};
use cosfly_frames::Seed;
use cosfly_pedestrians::{Crowd, WalkableGrid, path_of};
use cosfly_stage::parameters;
use cosfly_stage::{
    Artifact, Fan, InputPort, Inputs, ItemRule, Produced, Resources, Stage, StageKind, StagePart, StageProperties,
    StageRole, TaskContext,
};
use cosfly_world::{Wardrobe, dress, give_looks, simulate};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Blob of a walk that was taken out of traffic, with the whole [`Traffic`]; and the part that makes it.
const BODIES: &str = artifacts::TRAFFIC.blob;

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
        vec![ports::town(), avoided::port()]
    }

    fn build(&self, given: serde_json::Value) -> Result<Vec<StagePart>, ParameterError> {
        let mut config: TrafficConfig = parameters::read(given)?;
        config.check().map_err(|rule| parameters::refused_at(&rule.path.join("."), rule.message))?;
        let sources = config.take_sources();
        let properties = |parameters, inputs, artifact, items, bytes_per_item| StageProperties {
            kind: self.name().into(),
            version: 8,
            parameters,
            sources: vec![],
            inputs,
            artifact,
            items,
            bytes_per_item,
            files_per_item: 2,
            intermediate: &[],
            asks: None,
            role: StageRole::World,
            resources: Resources::default(),
        };
        let bodies = config.canonical_of_bodies();
        let bytes = 20 * u64::from(config.frames) * u64::from(config.people.count);
        let bodies = properties(bodies, self.ports(), TRAFFIC, ItemRule::One, bytes);
        let bodies = StageProperties { sources, role: StageRole::Serves, ..bodies };
        let doc = "Everybody: the part of the same stage.";
        let inputs = vec![ports::town(), ports::sibling(BODIES, TRAFFIC, Fan::Broadcast, doc)];
        let items = ItemRule::Count { prefix: "t", count: config.follow.count };
        let walks = properties(config.canonical_of_walks(), inputs, WALK, items, 60 * u64::from(config.frames));
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

struct BodiesStage {
    config: Arc<TrafficConfig>,
    properties: StageProperties,
}

impl Stage for BodiesStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        check_same_town(inputs, avoided::PORT)?;
        let world = world(inputs)?;
        let clock = self.config.clock();
        let by = (clock, Seed(context.seed));
        let avoided = Avoided::read(inputs)?;
        let count = avoided.len();
        let mut populations = population::all(&self.config, &world.town, by, &context.sources, avoided)?;
        let simulated = simulate(&mut populations.all, clock, |_| context.check_cancelled())?;
        let mut traffic = Traffic { name: context.id.stage.recipe_name().to_owned(), ..simulated };
        let left_out = avoided::take_out(&mut traffic, count);
        // Followed people matter here to those who are dressed like them; walks refuse names that nobody has.
        let mut followed = self.config.follow.eligible(&traffic).unwrap_or_default();
        followed.truncate(self.config.follow.count as usize);
        let outfit = |looks: &Seed| outfit_of(BodyShape::default(), looks);
        let traits = |looks: &Seed| outfit(looks).traits.unwrap_or(Traits::PLAIN);
        let alike = |a: &Seed, b: &Seed| outfit(a).is_like(&outfit(b));
        let seed = |name: &str| Seed(context.seed).child(name, 0);
        let looks_note = give_looks(&mut traffic, &self.config.looks, &traits, &seed("looks"));
        let wardrobe = Wardrobe { alike: &alike, traits: &traits };
        let note = dress(&mut traffic, &followed, &self.config.look_alikes, wardrobe, &seed("look-alikes"));
        let about = traffic.notes.join("; ");
        let warnings: Vec<String> = populations.notes.into_iter().chain(looks_note).chain(note).collect();
        traffic.notes.extend(warnings.iter().cloned());
        artifacts::TRAFFIC.put(outputs, &traffic)?;
        link_town(inputs, outputs)?;
        let mut notes = BTreeMap::from([("bodies".to_owned(), traffic.bodies.len().to_string())]);
        if !about.is_empty() {
            notes.insert("traffic".to_owned(), about);
        }
        if count > 0 {
            let words = format!("{count}; {left_out} bodies left out, through whom one of them walks");
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
        let eligible = self.config.follow.eligible(&traffic).map_err(|name| nobody(name, &traffic))?;
        let place = context.id.item.number().unwrap_or(0) as usize;
        let number = *eligible.get(place).ok_or_else(|| too_few(&self.config, eligible.len()))?;
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

/// The refusal of a name in `follow.named`.
fn nobody(name: &str, traffic: &Traffic) -> Box<Diagnostic> {
    const MOST: usize = 8;
    let called = traffic.bodies.iter().filter(|body| body.plan.source == name).count();
    let message = match called {
        0 => format!("`follow.named` names `{name}`, but nobody is called so"),
        _ => format!("`follow.named` names `{name}`, who is not there in all frames"),
    };
    let whole = (0..traffic.bodies.len()).filter(|number| traffic.track(*number as u32).is_some());
    let names = whole.map(|number| &traffic.bodies[number].plan.source).filter(|name| !name.is_empty());
    let names: Vec<String> = names.take(MOST).map(|name| format!("`{name}`")).collect();
    let has_names = traffic.bodies.iter().any(|body| !body.plan.source.is_empty());
    let hint = match names.len() {
        0 if !has_names => {
            "names are those of `scripted` and `recorded` people and of bodies of `sumo`; this stage has none"
                .to_owned()
        }
        0 => "nobody with a name is there all the time: use fewer frames, or another `start_s` or `begin_s`".to_owned(),
        _ => format!("there all the time, among others: {}", names.join(", ")),
    };
    Diagnostic::new("traffic-few", Fault::Recipe, message).hint(hint)
}

fn too_few(config: &TrafficConfig, eligible: usize) -> Box<Diagnostic> {
    let follow = &config.follow;
    let message = format!(
        "`follow.count` is {}, but {} of the kinds {} are there all the time and cover {} m",
        follow.count,
        if eligible == 0 { "no bodies".to_owned() } else { format!("only {eligible} bodies") },
        follow.names(),
        follow.min_length_m
    );
    Diagnostic::new("traffic-few", Fault::Recipe, message)
        .hint("follow fewer, move more people or vehicles, name further kinds, or lower `follow.min_length_m`")
}
