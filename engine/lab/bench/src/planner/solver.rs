//! The paper's solver table: the pipeline without a tree, with a tree, and with the boxes near the path alone.
//!
//! `without a tree` tests every box of the town, `tree` queries a BVH over all of them, `near the path` keeps the boxes
//! within 45 m with short lists per frame, and tests eight lines of sight at a time.

use super::scene::Ground;
use crate::clock::timed;
use cosfly_frames::{DVec3, TargetTrack};
use cosfly_geometry::{BoxBvh, BruteForce, SpatialQuery};
use cosfly_planner::paper::{FocusedSurroundings, NearBoxes, Threads, iteration, plan_paper_in};
use cosfly_planner::problem::Problem;
use cosfly_planner::terms::built_in_terms;
use cosfly_planner::{MucoConfig, Preset, Walk};
use cosfly_surroundings::Surroundings;
use cosfly_surroundings::exact::ExactObstacles;
use cosfly_surroundings::ground::GroundGrid;
use cosfly_surroundings::local::LocalObstacles;
use serde::Serialize;
use std::fmt;

/// Number of timed iterations, of which the fastest counts.
const REPEATS: usize = 5;

/// Times of one kind of obstacle queries.
#[derive(Clone, Debug, Serialize)]
pub struct SolverRow {
    /// Kind of obstacle queries.
    pub queries: String,
    /// Number of queried boxes.
    pub boxes: usize,
    /// CPU time of the first path, seconds.
    pub single_s: f64,
    /// CPU time of all paths, seconds.
    pub batch_s: f64,
    /// Whether the batch was run; otherwise its time is the first path's times the number of paths (as in the paper).
    pub batch_was_run: bool,
    /// CPU time of one iteration (gradient, step, cost) at the waypoints of the first path, milliseconds, the fastest
    /// of five.
    pub iteration_ms: f64,
}

/// The solver table of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct SolverTable {
    /// Name of the scene.
    pub scene: String,
    /// Number of waypoints of the first path.
    pub waypoints: usize,
    /// Number of paths of the batch.
    pub paths: usize,
    /// Rows, one per kind of obstacle queries.
    pub rows: Vec<SolverRow>,
}

struct Asked<'a>(ExactObstacles<'a>);

impl FocusedSurroundings for Asked<'_> {
    fn answers(&self) -> &(dyn Surroundings + Sync) {
        &self.0
    }
}

/// Kinds of obstacle queries.
#[derive(Clone, Copy, PartialEq)]
enum Queries {
    Every,
    Tree,
    Near,
}

/// Times the paper's pipeline on the paths of a ground.
pub fn solver(ground: &Ground, config: &MucoConfig) -> SolverTable {
    let config = MucoConfig { preset: Preset::Paper, ..config.clone() };
    let ways =
        [("without a tree", Queries::Every), ("tree over the town", Queries::Tree), ("near the path", Queries::Near)];
    let rows = ways.into_iter().map(|(name, queries)| row(ground, &config, name, queries)).collect();
    SolverTable {
        scene: ground.name.clone(),
        waypoints: ground.tracks.first().map_or(0, TargetTrack::len),
        paths: ground.tracks.len(),
        rows,
    }
}

fn row(ground: &Ground, config: &MucoConfig, name: &str, queries: Queries) -> SolverRow {
    let batch_was_run = queries != Queries::Every;
    let runs = if batch_was_run { ground.tracks.len() } else { ground.tracks.len().min(1) };
    let boxes = &ground.planning_boxes;
    let query: Box<dyn SpatialQuery> = match queries {
        Queries::Every => Box::new(BruteForce::new(boxes)),
        _ => Box::new(BoxBvh::build(boxes.clone())),
    };
    let (mut times_s, mut iteration_ms, mut asked) = (Vec::new(), f64::INFINITY, boxes.len());
    for (index, track) in ground.tracks.iter().take(runs).enumerate() {
        with_surroundings(ground, track, config, query.as_ref(), queries, |problem, surroundings, count| {
            let plan = || plan_paper_in(problem, surroundings, config, &config.paper, Threads::Caller);
            let (flight, cpu_s) = timed(plan);
            times_s.push(cpu_s);
            if index == 0 {
                asked = count;
                iteration_ms = 1e3 * fastest_iteration_s(problem, surroundings, config, &flight.waypoints);
            }
        });
    }
    let single_s = times_s.first().copied().unwrap_or(0.0);
    let sum: f64 = times_s.iter().sum();
    let batch_s = if batch_was_run { sum } else { single_s * ground.tracks.len() as f64 };
    SolverRow { queries: name.to_owned(), boxes: asked, single_s, batch_s, batch_was_run, iteration_ms }
}

fn fastest_iteration_s(
    problem: &Problem<'_>,
    surroundings: &mut dyn FocusedSurroundings,
    config: &MucoConfig,
    waypoints: &[DVec3],
) -> f64 {
    surroundings.focus_on(waypoints);
    let one = || timed(|| iteration(problem, surroundings.answers(), &config.descent, Threads::Caller, waypoints)).1;
    (0..REPEATS).map(|_| one()).fold(f64::INFINITY, f64::min)
}

/// Calls `run` with the problem, the surroundings, and their number of boxes.
fn with_surroundings(
    ground: &Ground,
    track: &TargetTrack,
    config: &MucoConfig,
    query: &dyn SpatialQuery,
    queries: Queries,
    run: impl FnOnce(&Problem<'_>, &mut dyn FocusedSurroundings, usize),
) {
    let terms = built_in_terms(&config.resolved_weights());
    let walk = Walk::of(track);
    let problem =
        Problem { track, view: &config.view, walk: &walk, terms: &terms, built_in: terms.len(), first_frame: 0 };
    let (radius_m, influence_m) = (config.search.filter_radius_m, config.view.safety_influence_m);
    let grid = GroundGrid::sample(track, &*ground.height, radius_m + 10.0);
    if queries == Queries::Near {
        let mut near = LocalObstacles::filter(track, &ground.planning_boxes, &grid, radius_m, influence_m);
        let count = near.count();
        match NearBoxes::new(&near, track.len(), influence_m) {
            Some(mut lanes) => run(&problem, &mut lanes, count),
            None => run(&problem, &mut near, count),
        }
    } else {
        let mut asked = Asked(ExactObstacles::still(track, query, &grid));
        run(&problem, &mut asked, query.len());
    }
}

impl fmt::Display for SolverTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "the paper's pipeline in `{}`, one thread, CPU time", self.scene)?;
        let (single, batch) = (format!("one path ({})", self.waypoints), format!("batch of {}", self.paths));
        writeln!(f, "{:18} {:>6} {single:>16} {batch:>14} {:>12} {:>8}", "obstacles", "boxes", "iteration", "faster")?;
        let slowest_s = self.rows.first().map_or(0.0, |row| row.single_s);
        for row in &self.rows {
            let batch = format!("{}{:.2} s", if row.batch_was_run { "" } else { "~" }, row.batch_s);
            let faster = format!("{:.0}x", slowest_s / row.single_s.max(1e-9));
            writeln!(
                f,
                "{:18} {:>6} {:>14.4} s {batch:>14} {:>9.3} ms {faster:>8}",
                row.queries, row.boxes, row.single_s, row.iteration_ms
            )?;
        }
        writeln!(
            f,
            "paper: ~12 s without, 0.1-0.5 s with a tree; ~240 s and 3-5 s for 20; 2-5 ms per iteration on all cores"
        )
    }
}
