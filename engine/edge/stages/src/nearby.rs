//! Part `nearby` of a `render` stage: the people who may appear in the pictures of a flight, or throw a shadow into them. An
//! item of its own per film, so that one more walker films nothing anew where that walker is never in view.

use crate::memo::Memo;
use crate::ports::{self, NEARBY, TRAJECTORY, WALK};
use crate::shooting::Shooting;
use crate::traffic::{BODIES, followed, traffic_of};
use crate::walks::{Person, touch};
use crate::world::{TOWN_BLOB, World, check_same_town, world};
use crate::{body_rays, codec};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::{
    Around, Body, Camera, Followed, PlanOutcome, TARGET_INSTANCE, Traffic, Trajectory, object_instance,
};
use cosfly_figures::Walker;
use cosfly_frames::{Pose, TargetState};
use cosfly_optics::pose_at;
use cosfly_pedestrians::PedestrianPath;
use cosfly_render::{Buildings, Outlook, RenderConfig};
use cosfly_stage::{
    Artifact, InputPort, Inputs, ItemRule, PortSource, Produced, Stage, StagePart, StageProperties, TaskContext,
};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Name of the part and of the port that reads it.
pub const NAME: &str = "nearby";
/// Blob of an item with its [`NearbyPerson`]s.
const PEOPLE: &str = "people";

/// A person who is near a flight.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NearbyPerson {
    /// Id in instance images (see [`instance_of`]).
    pub instance: u32,
    /// Stage and item of the walk, such as `crowd-p00003`.
    pub walk_id: String,
}

/// The bodies of one traffic that are near a flight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NearbyBodies {
    /// Ids in instance images, one for each body.
    pub instances: Vec<u32>,
    /// The bodies.
    pub around: Around,
}

/// The part of a stage that renders as `config` says, with the same `items`.
pub fn part(config: &RenderConfig, parameters: serde_json::Value, items: ItemRule) -> StagePart {
    let properties = StageProperties {
        kind: "render".into(),
        version: 4,
        parameters,
        sources: vec![],
        inputs: vec![ports::town(), trajectories(), others()],
        artifact: NEARBY,
        items,
        bytes_per_item: 2_000,
        files_per_item: 2,
        intermediate: &[],
        asks: None,
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

/// People of an item, by instance id.
pub fn people(inputs: &Inputs<'_>, artifact: &Artifact) -> Result<Vec<NearbyPerson>> {
    codec::decode(NEARBY, &inputs.read(artifact, PEOPLE)?)
}

/// Bodies of traffic of an item; none where no traffic is at port `others`.
pub fn bodies(inputs: &Inputs<'_>, artifact: &Artifact) -> Result<Vec<NearbyBodies>> {
    if !artifact.blobs.contains_key(BODIES) {
        return Ok(vec![]);
    }
    codec::decode(NEARBY, &inputs.read(artifact, BODIES)?)
}

/// Name of the blob of an item that holds the walk of a person.
pub fn walk_blob(walk_id: &str) -> String {
    format!("walk-{walk_id}")
}

/// Walk in a blob of an artifact.
pub fn walk(inputs: &Inputs<'_>, artifact: &Artifact, blob: &str) -> Result<Arc<PedestrianPath>> {
    inputs.decoded(artifact, blob, |bytes| codec::decode::<PedestrianPath>(WALK, bytes))
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
        let outcome: PlanOutcome = codec::decode(TRAJECTORY, &inputs.read(inputs.one("trajectories")?, "trajectory")?)?;
        let PlanOutcome::Planned(trajectory) = outcome else {
            outputs.put(PEOPLE, &codec::encode(NEARBY, &Vec::<NearbyPerson>::new())?)?;
            return Ok(Produced::default());
        };
        let world = world(inputs)?;
        let target = followed(inputs, inputs.one("trajectories")?)?;
        let (candidates, meet_target) = candidates(inputs, &world, &trajectory, target.as_ref())?;
        let about = candidates.len();
        let buildings = self
            .buildings
            .get(inputs.one("town")?.blobs[TOWN_BLOB].digest, || -> Result<_> { Ok(Buildings::of(&world.town)) })?;
        let scenery = Scenery { buildings: &buildings, lowest_m: world.town.min_in_world.z };
        let near = self.near(context, &scenery, &trajectory, target.as_ref(), candidates)?;
        let all = near.len();
        let mut near = apart(near, &trajectory, target.as_ref());
        let left_out = meet_target + all - near.len();
        near.sort_by_key(|candidate| candidate.instance);
        let mut people = vec![];
        let mut bodies: Vec<NearbyBodies> = vec![];
        for Candidate { instance, origin, .. } in &near {
            match origin {
                Origin::Walk(artifact) => {
                    let walk_id = artifact.name.to_string();
                    outputs.link(&walk_blob(&walk_id), artifact.blobs["walk"])?;
                    people.push(NearbyPerson { instance: *instance, walk_id });
                }
                Origin::Body(traffic, number) => NearbyBodies::add(&mut bodies, traffic, *number, *instance),
            }
        }
        outputs.put(PEOPLE, &codec::encode(NEARBY, &people)?)?;
        if !bodies.is_empty() {
            outputs.put(BODIES, &codec::encode(NEARBY, &bodies)?)?;
        }
        let words = format!(
            "{} of {about} near, {left_out} left out: they would walk through the target or somebody else",
            near.len()
        );
        Ok(Produced { notes: BTreeMap::from([("others".to_owned(), words)]), ..Produced::default() })
    }
}

/// Parts of a town that hide people.
struct Scenery<'a> {
    buildings: &'a Buildings,
    /// Height below which there is nothing to be seen, metres.
    lowest_m: f64,
}

