//! People whom traffic moves around: other stages made their walks, and they make way for nobody.

use cosfly_diagnose::Result;
use cosfly_domain::{BodyPlan, Followed, Traffic};
use cosfly_film::BodyOnTrack;
use cosfly_frames::TargetState;
use cosfly_pedestrians::PedestrianPath;
use cosfly_world::{Population, Snapshot, contacts};
use std::collections::BTreeSet;

/// People who walk as their own stages made them, and stand where their walks end.
#[derive(Default)]
pub struct Avoided {
    people: Vec<BodyOnTrack>,
    now_s: f64,
}

impl Avoided {
    /// Adds all bodies of a traffic that one of the walks was taken out of.
    pub fn add_traffic(&mut self, traffic: &Traffic) {
        let bodies = traffic.bodies.iter().filter(|body| !body.states.is_empty());
        self.people.extend(bodies.map(|body| BodyOnTrack::of(body, traffic.dt_s)));
    }

    /// Adds somebody on a walk, `followed` where it is not a grown person on foot; nobody where it has no steps.
    ///
    /// # Errors
    /// Those of [`BodyOnTrack::on`].
    pub fn add_walk(&mut self, walk: &PedestrianPath, followed: Option<&Followed>) -> Result<()> {
        if !walk.track.is_empty() {
            self.people.push(BodyOnTrack::on(walk, followed)?);
        }
        Ok(())
    }

    /// Number of people.
    pub(crate) fn len(&self) -> usize {
        self.people.len()
    }
}

impl Population for Avoided {
    fn plans(&self) -> Vec<BodyPlan> {
        self.people.iter().map(|person| person.plan().clone()).collect()
    }

    fn state(&self, body: usize) -> Option<TargetState> {
        self.people.get(body)?.state(self.now_s)
    }

    fn step(&mut self, time_s: f64, step_s: f64, _: &Snapshot) {
        self.now_s = time_s + step_s;
    }
}

/// Takes the last `count` bodies out of a traffic, who were avoided. Bodies that one of them walks through all the same, such as
/// somebody in an alley too narrow for two, are left without a place; gives the number of those.
pub(crate) fn take_out(traffic: &mut Traffic, count: usize) -> usize {
    let own = traffic.bodies.len() - count;
    if count == 0 {
        return 0;
    }
    let is_own = |number: &u32| (*number as usize) < own;
    let touched = contacts(traffic, 0.0).into_iter().map(|contact| contact.bodies);
    let touched: BTreeSet<u32> = touched.filter(|[one, other]| is_own(one) && !is_own(other)).map(|it| it[0]).collect();
    traffic.bodies.truncate(own);
    touched.iter().for_each(|number| traffic.bodies[*number as usize].states.clear());
    touched.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::{Body, BodyKind};
    use cosfly_frames::{DVec3, Seed};

    #[test]
    fn who_is_avoided_is_taken_out_with_those_whom_they_walk_through() {
        let size_m = DVec3::new(0.5, 0.5, 1.8);
        let plan =
            BodyPlan { source: String::new(), kind: BodyKind::Pedestrian, size_m, looks: Seed([0; 32]), group: None };
        let state = |x: f64| TargetState { feet_in_world: DVec3::X * x, heading_rad: 0.0, speed_mps: 1.0 };
        let body = |x: f64| Body { plan: plan.clone(), first_frame: 0, states: vec![state(x), state(x + 1.0)] };
        let bodies = vec![body(0.0), body(5.0), body(5.2), body(0.4), body(0.3)];
        let mut traffic = Traffic { dt_s: 0.5, frames: 2, bodies, ..Traffic::default() };
        assert_eq!(take_out(&mut traffic, 2), 1);
        let present: Vec<usize> = traffic.bodies.iter().map(|body| body.states.len()).collect();
        assert_eq!(present, [0, 2, 2]);
        assert_eq!(take_out(&mut traffic, 0), 0);
    }
}
