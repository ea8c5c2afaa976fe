//! The planner's main loop: from a target track to a certified flight, or the reason why there is none.

use super::corridor::CorridorInput;
use super::smoother::{Objective, smooth};
use super::start::{self, Effort};
use super::track_check::check_track;
use crate::certificate::{Kinematics, Measured, SolverFigures, certify, term_costs};
use crate::config::MucoConfig;
use crate::obstacles::solid::HalfSpace;
use crate::obstacles::{exact::ExactObstacles, ground::GroundGrid, local::LocalObstacles};
use crate::paper::descent::descend;
use crate::paper::postprocess::postprocess;
use crate::problem::Problem;
use crate::terms::{TermContext, WeightedTerm, built_in_terms};
use crate::trajectory::{PlanOutcome, Trajectory};
use crate::visibility::aim_point;
use crate::walk::Walk;
use cosfly_frames::{DVec3, Pose, Seed, TargetTrack};
use cosfly_geometry::{OrientedBox, SpatialQuery};

/// Searches of growing effort: finer azimuths, then calmer and calmer flights.
const EFFORTS: [(u32, f64, f64); 5] = [(1, 1.0, 0.25), (2, 1.0, 0.15), (2, 6.0, 0.25), (1, 40.0, 0.6), (2, 200.0, 0.1)];
/// Distance kept beyond the limit while smoothing, metres.
const KEEP_OUT_EXTRA_M: f64 = 0.1;
/// Times that planes from the unsimplified map are added when it is nearer than the planning boxes say.
const MAX_LESSONS: usize = 4;
/// How the start is smoothed: loosely near the lattice's corners.
const START_OBJECTIVE: Objective = Objective { nearness: 0.05, acceleration: 0.5, jerk: 2.0 };
/// How the descended path is smoothed: it is smooth already.
const FINAL_OBJECTIVE: Objective = Objective { nearness: 0.5, acceleration: 0.2, jerk: 1.0 };

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

/// [`plan`] with further cost terms beside the paper's nine; they join the search, the descent and the
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
    let rejected = |reason: String| PlanOutcome::Rejected { track: track.clone(), reason };
    if let Err((_, message)) = config.validate() {
        return rejected(message);
    }
    if let Err(reason) = check_track(track, config.limits.speed_mps) {
        return rejected(reason);
    }
    let mut terms = built_in_terms(&config.resolved_weights());
    let built_in = terms.len();
    terms.extend(extra);
    let walk = Walk::of(track);
    let problem = Problem { track, view: &config.view, walk: &walk, terms: &terms, built_in };
    let grid = GroundGrid::sample(track, ground, config.search.filter_radius_m + 10.0);
    let influence = config.view.safety_influence_m;
    let mut obstacles = LocalObstacles::filter(track, planning_boxes, &grid, config.search.filter_radius_m, influence);
    let mut reason = String::new();
    for (azimuth_factor, motion_factor, extra_m) in EFFORTS {
        let keep_out_m = config.limits.clearance_m + extra_m;
        let effort = Effort { azimuth_factor, motion_factor, keep_out_m };
        let mut flight = match attempt(&problem, &mut obstacles, exact, ground, config, effort) {
            Ok(flight) => flight,
            Err(why) => {
                reason = why;
                continue;
            }
        };
        let exact_obstacles = ExactObstacles { track, query: exact, ground: &grid };
        let context = TermContext { track, view: &config.view, walk: &walk, surroundings: &exact_obstacles };
        flight.terms = term_costs(&terms, &positions(&flight), &context);
        if let Some(why) = not_a_number(&flight) {
            return rejected(why);
        }
        return PlanOutcome::Planned(Box::new(flight));
    }
    rejected(reason)
}

/// Terms from outside may return anything; a flight with such a cost is not published.
fn not_a_number(flight: &Trajectory) -> Option<String> {
    flight.terms.iter().find_map(|term| {
        let frame = term.per_frame.iter().position(|cost| !cost.is_finite())?;
        Some(format!(
            "cost term `{}` is {} at frame {frame}; it must be a finite number",
            term.name, term.per_frame[frame]
        ))
    })
}

fn positions(flight: &Trajectory) -> Vec<DVec3> {
    flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect()
}

