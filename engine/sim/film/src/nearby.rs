//! Bodies near a flight: the people and vehicles who may appear in its pictures, or throw a shadow into them.

use crate::body_rays;
use crate::rate::{FilmedFlight, Rate};
use crate::shooting::Shooting;
use crate::walks::{BodyOnTrack, touch};
use cosfly_diagnose::Result;
use cosfly_domain::{Around, BodyId, Camera, Followed, Town, Traffic, Trajectory, largest_object_instance};
use cosfly_frames::{Pose, TargetState};
use cosfly_pedestrians::PedestrianPath;
use cosfly_render::{Buildings, Outlook, RenderConfig};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::sync::Arc;

/// A person who is near a flight.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NearbyWalk {
    /// Id in instance images (see [`BodyId`]).
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

/// A person or vehicle that may be near.
pub struct NearbyCandidate {
    /// Id in instance images.
    pub instance: u32,
    /// Origin of its track.
    pub origin: Origin,
    /// Place among the candidates: that of their stage, then that of the item.
    place: usize,
    person: BodyOnTrack,
}

/// Origin of a track.
pub enum Origin {
    /// A walk of its own: number of its stage, and of the walk in it.
    Walk(usize, usize),
    /// A body of traffic.
    Body(Arc<Traffic>, u32),
}

/// Reason why somebody cannot be a candidate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CandidateRefusal {
    /// The walk has no steps.
    NoSteps,
    /// No instance id is left.
    NoId,
}

/// Everybody around a flight except its target, and those whose own walk crosses the target's body.
pub struct Candidates<'a> {
    flight: &'a Trajectory,
    target: Option<&'a Followed>,
    largest_object: u32,
    begins_s: f64,
    /// The candidates.
    pub all: Vec<NearbyCandidate>,
    /// Number of those whose walk crosses the target's body.
    pub left_out: usize,
}

impl<'a> Candidates<'a> {
    /// Nobody yet, around `flight` behind `target` in `town`; the flight begins some seconds after the walks.
    pub fn new(town: &Town, (flight, begins_s): (&'a Trajectory, f64), target: Option<&'a Followed>) -> Self {
        let largest_object = largest_object_instance(town);
        Self { flight, target, largest_object, begins_s, all: vec![], left_out: 0 }
    }

    /// Adds the bodies of the traffic that stage number `stage` made.
    ///
    /// # Errors
    /// [`CandidateRefusal::NoId`].
    pub fn add_traffic(&mut self, stage: usize, traffic: &Arc<Traffic>) -> std::result::Result<(), CandidateRefusal> {
        for (number, body) in (0..).zip(&traffic.bodies).filter(|(_, body)| !body.states.is_empty()) {
            if !self.target.is_some_and(|it| it.is(&traffic.name, number)) {
                let instance = self.instance(stage, number as usize)?;
                self.add(instance, Origin::Body(Arc::clone(traffic), number), BodyOnTrack::of(body, traffic.dt_s));
            }
        }
        Ok(())
    }

    /// Adds walk number `item` of stage number `stage`; `followed` where it is not a grown person on foot. `Some` is the reason why that cannot be.
    ///
    /// # Errors
    /// Those of [`BodyOnTrack::on`].
    pub fn add_walk(
        &mut self,
        (stage, item): (usize, usize),
        walk: &PedestrianPath,
        followed: Option<&Followed>,
    ) -> Result<Option<CandidateRefusal>> {
        let track = &walk.track;
        if track.is_empty() || !(track.dt_s > 0.0 && track.dt_s.is_finite()) {
            return Ok(Some(CandidateRefusal::NoSteps));
        }
        let instance = match self.instance(stage, item) {
            Ok(instance) => instance,
            Err(refused) => return Ok(Some(refused)),
        };
        let person = BodyOnTrack::on(walk, followed)?;
        if person.meets(&self.flight.track) {
            self.left_out += 1;
        } else {
            self.add(instance, Origin::Walk(stage, item), person);
        }
        Ok(None)
    }

    fn instance(&self, stage: usize, item: usize) -> std::result::Result<u32, CandidateRefusal> {
        BodyId::of(stage, item).and_then(|id| id.instance(self.largest_object)).ok_or(CandidateRefusal::NoId)
    }

    fn add(&mut self, instance: u32, origin: Origin, person: BodyOnTrack) {
        let (place, person) = (self.all.len(), person.since(self.begins_s));
        self.all.push(NearbyCandidate { instance, place, origin, person });
    }
}

/// Distance over the ground within which sensors meet somebody, metres.
const SENSED_M: f64 = 150.0;

impl Candidates<'_> {
    /// Those whom sensors along the flight may meet and who keep out of each other's way: first those whom pictures show by these
    /// instance ids.
    pub fn sensed(self, seen: &BTreeSet<u32>) -> Vec<NearbyCandidate> {
        let Self { flight, target, mut all, .. } = self;
        all.retain(|candidate| {
            let states = candidate.person.states(&flight.track);
            let is_near = |(state, pose): (&Option<TargetState>, &Pose)| {
                let away = state.as_ref().map(|state| state.feet_in_world - pose.position_in_world);
                away.is_some_and(|away| away.truncate().length() < SENSED_M)
            };
            states.iter().zip(&flight.poses_in_world).any(is_near)
        });
        all.sort_by_key(|candidate| !seen.contains(&candidate.instance));
        all.iter_mut().zip(0..).for_each(|(candidate, place)| candidate.place = place);
        apart(all, flight, target)
    }
}

