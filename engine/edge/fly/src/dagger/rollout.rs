//! One episode, flown by a mixture of policy and expert, with the expert's action in every state.

use super::kept::ObservationKeeper;
use crate::experts::{KnownFlight, LOOK_AHEAD_S};
use crate::pilot::{Asked, Pilot, PilotFailure};
use crate::suite::EpisodeTask;
use cosfly_diagnose::Result;
use cosfly_domain::PlanOutcome;
use cosfly_env::policies::FollowedPlan;
use cosfly_env::{Action, Environment, EnvironmentSettings, FEATURES};
use cosfly_frames::{DVec3, Seed};
use cosfly_planner::StartState;
use cosfly_surroundings::visibility::aim_point;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A state and what the expert would do in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExpertLabel {
    /// Steps since the beginning of the episode.
    pub step: u32,
    /// Time since the beginning of the episode, seconds.
    pub time_s: f64,
    /// The observation's state.
    pub state: [f32; FEATURES],
    /// The action that was flown: velocity ahead, right, up (m/s), pitch rate, yaw rate (degrees/s).
    pub action: [f32; 5],
    /// The expert's action; none where there is no way on within the limits.
    pub expert_action: Option<[f32; 5]>,
    /// Mean visibility along the expert's way on.
    pub expert_visibility: Option<f64>,
    /// Whether the expert flew.
    pub by_expert: bool,
    /// Whether the target was tracked.
    pub tracked: bool,
}

/// An episode with labels.
#[derive(Clone, Debug, Default)]
pub struct Rollout {
    /// One per step.
    pub labels: Vec<ExpertLabel>,
    /// States from which the expert was asked for its way on, once per frame of the dataset.
    pub asked: u32,
    /// Reason why the policy ended the episode.
    pub policy_failure: Option<String>,
}

/// The share of frames that the expert flies, and the seed that chooses them.
#[derive(Clone, Copy, Debug)]
pub struct PolicyMixture {
    /// Share, 0..=1.
    pub by_expert: f64,
    /// Seed.
    pub seed: Seed,
}

/// Outcome of an episode.
pub enum Attempt {
    /// The episode was flown and labelled.
    Flown(Rollout),
    /// The policy failed, and has given no right answer since the command began: it is not set up. Why.
    Unanswered(String),
    /// The policy cannot be had; why.
    Gone(String),
}

/// Flies an episode. The mixture chooses anew at every frame of the dataset who flies until the next one. `keeper` gets the
/// observations of each label.
///
/// # Errors
/// Errors of the expert.
pub fn rollout(
    task: &EpisodeTask,
    known: &KnownFlight,
    settings: EnvironmentSettings,
    mixture: &PolicyMixture,
    pilot: &mut Asked<'_>,
    keeper: &mut ObservationKeeper,
) -> Result<Attempt> {
    let mut environment = Environment::new(Arc::clone(&task.episode), settings);
    let (mut rollout, mut way) = (Rollout::default(), None);
    let mut choice = mixture.seed.child(&task.episode.name, 0).stream("mixture");
    let (mut by_expert, mut next_frame) = (false, 0);
    keeper.begin();
    if let Err(reason) = pilot.begin(&environment, &task.knowledge) {
        return Ok(Attempt::Gone(reason));
    }
    while environment.score().end.is_none() && environment.score().planned_steps > 0 {
        let observation = *environment.observation();
        let frame = (observation.time_s / task.episode.target.dt_s + 1e-6) as usize;
        if frame >= next_frame {
            next_frame = frame + 1;
            rollout.asked += 1;
            way = way_on(&environment, known, frame)?;
            by_expert = choice.chance(mixture.by_expert);
        }
        let expert = way.as_ref().map(|(plan, seen)| (expert_action(&environment, plan), *seen));
        let own = match pilot.act(&environment) {
            Ok(action) => action,
            Err(PilotFailure::Gone(reason)) => return Ok(Attempt::Gone(reason)),
            Err(PilotFailure::Answer(reason)) if !pilot.has_answered() => return Ok(Attempt::Unanswered(reason)),
            Err(PilotFailure::Answer(reason)) => {
                rollout.policy_failure = Some(format!("at step {}: {reason}", observation.step));
                break;
            }
        };
        keeper.keep(&environment);
        let flown = expert.filter(|_| by_expert).map_or(own, |(action, _)| action);
        let numbers = |action: &Action| action.numbers(observation.yaw_rad).map(|number| number as f32);
        rollout.labels.push(ExpertLabel {
            step: observation.step,
            time_s: observation.time_s,
            state: observation.features().map(|number| number as f32),
            action: numbers(&flown),
            expert_action: expert.map(|(action, _)| numbers(&action)),
            expert_visibility: expert.map(|(_, seen)| seen),
            by_expert: by_expert && expert.is_some(),
            tracked: observation.tracked,
        });
        environment.step(Some(&flown));
    }
    Ok(Attempt::Flown(rollout))
}

/// The expert's way on from the present state, as `ask-expert` gives it, and its mean visibility.
fn way_on(environment: &Environment, known: &KnownFlight, frame: usize) -> Result<Option<(FollowedPlan, f64)>> {
    let track = &known.flight.mission.track;
    if frame + 1 >= track.states.len() {
        return Ok(None);
    }
    let frames = (LOOK_AHEAD_S / track.dt_s).ceil() as usize + 1;
    let motion = environment.observation().motion;
    let start = StartState { position_in_world: motion.position_in_world, velocity_in_world: motion.velocity_in_world };
    let outcome = known.flight.plan_from(&known.world, frame, frames, start, &known.flown)?;
    let PlanOutcome::Planned(flight) = outcome else { return Ok(None) };
    let waypoints: Vec<DVec3> = flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect();
    let plan = FollowedPlan::through(&waypoints, frame as f64 * track.dt_s, track.dt_s);
    Ok(Some((plan, flight.certificate.mean_visibility)))
}

fn expert_action(environment: &Environment, plan: &FollowedPlan) -> Action {
    let episode = environment.episode();
    let next_s = environment.observation().time_s + environment.settings().step_s;
    let action = plan.action(environment, aim_point(&episode.target_at(next_s), episode.target.height_m));
    // What the gimbal can do: nothing beyond it is to be learnt.
    Action { view: environment.gimbal().limits.clamped(&action.view), ..action }
}
