//! The planner's main loop: from a target track to a certified flight, or the reason why there is none.

use super::corridor::CorridorInput;
use super::lattice::LatticeSize;
use super::refine::{RefineSpace, Rounds, refine};
use super::search::{Effort, search};
use super::smoother::{Objective, smooth};
use super::track_check::check_track;
use super::viterbi::SearchSpace;
use crate::certificate::{Kinematics, Measured, SolverFigures, certify, term_costs};
use crate::config::{MucoConfig, SearchEffort};
use crate::obstacles::solid::HalfSpace;
use crate::obstacles::{exact::ExactObstacles, ground::GroundGrid, local::LocalObstacles};
use crate::problem::Problem;
use crate::terms::{TermContext, WeightedTerm, built_in_terms};
use crate::trajectory::{PlanOutcome, Trajectory};
use crate::visibility::aim_point;
use crate::walk::Walk;
use cosfly_frames::{DVec3, Pose, Seed, TargetTrack};
use cosfly_geometry::{OrientedBox, SpatialQuery};
use std::cell::RefCell;

/// A flight that sees less than this share of what the lattice's best way sees is searched again with more effort.
const GOOD_SHARE: f64 = 0.955;
/// When nothing valid is found: (cost of motion, distance kept beyond the limit) of calmer and calmer searches.
const CALMER: [(f64, f64); 4] = [(1.0, 0.15), (6.0, 0.25), (40.0, 0.6), (200.0, 0.1)];
/// Distance kept beyond the limit by the first searches; the fast one looks at every second frame only.
const FAST_EXTRA_M: f64 = 0.45;
const FULL_EXTRA_M: f64 = 0.25;
/// Distance kept beyond the limit while smoothing, metres.
const KEEP_OUT_EXTRA_M: f64 = 0.1;
/// Times that planes from the unsimplified map are added when it is nearer than the planning boxes say.
const MAX_LESSONS: usize = 4;
/// How a refined flight is made to hold its limits: it nearly does.
const LIGHT: Objective = Objective { rounds: 2, iterations: 60, nearness: 0.15, acceleration: 0.2, jerk: 1.0 };
/// How the lattice's way is, when that was not enough.
const THOROUGH: Objective = Objective { rounds: 4, iterations: 160, nearness: 0.05, acceleration: 0.5, jerk: 2.0 };

thread_local! {
    /// Buffers kept from one flight to the next; every use fills them anew.
    static WORKSHOP: RefCell<Workshop> = RefCell::default();
}

#[derive(Default)]
struct Workshop {
    search: SearchSpace,
    refine: RefineSpace,
}

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
    let found =
        WORKSHOP.with_borrow_mut(|workshop| escalate(&problem, &mut obstacles, exact, ground, config, workshop));
    let mut flight = match found {
        Ok(flight) => flight,
        Err(reason) => return rejected(reason),
    };
    let exact_obstacles = ExactObstacles { track, query: exact, ground: &grid };
    let context = TermContext { track, view: &config.view, walk: &walk, surroundings: &exact_obstacles };
    flight.terms = term_costs(&terms, &positions(&flight), &context);
    match not_a_number(&flight) {
        Some(why) => rejected(why),
        None => PlanOutcome::Planned(Box::new(flight)),
    }
}

/// Searches of growing effort until one flight is valid and sees what the lattice promises.
fn escalate(
    problem: &Problem<'_>,
    obstacles: &mut LocalObstacles<'_>,
    exact: &dyn SpatialQuery,
    ground: &dyn Fn(f64, f64) -> f64,
    config: &MucoConfig,
    workshop: &mut Workshop,
) -> Result<Trajectory, String> {
    let mut reason = String::new();
    let mut kept: Option<Trajectory> = None;
    for (level, effort) in efforts(config).into_iter().enumerate() {
        match attempt(problem, obstacles, exact, ground, config, effort, workshop) {
            Ok((flight, promised)) => {
                let seen = flight.certificate.mean_visibility;
                let better = kept.as_ref().is_none_or(|kept| seen > kept.certificate.mean_visibility);
                kept = if better { Some(flight) } else { kept };
                let again = config.search.effort == SearchEffort::Escalating && level == 0;
                if !again || seen >= GOOD_SHARE * promised {
                    break;
                }
            }
            Err(why) => reason = why,
        }
        if kept.is_some() && level > 0 {
            break;
        }
    }
    kept.ok_or(reason)
}

/// The search over the recipe's own lattice.
pub fn full_effort(config: &MucoConfig) -> Effort {
    let search = &config.search;
    let (azimuths, altitudes, radii) = (search.azimuths as usize, search.altitudes as usize, search.radii as usize);
    Effort {
        size: LatticeSize { azimuths, altitudes, radii },
        layer_frames: search.keyframe_frames as usize,
        motion_factor: 1.0,
        keep_out_m: config.limits.clearance_m + FULL_EXTRA_M,
    }
}

