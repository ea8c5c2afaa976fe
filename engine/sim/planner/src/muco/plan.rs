//! The planner's main function: from a request to a certified flight, or the reason why there is none.

use super::attempts::{Found, THOROUGH, escalate};
use super::judge::Judge;
use super::stretches::{STRETCH_FRAMES, plan_stretches};
use super::track_check::check_track;
use crate::baselines::{Baseline, BaselineInput, plan_baseline};
use crate::certificate::{Kinematics, certify, term_costs};
use crate::config::{MucoConfig, Planner};
use crate::obstacles::{exact::ExactMap, exact::ExactObstacles, ground::GroundGrid, local::LocalObstacles};
use crate::paper::pipeline::plan_paper;
use crate::problem::{Problem, frame_number};
use crate::request::{PlanRequest, StartState};
use crate::terms::{TermContext, WeightedTerm, built_in_terms};
use crate::trajectory::{PlanOutcome, Trajectory};
use crate::visibility::aim_point;
use crate::walk::Walk;
use crate::weights::Preset;
use cosfly_frames::{DVec3, Pose, Seed, TargetTrack};
use cosfly_geometry::{OrientedBox, SpatialQuery};

/// Frames before the first that a start state fixes, beside it.
const FRAMES_BEFORE: usize = 2;

/// Plans a flight behind `track`.
///
/// * `exact`: all unsimplified boxes; the certificate is measured against them.
/// * `planning_boxes`: what the solver avoids and looks past (simplified or the same).
/// * `ground`: height of the ground at (x, y), metres; where it is not finite the target's height is taken.
///
/// A `Planned` flight keeps the configured clearance along its whole swept path, and with
/// `limits.require_kinematics` its speed, acceleration and jerk limits; everything else is `Rejected` with the
/// reason. The built-in solver draws no random numbers; `seed` is there for those that will.
pub fn plan(
    track: &TargetTrack,
    exact: &dyn SpatialQuery,
    planning_boxes: &[OrientedBox],
    ground: &dyn Fn(f64, f64) -> f64,
    config: &MucoConfig,
    seed: Seed,
) -> PlanOutcome {
    plan_with_terms(track, exact, planning_boxes, ground, config, Vec::new(), seed)
}

/// [`plan`] with further cost terms beside the paper's nine; they join the search, the refinement and the
/// costs in the output.
pub fn plan_with_terms(
    track: &TargetTrack,
    exact: &dyn SpatialQuery,
    planning_boxes: &[OrientedBox],
    ground: &dyn Fn(f64, f64) -> f64,
    config: &MucoConfig,
    extra: Vec<WeightedTerm>,
    _seed: Seed,
) -> PlanOutcome {
    let mut request = PlanRequest::new(track, exact, planning_boxes, ground, config);
    request.extra_terms = extra;
    plan_request(request)
}

/// [`plan`] with all that may be asked for.
pub fn plan_request(mut request: PlanRequest<'_>) -> PlanOutcome {
    let (track, config) = (request.track, request.config);
    let checked = config.validate().map_err(|(_, message)| message);
    let checked = checked.and_then(|()| check_track(track, config.limits.speed_mps)).and_then(|()| request.validate());
    if let Err(reason) = checked {
        return PlanOutcome::Rejected { track: track.clone(), reason };
    }
    let mut terms = built_in_terms(&config.resolved_weights());
    let built_in = terms.len();
    terms.append(&mut request.extra_terms);
    let found = match request.start {
        None => solve(&request, &terms, built_in, &[]),
        Some(start) => solve_from(&request, &terms, built_in, start),
    };
    match found {
        Ok(found) => publish(&request, &terms, found),
        Err(reason) => PlanOutcome::Rejected { track: track.clone(), reason },
    }
}

