//! One episode, flown by a pilot: its [`Row`] and its log.

use crate::pilot::{Failure, Pilot};
use crate::suite::Task;
use cosfly_env::{Action, End, Environment, Reward, Score, Settings};
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;
use std::sync::Arc;

/// Attempts at an episode whose policy goes away in the middle of it.
const ATTEMPTS: u32 = 3;

/// The outcome of an episode, as results keep it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// Name of the episode.
    pub episode: String,
    /// Group of the episode.
    pub stratum: String,
    /// Reason why the policy ended the episode: it answered wrongly or not in time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub policy_failure: Option<String>,
    /// Mean visibility that the certificate of the expert's flight states, 0..=1.
    pub certified_visibility: f64,
    /// Time between steps, seconds.
    pub step_s: f64,
    /// The outcome.
    pub score: Score,
}

/// An episode that was flown.
pub struct Flown {
    /// Outcome.
    pub row: Row,
    /// One line of JSON per step.
    pub log: String,
}

/// Flies an episode. A policy that goes away in the middle of it begins anew, a few times.
///
/// # Errors
/// The reason why the policy cannot be had, in words: the episode was not flown.
pub fn fly(task: &Task, settings: Settings, pilot: &mut dyn Pilot) -> Result<Flown, String> {
    let mut attempt = 1;
    loop {
        match attempt_at(task, settings, pilot) {
            Ok(flown) => return Ok(flown),
            Err(_) if attempt < ATTEMPTS => attempt += 1,
            Err(reason) => return Err(reason),
        }
    }
}

fn attempt_at(task: &Task, settings: Settings, pilot: &mut dyn Pilot) -> Result<Flown, String> {
    let mut environment = Environment::new(Arc::clone(&task.episode), settings);
    let mut policy_failure = None;
    let mut log = String::new();
    match pilot.begin(&environment, &task.knowledge) {
        Ok(()) => {}
        Err(Failure::Gone(reason)) => return Err(reason),
        Err(Failure::Answer(reason)) => policy_failure = Some(reason),
    }
    while environment.score().end.is_none() && policy_failure.is_none() && environment.score().planned_steps > 0 {
        let asked = environment.wants_action().then(|| pilot.act(&environment)).transpose();
        let action = match asked {
            Ok(action) => action,
            Err(Failure::Gone(reason)) => return Err(reason),
            Err(Failure::Answer(reason)) => {
                policy_failure = Some(format!("at step {}: {reason}", environment.observation().step));
                break;
            }
        };
        let step = environment.step(action.as_ref());
        tell(&mut log, &environment, action.as_ref(), &step.reward, step.end);
    }
    let row = Row {
        episode: task.episode.name.clone(),
        stratum: task.episode.stratum.clone(),
        policy_failure,
        certified_visibility: task.certified_visibility,
        step_s: settings.step_s,
        score: *environment.score(),
    };
    Ok(Flown { row, log })
}

/// Line of a log: the state after a step.
#[derive(Serialize)]
struct Line<'a> {
    step: u32,
    time_s: f64,
    position_in_world: [f64; 3],
    velocity_in_world: [f64; 3],
    yaw_deg: f64,
    pitch_deg: f64,
    target_in_world: [f64; 3],
    visible: f64,
    in_picture: bool,
    tracked: bool,
    /// Velocity ahead, right and up (m/s), yaw and pitch rate (degrees/s), where the policy gave an action before the step.
    #[serde(skip_serializing_if = "Option::is_none")]
    action: Option<[f64; 5]>,
    /// Terms of the reward, unweighted, in the order of the card's list.
    reward: [f64; 6],
    #[serde(skip_serializing_if = "Option::is_none")]
    end: Option<&'a End>,
}

fn tell(log: &mut String, environment: &Environment, action: Option<&Action>, reward: &Reward, end: Option<End>) {
    let seen = environment.observation();
    let target = environment.episode().target_at(seen.time_s);
    let line = Line {
        step: seen.step,
        time_s: seen.time_s,
        position_in_world: seen.motion.position_in_world.to_array(),
        velocity_in_world: seen.motion.velocity_in_world.to_array(),
        yaw_deg: seen.yaw_rad.to_degrees(),
        pitch_deg: seen.pitch_rad.to_degrees(),
        target_in_world: target.feet_in_world.to_array(),
        visible: seen.visible,
        in_picture: seen.in_picture,
        tracked: seen.tracked,
        action: action.map(|action| action.numbers(seen.yaw_rad)),
        reward: reward.terms(),
        end: end.as_ref(),
    };
    let _ = writeln!(log, "{}", serde_json::to_string(&line).unwrap_or_default());
}
