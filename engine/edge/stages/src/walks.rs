//! People on their walks, by the clock of a flight.

use crate::codec;
use cosfly_diagnose::Result;
use cosfly_fingerprint::Digest;
use cosfly_frames::{Seed, TargetState, TargetTrack};
use cosfly_pedestrians::PedestrianPath;
use cosfly_render::effects::target_state_at;
use cosfly_render::{BodyShape, Clothes, Outfit, Walker, gait_phase_rad};
use std::sync::Arc;

/// Distance between the axes of two bodies below which one would walk through the other, metres.
const APART_M: f64 = 0.6;

/// A person on a walk that has at least one step.
pub struct Person {
    walk: Arc<PedestrianPath>,
    walked_m: Vec<f64>,
    seed: Seed,
}

impl Person {
    /// The person on `walk`.
    pub fn on(walk: Arc<PedestrianPath>) -> Result<Self> {
        Ok(Self { walked_m: walked_m(&walk.track.states), seed: walk_seed(&walk.track)?, walk })
    }

    /// Clothes of the person.
    pub fn outfit(&self) -> Outfit {
        Clothes::draw(&self.seed).outfit
    }

    /// State at a time, seconds from the flight's first frame; at the end of the walk the person stands still.
    pub fn state(&self, time_s: f64) -> TargetState {
        let (states, step) = (&self.walk.track.states, self.step(time_s));
        let state = target_state_at(states, step);
        let is_over = time_s > (states.len() - 1) as f64 * self.walk.track.dt_s;
        TargetState { speed_mps: if is_over { 0.0 } else { state.speed_mps }, ..state }
    }

    /// State and looks at a time, seconds from the flight's first frame.
    pub fn walker(&self, time_s: f64) -> Walker {
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
            body: BodyShape::default(),
        }
    }

    /// True where the person walks through a target with a body.
    pub fn meets(&self, target: &TargetTrack) -> bool {
        let near = |(frame, state): (usize, &TargetState)| {
            let feet = self.state(frame as f64 * target.dt_s).feet_in_world;
            (feet - state.feet_in_world).length() < APART_M
        };
        target.radius_m > 0.0 && target.states.iter().enumerate().any(near)
    }

    /// Frame number of the walk at a time, within the walk.
    fn step(&self, time_s: f64) -> f64 {
        let last = (self.walk.track.len() - 1) as f64;
        (time_s / self.walk.track.dt_s).clamp(0.0, last)
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
