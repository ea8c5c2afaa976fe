//! One episode, flown by a pilot: its [`Row`] and its log.

use crate::log::LogLine;
use crate::pilot::{Asked, Pilot, PilotFailure};
use crate::suite::EpisodeTask;
use cosfly_drone::Sensed;
use cosfly_drone::quadrotor::TrackingError;
use cosfly_env::{Action, Environment, EnvironmentSettings, EpisodeScore};
use cosfly_frames::DVec3;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::time::Instant;

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
    /// Mean distance from the expert's flight at its waypoints that were reached, metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from_expert_m: Option<f64>,
    /// How well a quadrotor could do what it was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strain: Option<StrainRow>,
    /// Mean time that the policy took for an action, where latencies are measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_latency_s: Option<f64>,
    /// The outcome.
    pub score: EpisodeScore,
}

/// How well a quadrotor could do what it was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StrainRow {
    /// Share of the time in which a rotor was asked for more or less thrust than it has.
    pub saturated: f64,
    /// Mean distance from its setpoints; none without setpoints.
    pub tracking_error_m: Option<f64>,
    /// Largest distance from its setpoints.
    pub largest_tracking_error_m: f64,
}

impl From<&TrackingError> for StrainRow {
    fn from(strain: &TrackingError) -> Self {
        let share = |sum: f64, count: u64| (count > 0).then(|| sum / count as f64);
        Self {
            saturated: share(strain.saturated_ticks as f64, strain.ticks).unwrap_or(0.0),
            tracking_error_m: share(strain.error_sum_m, strain.followed_ticks),
            largest_tracking_error_m: strain.largest_error_m,
        }
    }
}

/// An episode that was flown.
pub struct FlownEpisode {
    /// Outcome.
    pub row: Row,
    /// The steps.
    pub steps: Vec<LogLine>,
    /// Samples of the sensors, by time.
    pub sensed: Vec<Sensed>,
}

/// Time that a policy takes for an action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Latency {
    /// The latency of the settings, in simulated time.
    Simulated,
    /// Time of the clock; rows and logs differ from run to run.
    Measured,
}

/// Outcome of an episode.
pub enum Attempt {
    /// The episode was flown; the policy may have ended it by its fault.
    Flown(Box<FlownEpisode>),
    /// The policy failed, and has given no right answer since the command began: it is not set up, and this is no episode. Why.
    Unanswered(String),
    /// The policy cannot be had; why.
    Gone(String),
}

/// Flies an episode. A policy that has answered and goes away in the middle of an episode begins anew, a few times.
pub fn fly(task: &EpisodeTask, settings: EnvironmentSettings, latency: Latency, pilot: &mut Asked<'_>) -> Attempt {
    let mut attempt = 1;
    loop {
        if let Err(reason) = pilot.begin(&Environment::new(Arc::clone(&task.episode), settings), &task.knowledge) {
            return Attempt::Gone(reason);
        }
        let mut ask = |environment: &Environment| {
            let asked_at = (latency == Latency::Measured).then(Instant::now);
            let action = pilot.act(environment)?;
            Ok((action, asked_at.map(|asked_at| asked_at.elapsed().as_secs_f64())))
        };
        match fly_by(task, settings, &mut ask) {
            Ok(flown) => {
                return match flown.row.policy_failure {
                    Some(reason) if !pilot.has_answered() => Attempt::Unanswered(reason),
                    _ => Attempt::Flown(Box::new(flown)),
                };
            }
            Err(_) if attempt < ATTEMPTS && pilot.has_answered() => attempt += 1,
            Err(reason) => return Attempt::Gone(reason),
        }
    }
}

/// An action, and the time that it took where latencies are measured, seconds.
pub type Given = (Action, Option<f64>);

/// Flies an episode by the actions that `ask` gives.
///
/// # Errors
/// The reason of [`PilotFailure::Gone`].
pub fn fly_by(
    task: &EpisodeTask,
    settings: EnvironmentSettings,
    ask: &mut dyn FnMut(&Environment) -> Result<Given, PilotFailure>,
) -> Result<FlownEpisode, String> {
    let mut environment = Environment::new(Arc::clone(&task.episode), settings);
    let mut policy_failure = None;
    let mut steps: Vec<LogLine> = Vec::new();
    while environment.score().end.is_none() && policy_failure.is_none() && environment.score().planned_steps > 0 {
        let asked = environment.wants_action().then(|| ask(&environment)).transpose();
        let given = match asked {
            Ok(given) => given,
            Err(PilotFailure::Gone(reason)) => return Err(reason),
            Err(PilotFailure::Answer(reason)) => {
                policy_failure = Some(format!("at step {}: {reason}", environment.observation().step));
                break;
            }
        };
        let (action, taken_s) = given.map_or((None, None), |(action, taken_s)| (Some(action), taken_s));
        let step = environment.step_late(action.as_ref(), taken_s.unwrap_or(settings.latency_s));
        let line = LogLine::of(&environment, action.as_ref(), &step.reward, step.end);
        steps.push(LogLine { latency_s: taken_s, ..line });
    }
    let row = Row {
        episode: task.episode.name.clone(),
        stratum: task.episode.stratum.clone(),
        policy_failure,
        certified_visibility: task.certified_visibility,
        step_s: settings.step_s,
        from_expert_m: from_expert_m(task, &steps),
        strain: environment.tracking_error().map(StrainRow::from),
        mean_latency_s: mean(steps.iter().filter_map(|step| step.latency_s)),
        score: *environment.score(),
    };
    Ok(FlownEpisode { row, steps, sensed: environment.sensed().to_vec() })
}

/// Mean distance from the expert's flight at those of its waypoints that fall on steps.
fn from_expert_m(task: &EpisodeTask, steps: &[LogLine]) -> Option<f64> {
    let dt_s = task.episode.target.dt_s;
    mean(steps.iter().filter_map(|step| {
        let frame = (step.time_s / dt_s).round();
        let waypoint = task.knowledge.flight.get(frame as usize)?;
        let is_there = (frame * dt_s - step.time_s).abs() < 1e-6;
        is_there.then(|| waypoint.distance(DVec3::from_array(step.position_in_world)))
    }))
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    (count > 0.0).then(|| sum / count)
}
