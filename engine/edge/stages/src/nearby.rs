//! Part `nearby` of a `render` stage: the people who may appear in the pictures of a flight, or throw a shadow into them. An
//! item of its own per film, so that one more walker films nothing anew where that walker is never in view.

use crate::ports::{self, NEARBY, TRAJECTORY, WALK};
use crate::traffic::{self, followed, traffic_of};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::PlanOutcome;
use cosfly_experts::artifacts;
use cosfly_experts::memo::Memo;
use cosfly_experts::world::{check_same_town, world};
use cosfly_film::Shooting;
use cosfly_film::nearby::{
    CandidateRefusal, Candidates, Filming, NearbyBodies, NearbyCandidate, NearbyWalk, Origin, Scenery, apart,
};
use cosfly_render::{Buildings, RenderConfig};
use cosfly_stage::{
    Artifact, InputPort, Inputs, ItemRule, PortSource, Produced, Stage, StagePart, StageProperties, StageRole,
    TaskContext,
};
use std::collections::BTreeMap;

/// Name of the part and of the port that reads it.
pub const NAME: &str = "nearby";

/// The part of a stage that renders as `config` says, with the same `items`.
pub fn part(config: &RenderConfig, parameters: serde_json::Value, items: ItemRule) -> StagePart {
    let properties = StageProperties {
        version: 4,
        parameters,
        inputs: vec![ports::town(), trajectories(), others()],
        items,
        bytes_per_item: 2_000,
        files_per_item: 2,
        ..StageProperties::new("render", StageRole::Serves, NEARBY)
    };
    let stage = NearbyStage { config: config.clone(), properties, buildings: Memo::default() };
    StagePart { suffix: NAME, stage: Box::new(stage) }
}

/// Port of the people who are about.
pub fn others() -> InputPort {
    let doc = "Walks of other people who are about while the camera flies; nobody else, when left out.";
    ports::gather("others", WALK, true, doc)
}

/// Port of the trajectories.
pub fn trajectories() -> InputPort {
    ports::each("trajectories", TRAJECTORY, true, "The trajectories to fly the camera along.")
}

/// Port through which the stage reads its part.
pub fn port() -> InputPort {
    let doc = "The people who are near: the part of the same stage.";
    InputPort { optional: true, source: PortSource::Sibling(NAME), ..ports::each(NAME, NEARBY, false, doc) }
}

struct NearbyStage {
    config: RenderConfig,
    properties: StageProperties,
    buildings: Memo<Buildings>,
}

impl Stage for NearbyStage {
    fn properties(&self) -> &StageProperties {
        &self.properties
    }

    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced> {
        check_same_town(inputs, "trajectories")?;
        check_same_town(inputs, "others")?;
        let artifact = inputs.one("trajectories")?;
        let PlanOutcome::Planned(flight) = artifacts::FLIGHT.read(inputs, artifact)? else {
            artifacts::NEARBY.put(outputs, &vec![])?;
            return Ok(Produced::default());
        };
        let world = world(inputs)?;
        let target = followed(inputs, artifact)?;
        let stages: Vec<&[Artifact]> = inputs.all("others").chunk_by(|a, b| a.id.stage == b.id.stage).collect();
        let mut candidates = Candidates::new(&world.town, (&flight, 0.0), target.as_ref());
        let walk_id = artifacts::WALK_ID.find(inputs, artifact)?;
        for (stage, artifacts) in stages.iter().enumerate() {
            add(inputs, &mut candidates, (stage, artifacts), walk_id.as_deref())?;
        }
        let Candidates { all: candidates, left_out: meet_target, .. } = candidates;
        let about = candidates.len();
        let town = inputs.one("town")?.blobs[artifacts::TOWN.blob].digest;
        let buildings = self.buildings.get(town, || -> Result<_> { Ok(Buildings::of(&world.town)) })?;
        let scenery = Scenery { buildings: &buildings, lowest_m: world.town.min_in_world.z };
        let film = context.id.item.variant().filter(|_| !self.config.films().is_empty());
        let config = self.config.of_camera(film);
        let shooting = Shooting::of(&config, &flight, target.as_ref(), film)?;
        let filming = Filming { config: &config, shooting: &shooting, scenery, flight: &flight };
        let near = filming.near(candidates, &|| context.check_cancelled())?;
        let all = near.len();
        let mut near = apart(near, &flight, target.as_ref());
        let left_out = meet_target + all - near.len();
        near.sort_by_key(|candidate| candidate.instance);
        put(outputs, &near, &stages)?;
        let words = format!(
            "{} of {about} near, {left_out} left out: they would walk through the target or somebody else",
            near.len()
        );
        Ok(Produced { notes: BTreeMap::from([("others".to_owned(), words)]), ..Produced::default() })
    }
}

/// Adds the items of a stage at port `others`, which has a number; not the walk that the flight follows.
pub fn add(
    inputs: &Inputs<'_>,
    candidates: &mut Candidates<'_>,
    (stage, artifacts): (usize, &[Artifact]),
    followed: Option<&str>,
) -> Result<()> {
    if let Some(traffic) = artifacts.first().map_or(Ok(None), |artifact| traffic_of(inputs, artifact))? {
        return candidates.add_traffic(stage, &traffic).map_err(|_| too_many(&artifacts[0]));
    }
    let is_other = |artifact: &Artifact| followed.is_none_or(|id| artifact.id.to_string() != id);
    for (item, artifact) in artifacts.iter().enumerate().filter(|(_, artifact)| is_other(artifact)) {
        let walk = artifacts::WALK.shared(inputs, artifact)?;
        match candidates.add_walk((stage, item), &walk, traffic::followed(inputs, artifact)?.as_ref())? {
            None => {}
            Some(CandidateRefusal::NoId) => return Err(too_many(artifact)),
            Some(CandidateRefusal::NoSteps) => {
                let message = format!("the walk `{}` has no steps", artifact.name);
                return Err(Diagnostic::new("crowd-walk", Fault::Input, message));
            }
        }
    }
    Ok(())
}

/// Writes those who are near; `stages` are the items at port `others` by stage.
fn put(outputs: &mut dyn OutputSink, near: &[NearbyCandidate], stages: &[&[Artifact]]) -> Result<()> {
    let mut people = vec![];
    let mut bodies: Vec<NearbyBodies> = vec![];
    for NearbyCandidate { instance, origin, .. } in near {
        match origin {
            Origin::Walk(stage, item) => {
                let artifact = &stages[*stage][*item];
                let walk_id = artifact.name.to_string();
                artifacts::link_walk(artifact, &walk_id, outputs)?;
                people.push(NearbyWalk { instance: *instance, walk_id });
            }
            Origin::Body(traffic, number) => NearbyBodies::add(&mut bodies, traffic, *number, *instance),
        }
    }
    artifacts::NEARBY.put(outputs, &people)?;
    if bodies.is_empty() { Ok(()) } else { artifacts::NEARBY_BODIES.put(outputs, &bodies) }
}

/// The refusal of a body without an instance id.
pub fn too_many(artifact: &Artifact) -> Box<Diagnostic> {
    let message = format!("there is no instance id left for `{}`", artifact.id);
    Diagnostic::new("crowd-large", Fault::Recipe, message)
        .hint("connect fewer stages to `inputs.others`, with fewer people in the last ones")
}