/// [`solve`] with frames before the first, in which everything stands where it starts and the drone comes as it does.
fn solve_from(
    request: &PlanRequest<'_>,
    terms: &[WeightedTerm],
    built_in: usize,
    start: StartState,
) -> Result<Found, String> {
    let dt_s = request.track.dt_s;
    let back = |frames: usize| start.position_in_world - frames as f64 * dt_s * start.velocity_in_world;
    let head: Vec<DVec3> = (0..=FRAMES_BEFORE).rev().map(back).collect();
    let movers: Vec<_> = request.movers.iter().map(|places| repeated_before(places)).collect();
    let companions: Vec<_> = request.companions.iter().map(with_frames_before).collect();
    let longer = PlanRequest {
        track: &with_frames_before(request.track),
        extra_terms: Vec::new(),
        start: None,
        companions: &companions,
        movers: &movers,
        first_frame: request.first_frame.saturating_sub(FRAMES_BEFORE as i64),
        ..*request
    };
    solve(&longer, terms, built_in, &head)
}

fn with_frames_before(track: &TargetTrack) -> TargetTrack {
    TargetTrack { states: repeated_before(&track.states), ..track.clone() }
}

fn repeated_before<T: Clone>(values: &[T]) -> Vec<T> {
    let first = values.first().into_iter().flat_map(|first| core::iter::repeat_n(first, FRAMES_BEFORE));
    first.chain(values).cloned().collect()
}

fn solve(request: &PlanRequest<'_>, terms: &[WeightedTerm], built_in: usize, head: &[DVec3]) -> Result<Found, String> {
    let one = |request: &PlanRequest<'_>, head: &[DVec3]| solve_at_once(request, terms, built_in, head);
    // The paper's pipeline needs little memory and no stretches; baselines refuse what is too much for them.
    let at_once = request.config.preset == Preset::Paper || request.config.planner != Planner::Muco;
    if request.track.len() <= STRETCH_FRAMES || at_once {
        one(request, head)
    } else {
        plan_stretches(request, head, &one)
    }
}

fn solve_at_once(
    request: &PlanRequest<'_>,
    terms: &[WeightedTerm],
    built_in: usize,
    head: &[DVec3],
) -> Result<Found, String> {
    let (track, config) = (request.track, request.config);
    let walk = Walk::of(track);
    let problem = Problem { track, view: &config.view, walk: &walk, terms, built_in, first_frame: request.first_frame };
    let (radius_m, influence_m) = (config.search.filter_radius_m, config.view.safety_influence_m);
    let grid = GroundGrid::sample(track, request.ground, radius_m + 10.0);
    let mut obstacles = LocalObstacles::filter(track, request.planning_boxes, &grid, radius_m, influence_m)
        .with_companions(request.companions, config.targets.visibility)
        .with_movers(request.movers);
    terms.iter().for_each(|weighted| weighted.term.begin(&problem.context(&obstacles)));
    let exact = ExactMap { query: request.exact, movers: request.movers };
    if let Some(kind) = config.planner.baseline() {
        if !(head.is_empty() && request.companions.is_empty() && request.movers.is_empty()) {
            return Err("baselines know no start states, companions or moving boxes; `planner` must be `muco`".into());
        }
        let (planning_boxes, ground) = (request.planning_boxes, &grid);
        let input = BaselineInput { problem: &problem, planning_boxes, exact: request.exact, ground, config };
        let judge = Judge::new(&problem, exact, request.ground, config, head);
        return by_a_baseline(kind, &input, &judge);
    }
    let mut judge = Judge::new(&problem, exact, request.ground, config, head);
    if config.preset == Preset::Paper && head.is_empty() {
        return by_the_paper(&problem, &mut obstacles, config, &mut judge);
    }
    escalate(&problem, &mut obstacles, config, &mut judge)
}

/// A baseline's path, judged like any flight.
fn by_a_baseline(kind: Baseline, input: &BaselineInput<'_>, judge: &Judge<'_>) -> Result<Found, String> {
    let waypoints = plan_baseline(kind, input)?.waypoints;
    let mut measured = judge.measure(&waypoints);
    if !judge.publishable(&measured) {
        return Err(measured.certificate.violations.join("; "));
    }
    measured.certificate.attempts = 1;
    Ok(Found { waypoints, measured, convergence: Vec::new() })
}