/// A person who may be near.
struct Candidate<'a> {
    instance: u32,
    /// Place among the candidates: that of the stage at the port, then that of the item.
    place: usize,
    origin: Origin<'a>,
    person: Person,
}

/// Origin of a person's track.
enum Origin<'a> {
    /// A walk of its own.
    Walk(&'a Artifact),
    /// A body of traffic.
    Body(Arc<Traffic>, u32),
}

impl NearbyBodies {
    /// Adds a body to those of its traffic.
    fn add(all: &mut Vec<Self>, traffic: &Traffic, number: u32, instance: u32) {
        let place = all.iter().position(|it| it.around.traffic.name == traffic.name).unwrap_or_else(|| {
            let (name, dt_s, frames) = (traffic.name.clone(), traffic.dt_s, traffic.frames);
            let traffic = Traffic { name, dt_s, frames, ..Traffic::default() };
            all.push(Self { instances: vec![], around: Around { numbers: vec![], traffic } });
            all.len() - 1
        });
        let own = &mut all[place];
        own.instances.push(instance);
        own.around.numbers.push(number);
        own.around.traffic.bodies.push(traffic.bodies[number as usize].clone());
    }
}

/// All people at port `others` except the target and those whose own walk crosses the target's body; and the number of the latter.
fn candidates<'a>(
    inputs: &'a Inputs<'_>,
    world: &World,
    trajectory: &Trajectory,
    target: Option<&Followed>,
) -> Result<(Vec<Candidate<'a>>, usize)> {
    let largest_object = largest_object(world);
    let (mut candidates, mut left_out) = (vec![], 0);
    for (stage, artifacts) in inputs.all("others").chunk_by(|a, b| a.id.stage == b.id.stage).enumerate() {
        let instance_of = |item: usize, named: &Artifact| {
            let instance = instance_of(stage, item).and_then(|number| largest_object.checked_add(number));
            instance.ok_or_else(|| too_many(named))
        };
        if let Some(traffic) = artifacts.first().map_or(Ok(None), |artifact| traffic_of(inputs, artifact))? {
            for (number, body) in (0..).zip(&traffic.bodies).filter(|(_, body)| !body.states.is_empty()) {
                let is_target = is_of(target, number, body, trajectory);
                if !is_target {
                    let instance = instance_of(number as usize, &artifacts[0])?;
                    let (origin, person) = (Origin::Body(Arc::clone(&traffic), number), Person::of(body, traffic.dt_s));
                    candidates.push(Candidate { instance, place: candidates.len(), origin, person });
                }
            }
            continue;
        }
        for (item, artifact) in artifacts.iter().enumerate() {
            let walk = walk(inputs, artifact, "walk")?;
            let track = &walk.track;
            if track.is_empty() || !(track.dt_s > 0.0 && track.dt_s.is_finite()) {
                let message = format!("the walk `{}` has no steps", artifact.name);
                return Err(Diagnostic::new("crowd-walk", Fault::Input, message));
            }
            if track.states == trajectory.track.states {
                continue;
            }
            let instance = instance_of(item, artifact)?;
            let person = Person::on(&walk)?;
            if person.meets(&trajectory.track) {
                left_out += 1;
            } else {
                let origin = Origin::Walk(artifact);
                candidates.push(Candidate { instance, place: candidates.len(), origin, person });
            }
        }
    }
    Ok((candidates, left_out))
}

