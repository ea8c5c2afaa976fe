//! Time of the planner's steps, each timed separately on the same path, and the rest of the whole plan.
//!
//! The library has no clock. Each step is repeated through its public function; `smooth` is the rest of the whole plan:
//! smoothing in the corridor, its measurement, further attempts, and the output of the flight.

use super::contender::Contender;
use super::scene::Ground;
use crate::clock::timed;
use cosfly_frames::TargetTrack;
use cosfly_planner::config::SearchEffort;
use cosfly_planner::muco::attempts::full_effort;
use cosfly_planner::muco::judge::Judge;
use cosfly_planner::muco::lattice::Lattice;
use cosfly_planner::muco::refine::{RefineSpace, Rounds, refine};
use cosfly_planner::muco::scan::Scanner;
use cosfly_planner::muco::search::search;
use cosfly_planner::muco::viterbi::SearchSpace;
use cosfly_planner::problem::Problem;
use cosfly_planner::terms::built_in_terms;
use cosfly_planner::{MucoConfig, Walk};
use cosfly_surroundings::exact::ExactMap;
use cosfly_surroundings::ground::GroundGrid;
use cosfly_surroundings::local::LocalObstacles;
use serde::Serialize;
use std::fmt;

/// Rounds and steps of an attempt's refinement.
const ROUNDS: Rounds = Rounds { rounds: 2, steps: 5 };

/// Mean CPU time of each step per path, milliseconds.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Phases {
    /// Filter of the boxes near the path.
    pub filter_ms: f64,
    /// Visibility and clearance of all viewpoints of the lattice.
    pub lattice_ms: f64,
    /// Search through the viewpoints.
    pub search_ms: f64,
    /// Refinement by Gauss-Newton.
    pub refine_ms: f64,
    /// One measurement for the certificate.
    pub certificate_ms: f64,
    /// Rest, mostly smoothing in the corridor.
    pub smooth_ms: f64,
    /// Whole plan.
    pub whole_ms: f64,
}

/// Times of one lattice in one scene.
#[derive(Clone, Debug, Serialize)]
pub struct PhaseRow {
    /// Name of the scene.
    pub scene: String,
    /// `fast` or `quality`.
    pub lattice: String,
    /// Number of paths.
    pub paths: usize,
    /// Mean times.
    pub phases: Phases,
}

/// Table of all times.
#[derive(Clone, Debug, Serialize)]
pub struct PhaseTable {
    /// Rows by scene, then lattice.
    pub rows: Vec<PhaseRow>,
}

/// Times the steps in every scene, for the fast and for the full lattice.
pub fn phases(grounds: &[Ground], config: &MucoConfig) -> PhaseTable {
    let (fast, full) = (fast(config), only(config));
    let lattices = [("fast", &fast), ("quality", &full)];
    let rows = grounds.iter().flat_map(|ground| lattices.map(|(name, config)| row(ground, name, config)));
    PhaseTable { rows: rows.collect() }
}

/// Config with the full lattice alone.
fn only(config: &MucoConfig) -> MucoConfig {
    let mut own = config.clone();
    own.search.effort = SearchEffort::Quality;
    own
}

/// Config with a lattice of the size that escalation tries first, as the full one.
fn fast(config: &MucoConfig) -> MucoConfig {
    let mut own = only(config);
    own.search.altitudes = own.search.altitudes.div_ceil(2);
    own.search.radii = (4 * own.search.radii).div_ceil(5);
    own.search.keyframe_frames *= 2;
    own
}

fn row(ground: &Ground, lattice: &str, config: &MucoConfig) -> PhaseRow {
    let mut sum = Phases::default();
    for track in &ground.tracks {
        let one = phases_of(ground, track, config);
        sum.filter_ms += one.filter_ms;
        sum.lattice_ms += one.lattice_ms;
        sum.search_ms += one.search_ms;
        sum.refine_ms += one.refine_ms;
        sum.certificate_ms += one.certificate_ms;
        sum.smooth_ms += one.smooth_ms;
        sum.whole_ms += one.whole_ms;
    }
    let share = 1.0 / ground.tracks.len().max(1) as f64;
    let phases = Phases {
        filter_ms: share * sum.filter_ms,
        lattice_ms: share * sum.lattice_ms,
        search_ms: share * sum.search_ms,
        refine_ms: share * sum.refine_ms,
        certificate_ms: share * sum.certificate_ms,
        smooth_ms: share * sum.smooth_ms,
        whole_ms: share * sum.whole_ms,
    };
    PhaseRow { scene: ground.name.clone(), lattice: lattice.to_owned(), paths: ground.tracks.len(), phases }
}

