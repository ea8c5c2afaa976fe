//! [`Prescribed`]: bodies whose tracks are known beforehand: recorded tracks, scripted routes.

use crate::{Population, Snapshot};
use cosfly_domain::{Body, BodyPlan};
use cosfly_frames::TargetState;

/// Bodies whose states at all frames are known; between frames they go on evenly.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prescribed {
    bodies: Vec<Body>,
    dt_s: f64,
    notes: Vec<String>,
    /// Present time, in frames.
    now: f64,
}

impl Prescribed {
    /// Bodies with states every `dt_s` seconds. Those without a state are left out.
    pub fn new(mut bodies: Vec<Body>, dt_s: f64, notes: Vec<String>) -> Self {
        bodies.retain(|body| !body.states.is_empty());
        Self { bodies, dt_s, notes, now: 0.0 }
    }

    /// The bodies and their states.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }
}

impl Population for Prescribed {
    fn plans(&self) -> Vec<BodyPlan> {
        self.bodies.iter().map(|body| body.plan.clone()).collect()
    }

    fn state(&self, body: usize) -> Option<TargetState> {
        let body = self.bodies.get(body)?;
        // A whole frame is met in spite of rounding.
        let nearest = self.now.round();
        let now = if (self.now - nearest).abs() < 1e-6 { nearest } else { self.now };
        let from = *body.state(now as u32)?;
        let share = now - now.floor();
        match body.state(now as u32 + 1) {
            Some(to) if share > 0.0 => Some(from.toward(to, share)),
            // Between the last frame and the one after, the body has left.
            None if share > 0.0 => None,
            _ => Some(from),
        }
    }

    fn step(&mut self, time_s: f64, step_s: f64, _: &Snapshot) {
        self.now = (time_s + step_s) / self.dt_s;
    }

    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Clock, simulate};
    use cosfly_domain::BodyKind;
    use cosfly_frames::{DVec3, Seed};

    #[test]
    fn a_simulation_repeats_the_states_and_absent_frames_stay_absent() {
        let state = |x: f64| TargetState { feet_in_world: DVec3::new(x, 0.0, 0.0), heading_rad: 0.0, speed_mps: 1.0 };
        let plan = BodyPlan {
            source: "7".into(),
            kind: BodyKind::Pedestrian,
            size_m: DVec3::new(0.5, 0.5, 1.7),
            looks: Seed([0; 32]),
            group: None,
        };
        let body = Body { plan, first_frame: 2, states: (0..5).map(|frame| state(0.3 * f64::from(frame))).collect() };
        for dt_s in [0.1, 0.5, 1.0 / 3.0] {
            let clock = Clock::new(20, dt_s, 0.07);
            let bodies = Prescribed::new(vec![body.clone()], dt_s, vec!["a note".into()]);
            let traffic = simulate(&mut [Box::new(bodies) as Box<dyn Population>], clock, |_| Ok::<_, ()>(())).unwrap();
            assert_eq!((&traffic.bodies, traffic.notes.len()), (&vec![body.clone()], 1));
        }
    }
}
