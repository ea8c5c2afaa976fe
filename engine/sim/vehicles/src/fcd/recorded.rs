//! [`Recorded`]: bodies whose tracks are known in advance, as a population.

use cosfly_frames::{TargetState, real};
use cosfly_world::{Body, BodyPlan, Population, Snapshot};

/// Bodies whose tracks are known in advance. Between frames they move evenly.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recorded {
    /// The bodies with one state per frame.
    pub bodies: Vec<Body>,
    pub(super) dt_s: f64,
    pub(super) time_s: f64,
    pub(super) notes: Vec<String>,
}

impl Population for Recorded {
    fn plans(&self) -> Vec<BodyPlan> {
        self.bodies.iter().map(|body| body.plan.clone()).collect()
    }

    fn state(&self, body: usize) -> Option<TargetState> {
        let at = self.time_s / self.dt_s;
        // Steps add up to frames but for rounding.
        let frame = (at + 1e-6).floor().max(0.0);
        let share = (at - frame).max(0.0);
        let body = &self.bodies[body];
        let state = *body.state(frame as u32)?;
        let Some(next) = body.state(frame as u32 + 1).filter(|_| share > 1e-6) else {
            return Some(state).filter(|_| share <= 1e-6);
        };
        let turn_rad = real::wrap_angle_rad(next.heading_rad - state.heading_rad);
        Some(TargetState {
            feet_in_world: state.feet_in_world.lerp(next.feet_in_world, share),
            heading_rad: real::wrap_angle_rad(state.heading_rad + share * turn_rad),
            speed_mps: state.speed_mps + share * (next.speed_mps - state.speed_mps),
        })
    }

    fn step(&mut self, time_s: f64, step_s: f64, _: &Snapshot) {
        self.time_s = time_s + step_s;
    }

    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }
}
