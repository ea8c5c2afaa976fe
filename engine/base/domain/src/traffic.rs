//! [`Traffic`]: all bodies of a town over a stretch of time.

use crate::{Body, OrientedBox};
use cosfly_frames::{DVec3, TargetTrack};
use serde::{Deserialize, Serialize};

/// An absent body lies this far below its nearest state, metres: away from every ray and every flight.
const ABSENT_M: f64 = 10_000.0;

/// All bodies of a town over a stretch of time. The place of a body in the list is its number.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Traffic {
    /// Name, unique in a dataset: that of the stage.
    pub name: String,
    /// Time between frames, seconds.
    pub dt_s: f64,
    /// Number of frames.
    pub frames: u32,
    /// People and vehicles.
    pub bodies: Vec<Body>,
    /// Assumptions and omissions, in words, for the dataset card.
    pub notes: Vec<String>,
}

impl Traffic {
    /// Name of a body among those of all traffics of a dataset, such as `street-b00012`.
    pub fn body_id(traffic: &str, number: u32) -> String {
        format!("{traffic}-b{number:05}")
    }

    /// Track of a body that is present in all frames; `None` otherwise. Vehicles have the radius of the circle around their outline.
    pub fn track(&self, number: u32) -> Option<TargetTrack> {
        let body = self.bodies.get(number as usize)?;
        let is_whole = body.first_frame == 0 && body.states.len() == self.frames as usize;
        let (height_m, radius_m) = (body.plan.size_m.z, body.plan.radius_m());
        is_whole.then(|| TargetTrack { dt_s: self.dt_s, height_m, radius_m, states: body.states.clone() })
    }

    /// Box of a body in every frame; far below the ground where it is absent.
    pub fn boxes(&self, number: u32) -> Vec<OrientedBox> {
        let body = &self.bodies[number as usize];
        let place = |frame: u32| {
            let (nearest, below_m) = match body.state(frame) {
                Some(state) => (Some(state), 0.0),
                None if frame < body.first_frame => (body.states.first(), ABSENT_M),
                None => (body.states.last(), ABSENT_M),
            };
            let shape = nearest.map(|state| body.plan.box_at(state));
            shape.map(|shape| OrientedBox { center_in_world: shape.center_in_world - DVec3::Z * below_m, ..shape })
        };
        (0..self.frames).filter_map(place).collect()
    }

    /// Numbers of the bodies that come within a distance of a track, seen from above, in some frame; the body `but` left out.
    pub fn near(&self, track: &TargetTrack, but: Option<u32>, within_m: f64) -> Vec<u32> {
        let is_near = |body: &Body| {
            (0..).zip(&track.states).any(|(frame, state)| {
                body.state(frame).is_some_and(|other| {
                    let away_m = (other.feet_in_world - state.feet_in_world).truncate().length();
                    away_m - body.plan.radius_m() <= within_m
                })
            })
        };
        (0..).zip(&self.bodies).filter(|(number, body)| Some(*number) != but && is_near(body)).map(|it| it.0).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BodyKind, BodyPlan};
    use cosfly_frames::{Seed, TargetState};

    #[test]
    fn an_absent_body_is_far_below_and_has_no_track() {
        let state = |x: f64| TargetState { feet_in_world: DVec3::new(x, 0.0, 0.0), heading_rad: 0.0, speed_mps: 1.0 };
        let size_m = DVec3::new(0.5, 0.5, 1.8);
        let plan =
            BodyPlan { source: String::new(), kind: BodyKind::Pedestrian, size_m, looks: Seed([0; 32]), group: None };
        let body = Body { plan, first_frame: 1, states: vec![state(0.0), state(1.0)] };
        let whole = Body { first_frame: 0, states: vec![state(5.0); 4], ..body.clone() };
        let traffic = Traffic { dt_s: 0.5, frames: 4, bodies: vec![body, whole], ..Traffic::default() };
        let places: Vec<[f64; 2]> =
            traffic.boxes(0).iter().map(|it| [it.center_in_world.x, it.center_in_world.z]).collect();
        assert_eq!(places, [[0.0, 0.9 - ABSENT_M], [0.0, 0.9], [1.0, 0.9], [1.0, 0.9 - ABSENT_M]]);
        assert_eq!((traffic.track(0), traffic.track(1).unwrap().len()), (None, 4));
        let own = traffic.track(1).unwrap();
        assert_eq!(traffic.near(&own, Some(1), 3.8), [0]);
        assert!(traffic.near(&own, Some(1), 3.7).is_empty());
    }
}
