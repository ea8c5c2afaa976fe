//! Other people during a flight: the walks at port `others`, on the flight's clock.

use crate::codec;
use crate::ports::WALK;
use crate::world::check_same_town;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_frames::{Seed, TargetState, TargetTrack};
use cosfly_pedestrians::PedestrianPath;
use cosfly_render::effects::target_state_at;
use cosfly_render::{Bystander, PersonView, Walker, gait_phase_rad};
use cosfly_schema::{OtherPerson, Sighting};
use cosfly_stage::Inputs;
use std::sync::Arc;

/// Distance between the axes of two bodies below which one would walk through the other, metres.
const APART_M: f64 = 0.6;

/// Other people around one flight.
pub struct Crowd {
    members: Vec<Member>,
    /// Number of walks that were left out, because they lead through the target.
    pub left_out: usize,
    /// Largest instance id that the pictures may hold.
    pub largest_instance: u32,
}

struct Member {
    person: OtherPerson,
    walk: Arc<PedestrianPath>,
    walked_m: Vec<f64>,
    seed: Seed,
}

impl Crowd {
    /// The walks at port `others` without the target's own. `largest_object` is the largest instance id of an object:
    /// people have the ids after it, by their place at the port, so that they keep them in all flights.
    pub fn around(inputs: &Inputs<'_>, target: &TargetTrack, largest_object: u32) -> Result<Self> {
        check_same_town(inputs, "others")?;
        let mut crowd = Self { members: vec![], left_out: 0, largest_instance: largest_object };
        for (place, artifact) in (1u32..).zip(inputs.all("others")) {
            let walk = inputs.decoded(artifact, "walk", |bytes| codec::decode::<PedestrianPath>(WALK, bytes))?;
            let track = &walk.track;
            if track.is_empty() || !(track.dt_s > 0.0 && track.dt_s.is_finite()) {
                let message = format!("the walk `{}` has no steps", artifact.name);
                return Err(Diagnostic::new("crowd-walk", Fault::Input, message));
            }
            let instance = largest_object.saturating_add(place);
            crowd.largest_instance = instance;
            if track.states == target.states {
                continue;
            }
            let member = Member {
                person: OtherPerson {
                    instance,
                    walk_id: artifact.name.to_string(),
                    height_m: track.height_m,
                    radius_m: track.radius_m,
                },
                walked_m: walked_m(&track.states),
                seed: walk_seed(track)?,
                walk,
            };
            match member.meets(target) {
                true => crowd.left_out += 1,
                false => crowd.members.push(member),
            }
        }
        Ok(crowd)
    }

    /// Number of people.
    pub fn len(&self) -> usize {
        self.members.len()
    }

    /// Adds all people at a time, seconds from the flight's first frame.
    pub fn at(&self, time_s: f64, list: &mut Vec<Bystander>) {
        list.extend(
            self.members
                .iter()
                .map(|member| Bystander { walker: member.walker(time_s), instance: member.person.instance }),
        );
    }

    /// Sightings of the people who are seen in a frame.
    pub fn sightings(&self, frame: usize, time_s: f64, seen: &[PersonView]) -> impl Iterator<Item = Sighting> {
        seen.iter().filter_map(move |view| {
            let person = self.members.binary_search_by_key(&view.instance, |member| member.person.instance).ok()?;
            let state = self.members[person].state(time_s);
            Some(Sighting { frame: frame as u32, person: person as u32, state, view: *view })
        })
    }

    /// All people, by instance id.
    pub fn into_people(self) -> Vec<OtherPerson> {
        self.members.into_iter().map(|member| member.person).collect()
    }
}

impl Member {
    /// Frame number of the walk at a time, within the walk.
    fn step(&self, time_s: f64) -> f64 {
        let last = (self.walk.track.len() - 1) as f64;
        (time_s / self.walk.track.dt_s).clamp(0.0, last)
    }

    /// State at a time, seconds; at the end of the walk the person stands still.
    fn state(&self, time_s: f64) -> TargetState {
        let (states, step) = (&self.walk.track.states, self.step(time_s));
        let state = target_state_at(states, step);
        let is_over = time_s > (states.len() - 1) as f64 * self.walk.track.dt_s;
        TargetState { speed_mps: if is_over { 0.0 } else { state.speed_mps }, ..state }
    }

    fn walker(&self, time_s: f64) -> Walker {
        let track = &self.walk.track;
        let step = self.step(time_s);
        let first = step as usize;
        let last = (first + 1).min(track.len() - 1);
        let walked_m = self.walked_m[first] + (self.walked_m[last] - self.walked_m[first]) * (step - first as f64);
        Walker {
            state: self.state(time_s),
            height_m: track.height_m,
            radius_m: track.radius_m,
            clothes_seed: self.seed,
            gait_phase_rad: gait_phase_rad(walked_m, track.height_m),
        }
    }

    /// True where the person walks through a target with a body.
    fn meets(&self, target: &TargetTrack) -> bool {
        let near = |(frame, state): (usize, &TargetState)| {
            let feet = self.state(frame as f64 * target.dt_s).feet_in_world;
            (feet - state.feet_in_world).length() < APART_M
        };
        target.radius_m > 0.0 && target.states.iter().enumerate().any(near)
    }
}

/// Seed of a walker's looks, and of the camera and weather of flights behind them.
pub fn walk_seed(track: &TargetTrack) -> Result<Seed> {
    Ok(Seed(Digest::of(&codec::encode("walk-seed/1", track)?).0))
}

/// Distance walked up to each frame, metres.
pub fn walked_m(states: &[TargetState]) -> Vec<f64> {
    let mut sum_m = 0.0;
    let step_m = |frame: usize| match frame {
        0 => 0.0,
        _ => (states[frame].feet_in_world - states[frame - 1].feet_in_world).length(),
    };
    (0..states.len())
        .map(|frame| {
            sum_m += step_m(frame);
            sum_m
        })
        .collect()
}
