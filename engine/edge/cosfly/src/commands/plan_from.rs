//! `cosfly plan-from`: the expert's way on from a state that a drone came into (relabelling, as for DAgger).

use super::expert_of_recipe::Experts;
use super::{Outcome, recipe, store_dir};
use crate::arguments::PlanFromArguments;
use crate::exit;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_frames::DVec3;
use cosfly_planner::{Certificate, PlanOutcome, StartState, Trajectory};
use cosfly_store::Store;
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;
use std::io::{BufRead, Write as _};

/// Shorter horizons are planned as far as this and cut off, so that no way ends in a dead end, seconds.
const LOOK_AHEAD_S: f64 = 15.0;

/// A drone's state beside a trajectory.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct State {
    /// Id of the trajectory.
    trajectory: String,
    /// Frame of it.
    frame: usize,
    /// World frame, metres.
    position: [f64; 3],
    /// World frame, m/s.
    #[serde(default)]
    velocity: [f64; 3],
    /// How much of the way to tell, seconds; to the end of the trajectory unless given.
    horizon_s: Option<f64>,
}

/// The answer to a state.
#[derive(Debug, Serialize)]
struct Answer {
    trajectory: String,
    frame: usize,
    planned: bool,
    /// Why there is no way on.
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    /// One per frame, the given state first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    waypoints: Vec<Waypoint>,
    #[serde(skip_serializing_if = "Option::is_none")]
    certificate: Option<Certificate>,
}

/// Where the drone is and looks; frames and times are the trajectory's.
#[derive(Debug, Serialize)]
struct Waypoint {
    frame: usize,
    time_s: f64,
    position_in_world: [f64; 3],
    yaw_deg: f64,
    pitch_deg: f64,
    visibility: f64,
}

/// What was wrong with a line of a batch.
#[derive(Serialize)]
struct LineError {
    line: usize,
    error: Refused,
}

#[derive(Serialize)]
struct Refused {
    code: &'static str,
    message: String,
    hints: Vec<String>,
}

/// Answers one state from the command line, or each line of standard input.
pub fn plan_from(arguments: &PlanFromArguments) -> Outcome {
    let one = |refusal| vec![refusal];
    let recipe = recipe(&arguments.recipe)?;
    let store = Store::open_to_read(&store_dir(&arguments.store)).map_err(one)?;
    let plan = cosfly_runner::plan(&recipe, &store).map_err(one)?;
    let mut experts = Experts::new(plan, &store);
    let (Some(trajectory), Some(frame), Some(position)) = (&arguments.trajectory, arguments.frame, &arguments.position)
    else {
        return batch(&mut experts).map_err(one);
    };
    let state = State {
        trajectory: trajectory.clone(),
        frame,
        position: triple(position),
        velocity: triple(&arguments.velocity),
        horizon_s: arguments.horizon,
    };
    let answer = answer(&mut experts, &state).map_err(one)?;
    crate::print(&if arguments.json { json_line(&answer) } else { told(&answer) });
    Ok(if answer.planned { exit::SUCCESS } else { exit::FOUND_PROBLEMS })
}

fn triple(values: &[f64]) -> [f64; 3] {
    core::array::from_fn(|axis| values.get(axis).copied().unwrap_or(0.0))
}

/// One answer per line of standard input, each at once, so that a program may ask and listen in turn.
fn batch(experts: &mut Experts<'_>) -> cosfly_diagnose::Result<u8> {
    let mut code = exit::SUCCESS;
    for (index, line) in std::io::stdin().lock().lines().enumerate() {
        let line = line.map_err(|error| Diagnostic::io("read standard input", &error))?;
        if line.trim().is_empty() {
            continue;
        }
        let parsed = serde_json::from_str::<State>(&line).map_err(|error| {
            Diagnostic::new("plan-from-line", Fault::Input, format!("this is not a state: {error}"))
                .hint("a state is like {\"trajectory\": \"expert-p00000\", \"frame\": 40, \"position\": [x, y, z], \"velocity\": [x, y, z]}")
        });
        let text = match parsed.and_then(|state| answer(experts, &state)) {
            Ok(answer) => json_line(&answer),
            Err(refusal) => {
                code = exit::INPUT;
                let hints = refusal.hints.clone();
                let error = Refused { code: refusal.code, message: refusal.to_string(), hints };
                json_line(&LineError { line: index + 1, error })
            }
        };
        let mut out = std::io::stdout().lock();
        if out.write_all(text.as_bytes()).and_then(|()| out.flush()).is_err() {
            // Nobody listens any more.
            break;
        }
    }
    Ok(code)
}

