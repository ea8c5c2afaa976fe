//! `causal`: the planner, told only what was seen: it plans again and again behind a target that walks on as it was last seen.

use super::plan::FollowedPlan;
use super::{Baseline, Knowledge, Policy};
use crate::{Action, Environment};
use cosfly_domain::PlanOutcome;
use cosfly_frames::{DVec3, TargetState, TargetTrack};
use cosfly_planner::{PlanRequest, StartState, plan_request};
use cosfly_surroundings::visibility::aim_point;

/// Time between plans, seconds.
const EVERY_S: f64 = 1.0;
/// Length of a plan, seconds.
const AHEAD_S: f64 = 8.0;
/// Time for which the target is supposed to walk on as it was last seen, seconds.
const TRUST_S: f64 = 4.0;

pub(super) const BASELINE: Baseline = Baseline {
    name: "causal",
    doc: "plans every second behind a target that walks on as it was last seen, past others who move on as they do now",
    sees: &["state", "map"],
    make: |_, knowledge| Box::new(Causal { knowledge: knowledge.clone(), plan: None, again_s: 0.0 }),
};

struct Causal {
    knowledge: Knowledge,
    plan: Option<FollowedPlan>,
    /// Time of the next plan, seconds.
    again_s: f64,
}

impl Policy for Causal {
    fn act(&mut self, environment: &Environment) -> Action {
        let (observation, settings) = (environment.observation(), environment.settings());
        if observation.time_s >= self.again_s - 1e-9 {
            self.again_s = observation.time_s + EVERY_S;
            // Without a new flight the last one goes on while it lasts.
            if let Some(plan) = planned(environment, &self.knowledge) {
                self.plan = Some(plan);
            }
        }
        let mut target = observation.sighting.target;
        target.feet_in_world = observation.supposed_feet(observation.time_s + settings.step_s, TRUST_S);
        let aim = aim_point(&target, environment.episode().target.height_m);
        match &self.plan {
            Some(plan) => plan.action(environment, aim),
            None => Action {
                view: environment.gimbal().rates_to(observation.motion.position_in_world, aim, settings.step_s),
                ..Action::default()
            },
        }
    }
}

/// A flight from the present state on, behind the supposed target.
fn planned(environment: &Environment, knowledge: &Knowledge) -> Option<FollowedPlan> {
    let (observation, episode) = (environment.observation(), environment.episode());
    let TargetTrack { dt_s, height_m, radius_m, .. } = *episode.target;
    let state = |frame: u32| {
        let feet_in_world = observation.supposed_feet(observation.time_s + f64::from(frame) * dt_s, TRUST_S);
        TargetState { feet_in_world, ..observation.sighting.target }
    };
    let states = (0..=(AHEAD_S / dt_s) as u32).map(state).collect();
    let track = TargetTrack { dt_s, height_m, radius_m, states };
    let place = &episode.place;
    let movers = episode.others.supposed(observation.time_s, track.states.len(), dt_s);
    let ground = |x: f64, y: f64| place.ground_m(x, y);
    let mut request = PlanRequest::new(&track, &place.exact, &place.planning_boxes, &ground, &knowledge.config);
    request.movers = &movers;
    let motion = &observation.motion;
    let (position_in_world, velocity_in_world) = (motion.position_in_world, motion.velocity_in_world);
    request.start = Some(StartState { position_in_world, velocity_in_world });
    let PlanOutcome::Planned(flight) = plan_request(request) else { return None };
    let waypoints: Vec<DVec3> = flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect();
    Some(FollowedPlan::through(&waypoints, observation.time_s, dt_s))
}