impl NearbyCandidate {
    /// The person or vehicle.
    pub fn into_body(self) -> BodyOnTrack {
        self.person
    }
}

impl NearbyBodies {
    /// Adds a body to those of its traffic.
    pub fn add(all: &mut Vec<Self>, traffic: &Traffic, number: u32, instance: u32) {
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

/// Parts of a town that hide people.
pub struct Scenery<'a> {
    /// Buildings.
    pub buildings: &'a Buildings,
    /// Height below which there is nothing to be seen, metres.
    pub lowest_m: f64,
}

/// A film of a flight.
pub struct Filming<'a> {
    /// Settings of the pictures.
    pub config: &'a RenderConfig,
    /// Camera, mount and weather.
    pub shooting: &'a Shooting,
    /// Parts of the town that hide people.
    pub scenery: Scenery<'a>,
    /// The flight.
    pub flight: &'a Trajectory,
}

impl Origin {
    /// Whether two people were moved together, each around the other.
    fn is_with(&self, other: &Origin) -> bool {
        match (self, other) {
            (Origin::Body(one, _), Origin::Body(other, _)) => Arc::ptr_eq(one, other),
            _ => false,
        }
    }

    /// Whether a person was moved together with the target of a flight.
    fn is_with_target(&self, target: Option<&Followed>) -> bool {
        matches!(self, Origin::Body(traffic, _) if target.is_some_and(|it| it.traffic == traffic.name))
    }
}

/// Leaves out everybody who would walk through the target or through somebody before them: those whose tracks were made apart
/// from each other do not know of each other. More people change nothing for those before them.
pub fn apart(
    mut near: Vec<NearbyCandidate>,
    trajectory: &Trajectory,
    target: Option<&Followed>,
) -> Vec<NearbyCandidate> {
    let track = &trajectory.track;
    let flown_at = BodyOnTrack::target(track, target);
    let target_states = flown_at.states(track);
    near.sort_by_key(|candidate| candidate.place);
    let mut kept: Vec<(NearbyCandidate, Vec<Option<TargetState>>)> = vec![];
    for candidate in near {
        let states = candidate.person.states(track);
        let (origin, own) = (&candidate.origin, (candidate.person.plan(), &states[..]));
        let meets_target =
            track.radius_m > 0.0 && !origin.is_with_target(target) && touch((flown_at.plan(), &target_states), own);
        let meets = |(other, others): &(NearbyCandidate, Vec<_>)| {
            !origin.is_with(&other.origin) && touch((other.person.plan(), others), own)
        };
        if !meets_target && !kept.iter().any(meets) {
            kept.push((candidate, states));
        }
    }
    kept.into_iter().map(|(candidate, _)| candidate).collect()
}

impl Filming<'_> {
    /// The candidates who may change a pixel or a label of a frame: the renderer draws them or their shadows, or they stand
    /// between camera and target; and no building hides them.
    ///
    /// # Errors
    /// Those of `check`, which is called before each frame.
    pub fn near(
        &self,
        mut others: Vec<NearbyCandidate>,
        check: &dyn Fn() -> Result<()>,
    ) -> Result<Vec<NearbyCandidate>> {
        let Self { shooting, scenery, flight, .. } = self;
        let effects = self.config.effects(shooting.camera);
        let (camera, moments_s): (Camera, Vec<f64>) = (effects.ideal_camera(), effects.moments_s());
        let film = FilmedFlight::new(shooting, flight, self.config);
        let track = &flight.track;
        others.iter_mut().for_each(|other| other.person.dress_for(shooting));
        let mut near = vec![];
        let rate = Rate::of(self.config, track.dt_s);
        for frame in rate.frames(track.len()) {
            check()?;
            let target = shooting.target(track, rate.state(track, frame), 0.0);
            for offset_s in &moments_s {
                for pose in effects.poses(film.pose(frame, *offset_s)) {
                    let outlook = Outlook::new(&camera, &shooting.weather, &pose);
                    let eye_in_world = pose.position_in_world;
                    let matters = |other: &mut NearbyCandidate| {
                        let walker = other.person.figure(rate.time_s(frame) + offset_s);
                        let Some(walker) = walker else { return false };
                        (outlook.may_show(&walker) || body_rays::is_before(&walker, eye_in_world, &target))
                            && !scenery.buildings.hide(eye_in_world, &outlook.hull(&walker, scenery.lowest_m))
                    };
                    near.extend(others.extract_if(.., matters));
                }
            }
        }
        Ok(near)
    }
}
