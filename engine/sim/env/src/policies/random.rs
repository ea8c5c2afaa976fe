//! `random`: another random velocity and turn every second.

use super::{Baseline, Policy};
use crate::{Action, Environment};
use cosfly_frames::{DVec3, RandomStream};

/// Time between draws, seconds.
const EVERY_S: f64 = 1.0;
/// Largest component of a velocity, m/s.
const FASTEST_MPS: f64 = 4.0;
/// Largest rate of turning, radians/s.
const TURN_RAD_S: f64 = 0.5;

pub(super) const BASELINE: Baseline = Baseline {
    name: "random",
    doc: "flies at another random velocity every second",
    sees: &["state"],
    make: |environment, _| {
        let stream = environment.episode().seed.stream("random policy");
        Box::new(Random { stream, action: Action::default(), until_s: 0.0 })
    },
};

struct Random {
    stream: RandomStream,
    action: Action,
    until_s: f64,
}

impl Policy for Random {
    fn act(&mut self, environment: &Environment) -> Action {
        let time_s = environment.observation().time_s;
        if time_s >= self.until_s - 1e-9 {
            self.until_s = time_s + EVERY_S;
            let mut draw = |largest: f64| self.stream.uniform(-largest, largest);
            let velocity = [FASTEST_MPS, FASTEST_MPS, 0.25 * FASTEST_MPS].map(&mut draw);
            self.action.velocity_mps = DVec3::from_array(velocity);
            self.action.view.yaw_rad_s = draw(TURN_RAD_S);
            self.action.view.pitch_rad_s = draw(0.25 * TURN_RAD_S);
        }
        self.action
    }
}