fn efforts(config: &MucoConfig) -> Vec<Effort> {
    let full = full_effort(config);
    let LatticeSize { azimuths, altitudes, radii } = full.size;
    let clearance = config.limits.clearance_m;
    let fast = Effort {
        size: LatticeSize { azimuths, altitudes: altitudes.div_ceil(2), radii: (4 * radii).div_ceil(5) },
        layer_frames: 2 * full.layer_frames,
        keep_out_m: clearance + FAST_EXTRA_M,
        ..full
    };
    let first = if config.search.effort == SearchEffort::Quality { vec![full] } else { vec![fast, full] };
    let calmer =
        CALMER.map(|(motion_factor, extra_m)| Effort { motion_factor, keep_out_m: clearance + extra_m, ..full });
    first.into_iter().chain(calmer).collect()
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

/// One search and everything after it: the flight and the visibility that the lattice promised, or what stood in
/// its way.
fn attempt(
    problem: &Problem<'_>,
    obstacles: &mut LocalObstacles<'_>,
    exact: &dyn SpatialQuery,
    ground: &dyn Fn(f64, f64) -> f64,
    config: &MucoConfig,
    effort: Effort,
    workshop: &mut Workshop,
) -> Result<(Trajectory, f64), String> {
    let start = search(problem, obstacles, config, effort, &mut workshop.search)?;
    let mut refined = start.waypoints.clone();
    let rounds = Rounds { rounds: 2, steps: 3 };
    let steps = refine(problem, obstacles, config, rounds, &mut workshop.refine, &mut refined);
    let mut dbg = String::new();
    let learned = vec![Vec::new(); refined.len()];
    let mut judge = Judge { problem, exact, ground, config, learned, iterations: steps };
    let mut measured = judge.measure(&refined);
    let mut waypoints = refined;
    dbg += &format!(
        "azi {} alt {} lattice {:.3} searches {} dpvis {:.3} gn {:.3} {:?}",
        effort.size.azimuths,
        effort.size.altitudes,
        start.visibility,
        start.searches,
        judge.measure(&start.waypoints).certificate.mean_visibility,
        measured.certificate.mean_visibility,
        measured.certificate.violations
    );
    if !measured.certificate.holds {
        let safe = led_back(obstacles, &waypoints, &start.waypoints, config.limits.clearance_m + KEEP_OUT_EXTRA_M);
        (waypoints, measured) = judge.make_flyable(obstacles, &waypoints, &safe, LIGHT);
    }
    dbg += &format!(" light {:.3} {:?}", measured.certificate.mean_visibility, measured.certificate.violations);
    if !judge.publishable(&measured) {
        (waypoints, measured) = judge.make_flyable(obstacles, &start.waypoints, &start.waypoints, THOROUGH);
    }
    if !judge.publishable(&measured) {
        return Err(measured.certificate.violations.join("; "));
    }
    eprintln!("{dbg} final {:.3}", measured.certificate.mean_visibility);
    measured.certificate.iterations = judge.iterations;
    measured.certificate.filtered_boxes = obstacles.count() as u32;
    Ok((trajectory(problem.track, &waypoints, measured, Vec::new()), start.visibility))
}

/// `waypoints`, led back to the safe way over stretches that come too near an obstacle.
fn led_back(obstacles: &LocalObstacles<'_>, waypoints: &[DVec3], safe: &[DVec3], keep_m: f64) -> Vec<DVec3> {
    const FULL_FRAMES: usize = 2;
    const RAMP_FRAMES: usize = 5;
    let mut share = vec![0.0_f64; waypoints.len()];
    for i in 0..waypoints.len() {
        let to = waypoints.get(i + 1).copied().unwrap_or(waypoints[i]);
        if obstacles.segment_clearance_m(i, waypoints[i], to, keep_m) >= keep_m {
            continue;
        }
        let first = i.saturating_sub(FULL_FRAMES + RAMP_FRAMES);
        for (k, share) in share.iter_mut().enumerate().skip(first).take(2 * (FULL_FRAMES + RAMP_FRAMES) + 2) {
            let away = if k > i { k - i - 1 } else { i - k };
            let here = 1.0 - away.saturating_sub(FULL_FRAMES) as f64 / (RAMP_FRAMES + 1) as f64;
            *share = share.max(here.clamp(0.0, 1.0));
        }
    }
    waypoints.iter().zip(safe).zip(share).map(|((w, safe), share)| w.lerp(*safe, share)).collect()
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
