//! Everybody else in the pictures of a flight: those whom part `nearby` found, and the other drones behind the target.

use crate::nearby;
use cosfly_diagnose::Result;
use cosfly_domain::{BodyId, BodyView, Traffic, largest_object_instance};
use cosfly_experts::artifacts;
use cosfly_figures::FigureInPicture;
use cosfly_film::nearby::{NearbyBodies, NearbyWalk};
use cosfly_film::{BodyOnTrack, Shooting};
use cosfly_flight::World;
use cosfly_schema::{OtherBody, Sighting};
use cosfly_stage::{Artifact, Inputs};

/// Other people around one flight, by instance id.
#[derive(Default)]
pub struct Crowd {
    members: Vec<(OtherBody, BodyOnTrack)>,
}

impl Crowd {
    /// The people whom part `nearby` of the same stage found; nobody where it is left out.
    pub fn around(inputs: &Inputs<'_>) -> Result<Self> {
        let Some(artifact) = inputs.all(nearby::NAME).first() else { return Ok(Self::default()) };
        let read = |NearbyWalk { instance, walk_id }: NearbyWalk| {
            let (walk, followed) = artifacts::linked_walk(inputs, artifact, &walk_id)?;
            Ok(member(instance, walk_id, BodyOnTrack::on(&walk, followed.as_ref())?))
        };
        let mut members: Vec<_> =
            artifacts::NEARBY.read(inputs, artifact)?.into_iter().map(read).collect::<Result<_>>()?;
        for NearbyBodies { instances, around } in artifacts::NEARBY_BODIES.find(inputs, artifact)?.unwrap_or_default() {
            for (instance, (number, body)) in instances.into_iter().zip(around.bodies()) {
                let body_id = Traffic::body_id(&around.traffic.name, number);
                members.push(member(instance, body_id, BodyOnTrack::of(body, around.traffic.dt_s)));
            }
        }
        members.sort_by_key(|(other, _)| other.instance);
        Ok(Self { members })
    }

    /// Crowd with the other drones behind the target of `flight`, which have the names of their flights.
    pub fn and_drones(mut self, inputs: &Inputs<'_>, flight: &Artifact, world: &World, dt_s: f64) -> Result<Self> {
        let largest_object = largest_object_instance(&world.town);
        for (number, body) in artifacts::DRONES.find(inputs, flight)?.unwrap_or_default().bodies(dt_s) {
            let instance = BodyId::of_drone(number).and_then(|id| id.instance(largest_object));
            let instance = instance.ok_or_else(|| nearby::too_many(flight))?;
            let person = BodyOnTrack::of(&body, dt_s);
            self.members.push(member(instance, body.plan.source, person));
        }
        self.members.sort_by_key(|(other, _)| other.instance);
        Ok(self)
    }

    /// Crowd dressed for the weather of a flight.
    pub fn dressed_for(mut self, shooting: &Shooting) -> Self {
        for (other, person) in &mut self.members {
            person.dress_for(shooting);
            other.outfit = person.outfit();
        }
        self
    }

    /// Number of people.
    pub fn len(&self) -> usize {
        self.members.len()
    }

    /// Largest instance id of a person; 0 without people.
    pub fn largest_instance(&self) -> u32 {
        self.members.last().map_or(0, |(other, _)| other.instance)
    }

    /// Adds all people at a time, seconds from the flight's first frame.
    pub fn at(&self, time_s: f64, list: &mut Vec<FigureInPicture>) {
        let bystander = |(other, person): &(OtherBody, BodyOnTrack)| {
            Some(FigureInPicture { figure: person.figure(time_s)?, instance: other.instance })
        };
        list.extend(self.members.iter().filter_map(bystander));
    }

    /// Sightings of the people who are seen in a frame.
    pub fn sightings(&self, frame: usize, time_s: f64, seen: &[BodyView]) -> impl Iterator<Item = Sighting> {
        seen.iter().filter_map(move |view| {
            let place = self.members.binary_search_by_key(&view.instance, |(other, _)| other.instance).ok()?;
            let state = self.members[place].1.state(time_s)?;
            Some(Sighting { frame: frame as u32, other: place as u32, state, view: *view })
        })
    }

    /// All bodies, by instance id.
    pub fn into_bodies(self) -> Vec<OtherBody> {
        self.members.into_iter().map(|(other, _)| other).collect()
    }
}

fn member(instance: u32, body_id: String, person: BodyOnTrack) -> (OtherBody, BodyOnTrack) {
    (OtherBody { instance, body_id, plan: person.plan().clone(), outfit: person.outfit() }, person)
}