/// Whether a body of traffic is the target of a flight.
fn is_of(target: Option<&Followed>, number: u32, body: &Body, trajectory: &Trajectory) -> bool {
    target.is_some_and(|it| it.number == number && it.plan == body.plan && trajectory.track.states == body.states)
}

impl Origin<'_> {
    /// Whether two people were moved together, each around the other.
    fn is_with(&self, other: &Origin<'_>) -> bool {
        match (self, other) {
            (Origin::Body(one, _), Origin::Body(other, _)) => Arc::ptr_eq(one, other),
            _ => false,
        }
    }

    /// Whether a person was moved together with the target of a flight.
    fn is_with_target(&self, target: Option<&Followed>, trajectory: &Trajectory) -> bool {
        let Origin::Body(traffic, _) = self else { return false };
        let body = target.and_then(|it| Some((it.number, traffic.bodies.get(it.number as usize)?)));
        body.is_some_and(|(number, body)| is_of(target, number, body, trajectory))
    }
}

/// Leaves out everybody who would walk through the target or through somebody before them: those whose tracks were made apart
/// from each other do not know of each other. More people change nothing for those before them.
fn apart<'a>(mut near: Vec<Candidate<'a>>, trajectory: &Trajectory, target: Option<&Followed>) -> Vec<Candidate<'a>> {
    let track = &trajectory.track;
    let flown_at = Person::target(track, target);
    let target_states = flown_at.states(track);
    near.sort_by_key(|candidate| candidate.place);
    let mut kept: Vec<(Candidate<'a>, Vec<Option<TargetState>>)> = vec![];
    for candidate in near {
        let states = candidate.person.states(track);
        let (origin, own) = (&candidate.origin, (candidate.person.plan(), &states[..]));
        let meets_target = track.radius_m > 0.0
            && !origin.is_with_target(target, trajectory)
            && touch((flown_at.plan(), &target_states), own);
        let meets = |(other, others): &(Candidate<'a>, Vec<_>)| {
            !origin.is_with(&other.origin) && touch((other.person.plan(), others), own)
        };
        if !meets_target && !kept.iter().any(meets) {
            kept.push((candidate, states));
        }
    }
    kept.into_iter().map(|(candidate, _)| candidate).collect()
}

/// Largest id of an object in instance images.
pub fn largest_object(world: &World) -> u32 {
    let objects = world.town.obstacles.iter().map(|obstacle| object_instance(obstacle.object_id));
    objects.max().unwrap_or(TARGET_INSTANCE)
}

/// Place among the stages at port `others` that drones have instead of a stage.
const PLACE_OF_DRONES: usize = 12;

/// Instance id of a drone by its number behind the walk, counted after the ids of objects as those of people are.
pub fn instance_of_drone(number: u32) -> Option<u32> {
    odd_multiple(PLACE_OF_DRONES, number as usize)
}

