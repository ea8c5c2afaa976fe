//! `expert`: flies the planned flight, which knows the target's future.

use super::plan::FollowedPlan;
use super::{Baseline, Policy};
use crate::{Action, Environment};
use cosfly_surroundings::visibility::aim_point;

pub(super) const BASELINE: Baseline = Baseline {
    name: "expert",
    doc: "flies the planned flight, which knows the target's future",
    sees: &["world"],
    make: |environment, knowledge| {
        let start = [environment.episode().start.position_in_world];
        let waypoints = if knowledge.flight.is_empty() { &start[..] } else { &knowledge.flight };
        Box::new(Expert(FollowedPlan::through(waypoints, 0.0, environment.episode().target.dt_s)))
    },
};

struct Expert(FollowedPlan);

impl Policy for Expert {
    fn act(&mut self, environment: &Environment) -> Action {
        let episode = environment.episode();
        let next_s = environment.observation().time_s + environment.settings().step_s;
        self.0.action(environment, aim_point(&episode.target_at(next_s), episode.target.height_m))
    }
}