fn phases_of(ground: &Ground, track: &TargetTrack, config: &MucoConfig) -> Phases {
    let ms = |cpu_s: f64| 1e3 * cpu_s;
    let (_, whole) = timed(|| Contender::Cosfly.plan(ground, track, config));
    let terms = built_in_terms(&config.resolved_weights());
    let walk = Walk::of(track);
    let problem =
        Problem { track, view: &config.view, walk: &walk, terms: &terms, built_in: terms.len(), first_frame: 0 };
    let (radius_m, influence_m) = (config.search.filter_radius_m, config.view.safety_influence_m);
    let grid = GroundGrid::sample(track, &*ground.height, radius_m + 10.0);
    let filter = || LocalObstacles::filter(track, &ground.planning_boxes, &grid, radius_m, influence_m);
    let (mut obstacles, filter_s) = timed(filter);
    let lattice_s = lattice_s(track, &obstacles, config);
    let mut space = SearchSpace::default();
    // One run to fill the buffers, which the planner reuses from flight to flight.
    let effort = full_effort(config);
    let _ = search(&problem, &obstacles, config, effort, &[], &mut space);
    let (found, search_s) = timed(|| search(&problem, &obstacles, config, effort, &[], &mut space));
    let (mut refine_s, mut certificate_s) = (0.0, 0.0);
    if let Ok(start) = found {
        let mut space = RefineSpace::default();
        let mut waypoints = start.waypoints.clone();
        let _ = refine(&problem, &mut obstacles, config, ROUNDS, &[], &mut space, &mut waypoints);
        waypoints.copy_from_slice(&start.waypoints);
        refine_s = timed(|| refine(&problem, &mut obstacles, config, ROUNDS, &[], &mut space, &mut waypoints)).1;
        let height = |x: f64, y: f64| (ground.height)(x, y);
        let judge = Judge::new(&problem, ExactMap::still(ground.exact.as_ref()), &height, config, &[]);
        certificate_s = timed(|| judge.measure(&waypoints)).1;
    }
    let search_s = (search_s - lattice_s).max(0.0);
    let parts = filter_s + lattice_s + search_s + refine_s + certificate_s;
    Phases {
        filter_ms: ms(filter_s),
        lattice_ms: ms(lattice_s),
        search_ms: ms(search_s),
        refine_ms: ms(refine_s),
        certificate_ms: ms(certificate_s),
        smooth_ms: ms((whole - parts).max(0.0)),
        whole_ms: ms(whole),
    }
}

/// CPU time of evaluating all layers of the lattice, seconds.
fn lattice_s(track: &TargetTrack, obstacles: &LocalObstacles<'_>, config: &MucoConfig) -> f64 {
    let effort = full_effort(config);
    let lattice = Lattice::new(effort.size, &config.view);
    let mut states = vec![0; lattice.nodes()];
    let mut scanner = Scanner::new(&lattice, track.height_m);
    let all = || {
        for frame in (0..track.len()).step_by(effort.layer_frames.max(1)) {
            scanner.evaluate(frame, &track.states[frame], obstacles, effort.keep_out_m, &mut states);
        }
    };
    timed(all).1
}

impl fmt::Display for PhaseTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let headings = ["filter", "lattice", "search", "refine", "certify", "smooth", "whole"];
        write!(f, "{:8} {:8} {:>5}", "scene", "lattice", "paths")?;
        headings.iter().try_for_each(|heading| write!(f, " {heading:>8}"))?;
        writeln!(f, "   ms of CPU per path")?;
        for row in &self.rows {
            let p = &row.phases;
            write!(f, "{:8} {:8} {:>5}", row.scene, row.lattice, row.paths)?;
            for ms in [p.filter_ms, p.lattice_ms, p.search_ms, p.refine_ms, p.certificate_ms, p.smooth_ms, p.whole_ms] {
                write!(f, " {ms:>8.3}")?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}