fn answer(experts: &mut Experts<'_>, state: &State) -> cosfly_diagnose::Result<Answer> {
    let known = experts.flight(&state.trajectory)?;
    let track = &known.flight.mission.track;
    if state.frame >= track.len() {
        let message =
            format!("frame {} is beyond `{}`, which has {} frames", state.frame, state.trajectory, track.len());
        return Err(Diagnostic::new("plan-from-frame", Fault::Input, message).hint("frames count from 0"));
    }
    let frames = match state.horizon_s {
        None => usize::MAX,
        Some(horizon) if horizon > 0.0 && horizon.is_finite() => {
            ((horizon / track.dt_s).ceil() as usize).saturating_add(1)
        }
        Some(horizon) => {
            let message = format!("the horizon is {horizon} s; it must be above 0 s");
            return Err(Diagnostic::new("plan-from-horizon", Fault::Input, message));
        }
    };
    let start =
        StartState { position_in_world: DVec3::from(state.position), velocity_in_world: DVec3::from(state.velocity) };
    let (mut reason, mut waypoints, mut certificate) = (None, Vec::new(), None);
    let planned_frames = frames.max((LOOK_AHEAD_S / track.dt_s).ceil() as usize + 1);
    match known.flight.plan_from(&known.world, state.frame, planned_frames, start) {
        PlanOutcome::Planned(flight) => {
            waypoints = waypoints_of(&flight, state.frame);
            waypoints.truncate(frames);
            certificate = Some(flight.certificate);
        }
        PlanOutcome::Rejected { reason: why, .. } => reason = Some(why),
    }
    let planned = certificate.is_some();
    Ok(Answer { trajectory: state.trajectory.clone(), frame: state.frame, planned, reason, waypoints, certificate })
}

fn waypoints_of(flight: &Trajectory, first: usize) -> Vec<Waypoint> {
    let all = flight.poses_in_world.iter().zip(&flight.visibility).enumerate();
    let waypoint = |(k, (pose, seen)): (usize, (&cosfly_frames::Pose, &f64))| Waypoint {
        frame: first + k,
        time_s: (first + k) as f64 * flight.track.dt_s,
        position_in_world: pose.position_in_world.to_array(),
        yaw_deg: pose.yaw_rad.to_degrees(),
        pitch_deg: pose.pitch_rad.to_degrees(),
        visibility: *seen,
    };
    all.map(waypoint).collect()
}

fn json_line(value: &impl Serialize) -> String {
    let mut text = serde_json::to_string(value).unwrap_or_default();
    text.push('\n');
    text
}

/// The answer for people.
fn told(answer: &Answer) -> String {
    let mut text = String::new();
    if let Some(reason) = &answer.reason {
        let _ = writeln!(text, "no way on from frame {} of `{}`: {reason}", answer.frame, answer.trajectory);
    }
    let Some(certificate) = &answer.certificate else { return text };
    let _ = writeln!(text, "frame   time s         x m         y m       z m   yaw deg  pitch deg  visible");
    for it in &answer.waypoints {
        let [x, y, z] = it.position_in_world;
        let _ = writeln!(
            text,
            "{:5}  {:7.2}  {x:10.3}  {y:10.3}  {z:8.3}  {:8.2}  {:9.2}  {:7.3}",
            it.frame, it.time_s, it.yaw_deg, it.pitch_deg, it.visibility
        );
    }
    let _ = writeln!(
        text,
        "visibility {:.3}, clearance {:.2} m, at most {:.2} m/s, {:.2} m/s^2, {:.2} m/s^3",
        certificate.mean_visibility,
        certificate.min_clearance_m,
        certificate.max_speed_mps,
        certificate.max_acceleration_mps2,
        certificate.max_jerk_mps3
    );
    text
}
