//! `cosfly ask-expert`: the expert's way on from a state that a drone came into (relabelling, as for DAgger).

mod state;

use crate::arguments::{RecipeArguments, StoreArguments};
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use clap::Parser;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_domain::{Certificate, PlanOutcome, Trajectory};
use cosfly_fly::experts::{Experts, LOOK_AHEAD_S};
use cosfly_frames::DVec3;
use cosfly_planner::StartState;
use cosfly_store::Store;
use serde::Serialize;
use state::State;
use std::fmt::Write as _;
use std::io::BufRead;
use std::path::Path;

/// Ask a finished recipe's expert how to go on from any state of a drone (relabelling, as for DAgger)
#[derive(Debug, Parser)]
#[command(
    name = "ask-expert",
    after_help = "\
Examples:
  cosfly ask-expert recipes/small.toml --trajectory expert-p00000 --frame 5 --position-m 60 60 24
  cosfly ask-expert recipes/small.toml --trajectory perturbed-p00000 --frame 8 --position-m 60 61 24 \\
      --velocity-mps 1 0 0 --horizon-s 4 --json
  cosfly ask-expert recipes/small.toml --batch < states.jsonl > answers.jsonl

A line of a batch is like
  {\"trajectory_id\": \"expert-p00000\", \"frame\": 5, \"position_in_world\": [60, 60, 24],
   \"velocity_in_world\": [1, 0, 0], \"horizon_s\": 4}
velocity_in_world and horizon_s may be left out. Each answer is one line of JSON, written at once. Places are in the world
frame, metres. `cosfly run` must have made the recipe's trajectories before. Exits with 1 when there is no way on."
)]
pub struct Arguments {
    #[command(flatten)]
    recipe: RecipeArguments,
    #[command(flatten)]
    store: StoreArguments,
    /// The trajectory that the drone left, such as expert-p00000; for a twin, its expert answers
    #[arg(long, value_name = "ID", required_unless_present = "batch")]
    trajectory: Option<String>,
    /// Frame of the trajectory at which the drone is in that state
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = from_zero, required_unless_present = "batch")]
    frame: Option<usize>,
    /// Position of the drone, metres
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, required_unless_present = "batch")]
    position_m: Option<Vec<f64>>,
    /// Velocity of the drone, m/s [default: that of the flight in this frame]
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true)]
    velocity_mps: Vec<f64>,
    /// Length of the answer [default: to the trajectory's end]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    horizon_s: Option<f64>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Read states from standard input, one JSON object per line, and answer each with one line of JSON
    #[arg(long, conflicts_with_all = ["trajectory", "frame", "position_m", "velocity_mps", "horizon_s"])]
    batch: bool,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let recipe = self.recipe.load(console)?;
        let store = opened(&self.recipe, &self.store)?;
        let plan = cosfly_runner::plan(&recipe, &store)?;
        let mut experts = Experts::new(plan, &store);
        let (Some(trajectory), Some(frame), Some(position_m)) = (&self.trajectory, self.frame, &self.position_m) else {
            return Ok(batch(&mut experts, console)?);
        };
        let state = State {
            trajectory_id: trajectory.clone(),
            frame,
            position_in_world: triple(position_m),
            velocity_in_world: (!self.velocity_mps.is_empty()).then(|| triple(&self.velocity_mps)),
            horizon_s: self.horizon_s,
        };
        let answer = answer(&mut experts, &state)?;
        console.print(&if self.json { json_line(&answer) } else { told(&answer) })?;
        Ok(if answer.planned { exit::SUCCESS } else { exit::FOUND_PROBLEMS })
    }
}

/// A number of a thing, counted from 0.
fn from_zero(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| "it must be a whole number from 0 on".to_owned())
}

