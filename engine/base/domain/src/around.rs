//! [`Around`]: the bodies near one track, cut out of the traffic of a whole town.

use crate::{Body, BodyPlan, OrientedBox, Traffic};
use cosfly_frames::TargetTrack;
use serde::{Deserialize, Serialize};

/// The body that a walk is the track of: of traffic, or one that is not a grown person on foot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Followed {
    /// Name of the traffic; empty for a walk of its own.
    pub traffic: String,
    /// Number of the body in the traffic.
    pub number: u32,
    /// Kind, size and looks.
    pub plan: BodyPlan,
}

impl Followed {
    /// Whether it is body number `number` of a traffic.
    pub fn is(&self, traffic: &str, number: u32) -> bool {
        self.traffic == traffic && self.number == number
    }
}

/// The bodies near one track, with their numbers in the whole traffic.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Around {
    /// Numbers of the bodies in the whole traffic, rising.
    pub numbers: Vec<u32>,
    /// Those bodies alone.
    pub traffic: Traffic,
}

impl Around {
    /// Bodies that come within a distance of a track, seen from above, in some frame; the body `but` left out.
    pub fn of(traffic: &Traffic, track: &TargetTrack, but: Option<u32>, within_m: f64) -> Self {
        let numbers = traffic.near(track, but, within_m);
        let bodies = numbers.iter().map(|number| traffic.bodies[*number as usize].clone()).collect();
        let (name, dt_s, frames) = (traffic.name.clone(), traffic.dt_s, traffic.frames);
        Self { numbers, traffic: Traffic { name, dt_s, frames, bodies, notes: vec![] } }
    }

    /// Numbers and bodies.
    pub fn bodies(&self) -> impl Iterator<Item = (u32, &Body)> {
        self.numbers.iter().copied().zip(&self.traffic.bodies)
    }

    /// Box of each body in every frame, as [`Traffic::boxes`].
    pub fn boxes(&self) -> Vec<Vec<OrientedBox>> {
        (0..).zip(&self.traffic.bodies).map(|(place, _)| self.traffic.boxes(place)).collect()
    }

    /// Present bodies, frame by frame: frame number and place in [`Self::bodies`].
    pub fn present(&self) -> Vec<(u32, u32)> {
        let bodies = || (0..).zip(&self.traffic.bodies);
        let frame = |frame: u32| bodies().filter(move |it| it.1.state(frame).is_some()).map(move |it| (frame, it.0));
        (0..self.traffic.frames).flat_map(frame).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BodyKind;
    use cosfly_frames::{DVec3, Seed, TargetState};

    #[test]
    fn numbers_stay_those_of_the_whole_traffic() {
        let state = |x: f64| TargetState { feet_in_world: DVec3::X * x, heading_rad: 0.0, speed_mps: 0.0 };
        let size_m = DVec3::new(0.5, 0.5, 1.8);
        let plan =
            BodyPlan { source: String::new(), kind: BodyKind::Pedestrian, size_m, looks: Seed([0; 32]), group: None };
        let body = |x: f64, first_frame: u32| Body { plan: plan.clone(), first_frame, states: vec![state(x); 2] };
        let bodies = vec![body(0.0, 0), body(90.0, 0), body(5.0, 1), body(9.0, 0)];
        let traffic = Traffic { name: "street".into(), dt_s: 0.5, frames: 3, bodies, notes: vec!["said".into()] };
        let track = TargetTrack { dt_s: 0.5, height_m: 1.8, radius_m: 0.25, states: vec![state(0.0); 3] };
        let around = Around::of(&traffic, &track, Some(0), 10.0);
        assert_eq!(around.bodies().map(|(number, _)| number).collect::<Vec<_>>(), [2, 3]);
        assert_eq!(around.present(), [(0, 1), (1, 0), (1, 1), (2, 0)]);
    }
}