/// Instance id of a person, counted after the ids of objects: a number that no other person has, and that depends on the
/// places of the stage at the port and of the item in the stage alone. More people, and stages that are added at the end,
/// change no id: the first stage has every second number, the next one every second of the rest, and so on. `None` beyond
/// 32 bits.
fn instance_of(stage: usize, item: usize) -> Option<u32> {
    odd_multiple(stage + usize::from(stage >= PLACE_OF_DRONES), item)
}

/// Number `item` of those that can be halved just so often.
fn odd_multiple(halvings: usize, item: usize) -> Option<u32> {
    let odd = u32::try_from(item).ok()?.checked_mul(2)?.checked_add(1)?;
    odd.checked_mul(1u32.checked_shl(u32::try_from(halvings).ok()?)?)
}

pub fn too_many(artifact: &Artifact) -> Box<Diagnostic> {
    let message = format!("there is no instance id left for `{}`", artifact.id);
    Diagnostic::new("crowd-large", Fault::Recipe, message)
        .hint("connect fewer stages to `inputs.others`, with fewer people in the last ones")
}

impl NearbyStage {
    /// The candidates who may change a pixel or a label of a frame: the renderer draws them or their shadows, or they stand
    /// between camera and target; and no building hides them.
    fn near<'a>(
        &self,
        context: &TaskContext,
        scenery: &Scenery<'_>,
        trajectory: &Trajectory,
        target: Option<&Followed>,
        mut others: Vec<Candidate<'a>>,
    ) -> Result<Vec<Candidate<'a>>> {
        let shooting = Shooting::of(&self.config, trajectory, target, &context.id.item)?;
        let effects = self.config.effects(shooting.camera);
        let (camera, moments_s): (Camera, Vec<f64>) = (effects.ideal_camera(), effects.moments_s());
        let poses: Vec<Pose> = shooting.poses(trajectory);
        let track = &trajectory.track;
        others.iter_mut().for_each(|other| other.person.dress_for(&shooting));
        let mut near = vec![];
        for (frame, target) in track.states.iter().enumerate() {
            context.check_cancelled()?;
            let target = Walker {
                state: *target,
                height_m: track.height_m,
                radius_m: track.radius_m,
                clothes_seed: shooting.clothes_seed,
                gait_phase_rad: 0.0,
                body: shooting.body,
            };
            for offset_s in &moments_s {
                let pose = pose_at(&poses, frame as f64 + offset_s / track.dt_s);
                let outlook = Outlook::new(&camera, &shooting.weather, &pose);
                let eye_in_world = pose.position_in_world;
                let matters = |other: &mut Candidate<'_>| {
                    let walker = other.person.walker(frame as f64 * track.dt_s + offset_s);
                    let Some(walker) = walker else { return false };
                    (outlook.may_show(&walker) || body_rays::is_before(&walker, eye_in_world, &target))
                        && !scenery.buildings.hide(eye_in_world, &outlook.hull(&walker, scenery.lowest_m))
                };
                near.extend(others.extract_if(.., matters));
            }
        }
        Ok(near)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn ids_of_people_differ_and_do_not_depend_on_how_many_there_are() {
        let people = (0..14).flat_map(|stage| (0..300).map(move |item| instance_of(stage, item).unwrap()));
        let ids: BTreeSet<u32> = people.chain((0..8).map(|number| instance_of_drone(number).unwrap())).collect();
        assert_eq!((ids.len(), ids.first()), (14 * 300 + 8, Some(&1)));
        assert_eq!([0, 1, 2].map(|item| instance_of(0, item)), [Some(1), Some(3), Some(5)]);
        assert_eq!([0, 1, 2].map(|item| instance_of(1, item)), [Some(2), Some(6), Some(10)]);
        assert_eq!((instance_of(30, 0), instance_of(30, 1), instance_of(31, 0)), (Some(1 << 31), None, None));
    }
}