/// One search and everything after it: the flight, or what stood in its way.
fn attempt(
    problem: &Problem<'_>,
    obstacles: &mut LocalObstacles<'_>,
    exact: &dyn SpatialQuery,
    ground: &dyn Fn(f64, f64) -> f64,
    config: &MucoConfig,
    effort: Effort,
) -> Result<Trajectory, String> {
    let started = start::search(problem, obstacles, config, effort)?;
    let mut judge = Judge { problem, exact, ground, config, learned: vec![Vec::new(); started.len()], iterations: 0 };
    let (safe, safe_measured) = judge.make_flyable(obstacles, &started, &started, START_OBJECTIVE);
    if !judge.publishable(&safe_measured) {
        return Err(safe_measured.certificate.violations.join("; "));
    }
    let mut lower = safe.clone();
    let mut convergence = descend(problem, obstacles, &config.descent, &mut lower);
    judge.iterations += convergence.len().saturating_sub(1) as u32;
    postprocess(problem, obstacles, config, &mut lower);
    let (lower, lower_measured) = judge.make_flyable(obstacles, &lower, &safe, FINAL_OBJECTIVE);
    obstacles.focus_on(&safe);
    let safe_cost = problem.cost(obstacles, &safe);
    obstacles.focus_on(&lower);
    let lower_cost = problem.cost(obstacles, &lower);
    let better = judge.publishable(&lower_measured) && lower_cost < safe_cost;
    let (waypoints, mut measured) = if better { (lower, lower_measured) } else { (safe, safe_measured) };
    convergence.push(lower_cost.min(safe_cost));
    measured.certificate.iterations = judge.iterations;
    measured.certificate.filtered_boxes = obstacles.count() as u32;
    Ok(trajectory(problem.track, &waypoints, measured, convergence))
}

fn trajectory(track: &TargetTrack, waypoints: &[DVec3], measured: Measured, convergence: Vec<f64>) -> Trajectory {
    let pose = |(&w, state): (&DVec3, &_)| Pose::looking_at(w, aim_point(state, track.height_m));
    Trajectory {
        track: track.clone(),
        poses_in_world: waypoints.iter().zip(&track.states).map(pose).collect(),
        visibility: measured.visibility,
        clearance_m: measured.clearance_m,
        terms: Vec::new(),
        convergence,
        certificate: measured.certificate,
        perturbation: None,
    }
}

/// Smooths, measures, and learns from the unsimplified map where the planning boxes were too optimistic.
struct Judge<'a> {
    problem: &'a Problem<'a>,
    exact: &'a dyn SpatialQuery,
    ground: &'a dyn Fn(f64, f64) -> f64,
    config: &'a MucoConfig,
    learned: Vec<Vec<HalfSpace>>,
    iterations: u32,
}

impl Judge<'_> {
    fn make_flyable(
        &mut self,
        obstacles: &mut LocalObstacles<'_>,
        wished: &[DVec3],
        start: &[DVec3],
        objective: Objective,
    ) -> (Vec<DVec3>, Measured) {
        let limits = self.config.stated_limits();
        let mut from = start.to_vec();
        let mut lessons = 0;
        loop {
            let input = CorridorInput {
                track: self.problem.track,
                obstacles,
                keep_out_m: limits.clearance_m + KEEP_OUT_EXTRA_M,
                min_altitude_m: self.config.view.min_altitude_m,
                wished,
                learned: &self.learned,
            };
            let smoothed = smooth(&input, &from, &limits, objective);
            self.iterations += smoothed.iterations;
            let waypoints = smoothed.waypoints;
            let measured = self.measure(&waypoints);
            let close = measured.certificate.min_clearance_m < limits.clearance_m;
            if !close || lessons == MAX_LESSONS || !self.learn(&waypoints) {
                return (waypoints, measured);
            }
            lessons += 1;
            from = waypoints;
        }
    }

    fn measure(&self, waypoints: &[DVec3]) -> Measured {
        let figures = SolverFigures::default();
        certify(self.problem.track, waypoints, self.exact, self.ground, self.config, figures)
    }

    /// Adds planes for segments that the exact map finds too close; false when there is nothing to add.
    fn learn(&mut self, waypoints: &[DVec3]) -> bool {
        let keep = self.config.limits.clearance_m;
        let mut found = false;
        for i in 0..waypoints.len() {
            let last = (i + 1).min(waypoints.len() - 1);
            let (from, to) = (waypoints[i], waypoints[last]);
            if self.exact.segment_clearance(from, to, keep) >= keep {
                continue;
            }
            for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
                let point = from.lerp(to, share);
                if let Some(near) = self.exact.nearest(point, keep + 0.5) {
                    let on_box = point - near.distance_m * near.away_in_world;
                    let normal = near.away_in_world;
                    let plane = HalfSpace { normal, offset_m: normal.dot(on_box) + keep + KEEP_OUT_EXTRA_M };
                    self.learned[i].push(plane);
                    self.learned[last].push(plane);
                    found = true;
                }
            }
        }
        found
    }

    /// Clearance always; speed, acceleration and jerk when the recipe requires them.
    fn publishable(&self, measured: &Measured) -> bool {
        let certificate = &measured.certificate;
        if certificate.holds {
            return true;
        }
        let kinematics = Kinematics {
            speed_mps: certificate.max_speed_mps,
            acceleration_mps2: certificate.max_acceleration_mps2,
            jerk_mps3: certificate.max_jerk_mps3,
        };
        let kinematic = kinematics.violations(&certificate.limits);
        !self.config.limits.require_kinematics && certificate.violations.iter().all(|v| kinematic.contains(v))
    }
}
