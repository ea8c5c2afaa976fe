//! Who plans: our planner, the paper's, and the baselines, behind one call.

use super::scene::Ground;
use cosfly_frames::{DVec3, Seed, TargetTrack};
use cosfly_planner::baselines::{Baseline, BaselineInput, plan_baseline};
use cosfly_planner::obstacles::{ground::GroundGrid, local::LocalObstacles};
use cosfly_planner::paper::plan_paper;
use cosfly_planner::problem::Problem;
use cosfly_planner::terms::built_in_terms;
use cosfly_planner::walk::Walk;
use cosfly_planner::{MucoConfig, PlanOutcome, Preset, plan};

/// A planner in the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contender {
    /// Ours, with its default preset.
    Cosfly,
    /// The paper's own pipeline.
    Paper,
    /// One to be measured against.
    Baseline(Baseline),
}

/// A path, before anyone has judged it.
pub struct Planned {
    /// One per frame.
    pub waypoints: Vec<DVec3>,
    /// Nodes expanded by the search; 0 where there is none.
    pub nodes: u64,
    /// Total cost after each iteration of the solver; empty where there is none.
    pub convergence: Vec<f64>,
}

impl Contender {
    /// All, in the order of the table.
    pub fn all() -> Vec<Self> {
        let ours = [Self::Cosfly, Self::Paper];
        ours.into_iter().chain(Baseline::ALL.into_iter().map(Self::Baseline)).collect()
    }

    /// Name in the table and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cosfly => "cosfly",
            Self::Paper => "paper",
            Self::Baseline(baseline) => baseline.name(),
        }
    }

    /// Plans one path; the reason when there is none.
    pub fn plan(self, ground: &Ground, track: &TargetTrack, config: &MucoConfig) -> Result<Planned, String> {
        match self {
            Self::Cosfly => flight(ground, track, &MucoConfig { preset: Preset::Cosfly, ..config.clone() }),
            Self::Paper => Ok(paper_flight(ground, track, &MucoConfig { preset: Preset::Paper, ..config.clone() })),
            Self::Baseline(baseline) => baseline_path(baseline, ground, track, config),
        }
    }
}

fn flight(ground: &Ground, track: &TargetTrack, config: &MucoConfig) -> Result<Planned, String> {
    let seed = Seed::of_item(0, "bench", "planner");
    let height = |x: f64, y: f64| (ground.height)(x, y);
    match plan(track, ground.exact.as_ref(), &ground.planning_boxes, &height, config, seed) {
        PlanOutcome::Planned(flight) => Ok(Planned {
            waypoints: flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect(),
            nodes: 0,
            convergence: flight.convergence,
        }),
        PlanOutcome::Rejected { reason, .. } => Err(reason),
    }
}

/// The paper's flight as it comes, neither certified nor refused.
fn paper_flight(ground: &Ground, track: &TargetTrack, config: &MucoConfig) -> Planned {
    let terms = built_in_terms(&config.resolved_weights());
    let walk = Walk::of(track);
    let problem = Problem { track, view: &config.view, walk: &walk, terms: &terms, built_in: terms.len() };
    let (radius_m, influence_m) = (config.search.filter_radius_m, config.view.safety_influence_m);
    let grid = GroundGrid::sample(track, &*ground.height, radius_m + 10.0);
    let mut obstacles = LocalObstacles::filter(track, &ground.planning_boxes, &grid, radius_m, influence_m);
    let flight = plan_paper(&problem, &mut obstacles, config);
    Planned { waypoints: flight.waypoints, nodes: 0, convergence: flight.convergence }
}

fn baseline_path(
    baseline: Baseline,
    ground: &Ground,
    track: &TargetTrack,
    config: &MucoConfig,
) -> Result<Planned, String> {
    let terms = built_in_terms(&config.resolved_weights());
    let walk = Walk::of(track);
    let problem = Problem { track, view: &config.view, walk: &walk, terms: &terms, built_in: terms.len() };
    let grid = GroundGrid::sample(track, &*ground.height, config.search.filter_radius_m + 10.0);
    let input = BaselineInput {
        problem: &problem,
        planning_boxes: &ground.planning_boxes,
        exact: ground.exact.as_ref(),
        ground: &grid,
        config,
    };
    let found = plan_baseline(baseline, &input)?;
    Ok(Planned { waypoints: found.waypoints, nodes: found.nodes_expanded, convergence: Vec::new() })
}
