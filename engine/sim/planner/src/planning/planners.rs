//! The neutral dispatcher: hands a problem to the planner that the recipe names, and judges what it returns.

use super::causal::fly;
use super::stretches::{LONG, SHORT, plan_stretches};
use crate::baselines::{baseline::Baseline, input::BaselineInput, plan::plan_baseline};
use crate::config::foresight::Foresight;
use crate::config::muco::MucoConfig;
use crate::config::planner::Planner;
use crate::error::PlanError;
use crate::found::Found;
use crate::muco::attempts::{THOROUGH, escalate};
use crate::muco::judge::Judge;
use crate::paper::pipeline::plan_paper;
use crate::problem::Problem;
use crate::request::PlanRequest;
use crate::terms::term::WeightedTerm;
use crate::walk::Walk;
use crate::weights::Preset;
use cosfly_frames::DVec3;
use cosfly_surroundings::ground::GroundGrid;
use cosfly_surroundings::local::LocalObstacles;

/// The planner of a recipe.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Solver {
    /// The optimiser.
    Muco,
    /// The paper's own pipeline.
    Paper,
    /// A planner to compare with.
    Baseline(Baseline),
}

impl Solver {
    fn of(config: &MucoConfig) -> Self {
        match config.planner {
            Planner::Muco if config.preset == Preset::Paper => Self::Paper,
            Planner::Muco => Self::Muco,
            Planner::Astar => Self::Baseline(Baseline::AstarFast),
            Planner::AstarSmoothed => Self::Baseline(Baseline::AstarSmoothed),
            Planner::Beam => Self::Baseline(Baseline::Beam),
            Planner::Dp => Self::Baseline(Baseline::Dp),
        }
    }
}

/// A valid flight that begins with the waypoints `head` (world frame, metres; often none), or the reason why there is
/// none. `built_in` of the `terms` are the paper's.
pub(super) fn solve(
    request: &PlanRequest<'_>,
    terms: &[WeightedTerm],
    built_in: usize,
    head: &[DVec3],
) -> Result<Found, PlanError> {
    let solver = Solver::of(request.config);
    let one = |request: &PlanRequest<'_>, head: &[DVec3]| solve_at_once(solver, request, terms, built_in, head);
    if request.config.foresight == Foresight::Causal {
        return match solver {
            Solver::Muco => fly(request, head, &one),
            _ => Err(PlanError::Request(
                "`foresight = \"causal\"` is for `planner = \"muco\"` and presets of its own".to_owned(),
            )),
        };
    }
    // The paper's pipeline needs little memory and no stretches; baselines refuse what is too much for them.
    if solver != Solver::Muco {
        return one(request, head);
    }
    // One hard place is no reason to do without a long flight: shorter stretches leave it to one of them.
    let at_once_or_not = |request: &PlanRequest<'_>, head: &[DVec3]| {
        let planned = one(request, head);
        if planned.is_ok() || request.track.len() <= SHORT[0].frames {
            return planned;
        }
        plan_stretches(request, head, &SHORT, &one)
    };
    if request.track.len() <= LONG[0].frames {
        at_once_or_not(request, head)
    } else {
        plan_stretches(request, head, &LONG, &at_once_or_not)
    }
}

fn solve_at_once(
    solver: Solver,
    request: &PlanRequest<'_>,
    terms: &[WeightedTerm],
    built_in: usize,
    head: &[DVec3],
) -> Result<Found, PlanError> {
    let (track, config) = (request.track, request.config);
    let walk = Walk::of(track);
    let problem = Problem { track, view: &config.view, walk: &walk, terms, built_in, first_frame: request.first_frame };
    let (radius_m, influence_m) = (config.search.filter_radius_m, config.view.safety_influence_m);
    let sampled;
    let ground = match request.ground_grid {
        Some(grid) => grid,
        None => {
            sampled = request.sampled_ground();
            &sampled
        }
    };
    let mut obstacles = LocalObstacles::filter(track, request.planning_boxes, ground, radius_m, influence_m)
        .with_companions(request.companions, config.targets.visibility)
        .with_drones(request.movers, request.drones, config.limits.clearance_m);
    terms.iter().for_each(|weighted| weighted.term.begin(&problem.context(&obstacles)));
    let exact = request.map();
    let mut judge = Judge::new(&problem, exact, request.ground, config, head);
    match solver {
        Solver::Baseline(kind) => by_a_baseline(kind, request, &problem, ground, &judge),
        Solver::Paper if head.is_empty() => by_the_paper(&problem, &mut obstacles, config, &mut judge),
        // The paper knows no given starts: the optimiser takes those, with the paper's weights.
        Solver::Paper | Solver::Muco => escalate(&problem, &mut obstacles, config, &mut judge),
    }
}

/// A baseline's path, judged like any flight.
fn by_a_baseline(
    kind: Baseline,
    request: &PlanRequest<'_>,
    problem: &Problem<'_>,
    ground: &GroundGrid,
    judge: &Judge<'_>,
) -> Result<Found, PlanError> {
    if !(judge.head.is_empty() && request.companions.is_empty()) {
        return Err(PlanError::Request(
            "baselines know no start states or companions; `planner` must be `muco`".into(),
        ));
    }
    let PlanRequest { planning_boxes, exact, movers, config, .. } = *request;
    let input = BaselineInput { problem, planning_boxes, exact, movers, ground, config };
    let waypoints = plan_baseline(kind, &input)?.waypoints;
    let mut measured = judge.measure(&waypoints);
    if !judge.publishable(&measured) {
        return Err(PlanError::Rules(measured.certificate.violations));
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
) -> Result<Found, PlanError> {
    let flight = plan_paper(problem, obstacles, config);
    let (mut waypoints, mut measured) = (flight.waypoints.clone(), judge.measure(&flight.waypoints));
    judge.iterations = flight.iterations;
    if config.paper.make_flyable && !measured.certificate.holds {
        obstacles.focus_on(&waypoints);
        (waypoints, measured) = judge.make_flyable(obstacles, &flight.waypoints, &flight.waypoints, THOROUGH);
    }
    if !judge.publishable(&measured) {
        return Err(PlanError::Rules(measured.certificate.violations));
    }
    measured.certificate.attempts = 1;
    measured.certificate.iterations = judge.iterations;
    measured.certificate.filtered_boxes = obstacles.count() as u32;
    obstacles.focus_on(&waypoints);
    let mut convergence = flight.convergence;
    convergence.push(problem.cost(obstacles, &waypoints));
    Ok(Found { waypoints, measured, convergence })
}
