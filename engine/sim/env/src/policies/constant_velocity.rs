//! `constant-velocity`: flies on as the target walked at first, without turning the camera.

use super::{Baseline, Policy};
use crate::{Action, Environment, VelocityAxes};
use cosfly_frames::DVec3;

pub(super) const BASELINE: Baseline = Baseline {
    name: "constant-velocity",
    doc: "flies on as the target walked at first, without turning the camera",
    sees: &["state"],
    make: |environment, _| {
        let velocity = environment.observation().sighting.velocity_in_world;
        Box::new(ConstantVelocity(velocity))
    },
};

struct ConstantVelocity(DVec3);

impl Policy for ConstantVelocity {
    fn act(&mut self, _: &Environment) -> Action {
        Action { axes: VelocityAxes::World, velocity_mps: self.0, ..Action::default() }
    }
}
