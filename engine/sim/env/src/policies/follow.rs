//! `follow`: keeps the start's offset from the target, without regard to obstacles.

use super::{Baseline, Policy};
use crate::{Action, Environment, VelocityAxes};
use cosfly_frames::DVec3;
use cosfly_surroundings::visibility::aim_point;

/// Rate at which an error of the position is removed, 1/s.
const GAIN: f64 = 0.6;
/// Time for which the target is supposed to walk on as it was last seen, seconds.
const TRUST_S: f64 = 2.0;

pub(super) const BASELINE: Baseline = Baseline {
    name: "follow",
    doc: "keeps the start's offset from the target, without regard to obstacles",
    sees: &["state"],
    make: |environment, _| {
        let (observation, episode) = (environment.observation(), environment.episode());
        Box::new(Follow(episode.start.position_in_world - observation.sighting.target.feet_in_world))
    },
};

/// Place of the drone from the target's feet, world frame, metres.
struct Follow(DVec3);

impl Policy for Follow {
    fn act(&mut self, environment: &Environment) -> Action {
        let (observation, settings) = (environment.observation(), environment.settings());
        let next_s = observation.time_s + settings.step_s;
        let feet = observation.supposed_feet(next_s, TRUST_S);
        let own = observation.motion.position_in_world;
        let mut sighted = observation.sighting.target;
        sighted.feet_in_world = feet;
        let aim = aim_point(&sighted, environment.episode().target.height_m);
        let next = own + settings.step_s * observation.motion.velocity_in_world;
        Action {
            axes: VelocityAxes::World,
            velocity_mps: observation.sighting.velocity_in_world + GAIN * (feet + self.0 - own),
            view: environment.gimbal().rates_to(next, aim, settings.step_s),
            ..Action::default()
        }
    }
}