/// The paper's own pipeline, made flyable if the recipe leaves that on.
fn by_the_paper(
    problem: &Problem<'_>,
    obstacles: &mut LocalObstacles<'_>,
    config: &MucoConfig,
    judge: &mut Judge<'_>,
) -> Result<Found, String> {
    let flight = plan_paper(problem, obstacles, config);
    let (mut waypoints, mut measured) = (flight.waypoints.clone(), judge.measure(&flight.waypoints));
    judge.iterations = flight.iterations;
    if config.paper.make_flyable && !measured.certificate.holds {
        obstacles.focus_on(&waypoints);
        (waypoints, measured) = judge.make_flyable(obstacles, &flight.waypoints, &flight.waypoints, THOROUGH);
    }
    if !judge.publishable(&measured) {
        return Err(measured.certificate.violations.join("; "));
    }
    measured.certificate.attempts = 1;
    measured.certificate.iterations = judge.iterations;
    measured.certificate.filtered_boxes = obstacles.count() as u32;
    obstacles.focus_on(&waypoints);
    let mut convergence = flight.convergence;
    convergence.push(problem.cost(obstacles, &waypoints));
    Ok(Found { waypoints, measured, convergence })
}

/// The flight as it is handed out: without the frames before the first, with poses and the costs of all terms.
fn publish(request: &PlanRequest<'_>, terms: &[WeightedTerm], found: Found) -> PlanOutcome {
    let (track, config) = (request.track, request.config);
    let map = ExactMap { query: request.exact, movers: request.movers };
    let before = found.waypoints.len().saturating_sub(track.len());
    let mut measured = found.measured;
    let waypoints = &found.waypoints[before..];
    if before > 0 {
        let whole = measured.certificate;
        measured = certify(track, waypoints, map, request.ground, config);
        let kinematics = Kinematics::of(&found.waypoints, track.dt_s);
        let certificate = &mut measured.certificate;
        certificate.max_speed_mps = kinematics.speed_mps;
        certificate.max_acceleration_mps2 = kinematics.acceleration_mps2;
        certificate.max_jerk_mps3 = kinematics.jerk_mps3;
        (certificate.holds, certificate.violations) = (whole.holds, whole.violations);
        (certificate.lattice_visibility, certificate.visibility_regret) =
            (whole.lattice_visibility, whole.visibility_regret);
        (certificate.attempts, certificate.searches) = (whole.attempts, whole.searches);
        (certificate.iterations, certificate.filtered_boxes) = (whole.iterations, whole.filtered_boxes);
        (certificate.occlusion_ordered_s, certificate.occlusion_reached_s) =
            (whole.occlusion_ordered_s, whole.occlusion_reached_s);
    }
    let walk = Walk::of(track);
    let grid = GroundGrid::sample(track, request.ground, config.search.filter_radius_m + 10.0);
    let surroundings =
        ExactObstacles { track, map, ground: &grid, known: waypoints, known_visibility: &measured.visibility };
    let context = TermContext { track, view: &config.view, walk: &walk, surroundings: &surroundings };
    terms.iter().for_each(|weighted| weighted.term.begin(&context));
    let costs = term_costs(terms, waypoints, &context);
    let pose = |(&w, state): (&DVec3, &_)| Pose::looking_at(w, aim_point(state, track.height_m));
    let flight = Trajectory {
        track: track.clone(),
        poses_in_world: waypoints.iter().zip(&track.states).map(pose).collect(),
        visibility: measured.visibility.clone(),
        clearance_m: measured.clearance_m,
        terms: costs,
        convergence: found.convergence,
        certificate: measured.certificate,
        perturbation: None,
    };
    match not_a_number(&flight, request.first_frame) {
        Some(reason) => PlanOutcome::Rejected { track: track.clone(), reason },
        None => PlanOutcome::Planned(Box::new(flight)),
    }
}

/// Terms from outside may return anything; a flight with such a cost is not published.
fn not_a_number(flight: &Trajectory, first: i64) -> Option<String> {
    flight.terms.iter().find_map(|term| {
        let frame = term.per_frame.iter().position(|cost| !cost.is_finite())?;
        Some(format!(
            "cost term `{}` is {} at frame {}; it must be a finite number",
            term.name,
            term.per_frame[frame],
            frame_number(first, frame)
        ))
    })
}