/// The answer to a state.
#[derive(Debug, Serialize)]
struct Answer {
    trajectory_id: String,
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

/// Position and view of the drone; frames and times are the trajectory's.
#[derive(Debug, Serialize)]
struct Waypoint {
    frame: usize,
    time_s: f64,
    position_in_world: [f64; 3],
    yaw_deg: f64,
    pitch_deg: f64,
    visibility: f64,
}

/// The error of a line of a batch.
#[derive(Serialize)]
struct LineError {
    #[serde(skip_serializing_if = "Option::is_none")]
    line: Option<usize>,
    error: Refused,
}

#[derive(Serialize)]
struct Refused {
    code: &'static str,
    message: String,
    hints: Vec<String>,
}

/// The store of a finished recipe.
///
/// # Errors
/// `ask-expert-unfinished`, or the errors of opening it.
pub fn opened(recipe: &RecipeArguments, store: &StoreArguments) -> cosfly_diagnose::Result<Store> {
    let folder = store.folder();
    if store.bucket().is_none() && !folder.exists() {
        return Err(no_store(&recipe.recipe, &folder));
    }
    store.open_to_read()
}

/// Refusal of a store that is absent: asking makes none.
fn no_store(recipe: &Path, folder: &Path) -> Box<Diagnostic> {
    let message = format!("there is no store at `{}`, so nothing was flown yet", folder.display());
    Diagnostic::new("ask-expert-unfinished", Fault::Recipe, message)
        .hint(format!("make it first: `cosfly run {}`, with the same `--set` and `--store`", recipe.display()))
}

fn triple(values: &[f64]) -> [f64; 3] {
    core::array::from_fn(|axis| values.get(axis).copied().unwrap_or(0.0))
}

/// One answer per line of standard input, each at once, so that a program may ask and listen in turn.
fn batch(experts: &mut Experts<'_>, console: &dyn Console) -> cosfly_diagnose::Result<u8> {
    let mut code = exit::SUCCESS;
    let (mut input, mut line, mut number) = (console.input(), Vec::new(), 0);
    loop {
        line.clear();
        number += 1;
        let read = input.read_until(b'\n', &mut line);
        if read.map_err(|error| Diagnostic::io("read standard input", &error))? == 0 {
            return Ok(code);
        }
        if line.trim_ascii().is_empty() {
            continue;
        }
        let (text, code_of_line) = answer_line(experts, &line, Some(number));
        code = code.max(code_of_line);
        if !console.print(&text)? {
            return Ok(code);
        }
    }
}

/// Answer to a state as a line of JSON, and its exit code.
pub fn answer_line(experts: &mut Experts<'_>, line: &[u8], number: Option<usize>) -> (String, u8) {
    match State::of_line(line).and_then(|state| answer(experts, &state)) {
        Ok(answer) => (json_line(&answer), exit::SUCCESS),
        Err(refusal) => {
            let (hints, code) = (refusal.hints.clone(), exit::INPUT.max(exit::code_of(&refusal)));
            let error = Refused { code: refusal.code, message: refusal.to_string(), hints };
            (json_line(&LineError { line: number, error }), code)
        }
    }
}

fn answer(experts: &mut Experts<'_>, state: &State) -> cosfly_diagnose::Result<Answer> {
    let known = experts.flight(&state.trajectory_id)?;
    let track = &known.flight.mission.track;
    state.check(track)?;
    let frames_of = |seconds: f64| ((seconds / track.dt_s).ceil() as usize).saturating_add(1);
    let frames = state.horizon_s.map_or(usize::MAX, frames_of);
    let start = StartState {
        position_in_world: DVec3::from(state.position_in_world),
        velocity_in_world: state
            .velocity_in_world
            .map_or_else(|| own_velocity(&known.flown, state.frame, track.dt_s), DVec3::from),
    };
    let (mut reason, mut waypoints, mut certificate) = (None, Vec::new(), None);
    let planned_frames = frames.max(frames_of(LOOK_AHEAD_S));
    match known.flight.plan_from(&known.world, state.frame, planned_frames, start, &known.flown)? {
        PlanOutcome::Planned(flight) => {
            waypoints = waypoints_of(&flight, state.frame);
            waypoints.truncate(frames);
            certificate = Some(flight.certificate);
        }
        PlanOutcome::Rejected { reason: why, .. } => reason = Some(why),
    }
    let planned = certificate.is_some();
    let (trajectory_id, frame) = (state.trajectory_id.clone(), state.frame);
    Ok(Answer { trajectory_id, frame, planned, reason, waypoints, certificate })
}

/// Velocity of the published flight in a frame, m/s: backward difference, forward in the first frame; 0 without a flight.
fn own_velocity(flown: &[DVec3], frame: usize, dt_s: f64) -> DVec3 {
    let before = frame.saturating_sub(1);
    match (flown.get(before), flown.get(before + 1)) {
        (Some(from), Some(to)) => (*to - *from) / dt_s,
        _ => DVec3::ZERO,
    }
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
        let _ = writeln!(text, "no way on from frame {} of `{}`: {reason}", answer.frame, answer.trajectory_id);
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
        "visibility {:.3}, clearance {:.2} m, at most {:.2} m/s, {:.2} m/s^2, {:.2} m/s^3, yaw {:.1} degrees/s",
        certificate.mean_visibility,
        certificate.min_clearance_m,
        certificate.max_speed_mps,
        certificate.max_acceleration_mps2,
        certificate.max_jerk_mps3,
        certificate.max_yaw_rate_deg_s
    );
    text
}
