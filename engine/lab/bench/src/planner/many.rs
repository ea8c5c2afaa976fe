//! Many trajectories on all cores: time of a whole dataset, and flights that come too near to obstacles.
//!
//! Every flight is checked with another tree than the planner's own, in `f64`, against the unsimplified map, and against
//! boxes that move by [`super::contacts`].

use super::contacts::least_distance_m;
use super::contender::{Contender, Planned};
use super::figures::COLLISION_M;
use super::plain_bvh::PlainBvh;
use super::scene::Ground;
use crate::clock::timed;
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, TargetTrack};
use cosfly_planner::MucoConfig;
use cosfly_planner::certificate::Kinematics;
use cosfly_random::Seed;
use cosfly_scenes::{SceneKind, movers_around};
use cosfly_surroundings::exact::ExactMap;
use rayon::prelude::*;
use serde::Serialize;
use std::fmt;
use std::time::Instant;

/// Walkers per generated scene.
const WALKERS: usize = 20;
/// Number of scenes in memory at once.
const SCENES_PER_ROUND: usize = 24;
/// Largest clearance that is measured, metres.
const CAP_M: f64 = 5.0;
/// Tolerance of the checks for rounding, metres and m/s.
const ROUNDING: f64 = 1e-9;
/// Time per trajectory in the paper: 6,000 trajectories in 25 minutes.
const PAPER_S_PER_TRAJECTORY: f64 = 25.0 * 60.0 / 6000.0;
/// Most incidents that are listed; all are counted.
const LISTED: usize = 50;

/// Options of the measurement.
pub struct ManyOptions<'a> {
    /// Kinds of scenes, in turn.
    pub kinds: Vec<SceneKind>,
    /// Seed of the first scene of each kind; later ones have consecutive seeds.
    pub seed: u64,
    /// Number of trajectories.
    pub count: usize,
    /// Number of boxes that move around each walker.
    pub movers: usize,
    /// Planner.
    pub contender: Contender,
    /// Limits, view and weights.
    pub config: MucoConfig,
    /// Callback after every round: finished and total numbers.
    pub progress: &'a (dyn Fn(usize, usize) + Sync),
}

/// Results of the measurement.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ManyReport {
    /// Planner.
    pub planner: String,
    /// Number of paths.
    pub paths: usize,
    /// Number of paths with a flight.
    pub planned: usize,
    /// Number of planning threads.
    pub threads: usize,
    /// Wall time of planning alone, seconds; scene generation and evaluation are excluded.
    pub planning_wall_s: f64,
    /// CPU time of all planning threads, seconds.
    pub planning_cpu_s: f64,
    /// CPU time of planning the same paths with nothing that moves, seconds; 0 where nothing moves.
    pub still_cpu_s: f64,
    /// Number of boxes that move around each walker.
    pub movers: usize,
    /// Smallest distance of all flights from boxes that move, metres, capped at 5.
    pub min_moving_m: f64,
    /// Speed relative to the paper's 25 minutes for 6,000 trajectories.
    pub times_paper: f64,
    /// Speed relative to the paper's by CPU time instead of wall time, as on an idle machine.
    pub times_paper_undisturbed: f64,
    /// Mean visibility over all flights, by the planner's tree.
    pub visibility: f64,
    /// Smallest clearance of all swept paths, metres, capped at 5.
    pub min_clearance_m: f64,
    /// Largest speed, m/s.
    pub max_speed_mps: f64,
    /// Largest acceleration, m/s^2.
    pub max_acceleration_mps2: f64,
    /// Largest jerk, m/s^3.
    pub max_jerk_mps3: f64,
    /// Number of flights whose swept path collides with a box, still or moving.
    pub collisions: usize,
    /// Number of flights nearer than the clearance limit.
    pub margin_violations: usize,
    /// Largest yaw rate, degrees per second.
    pub max_yaw_rate_deg_s: f64,
    /// Largest pitch rate, degrees per second.
    pub max_pitch_rate_deg_s: f64,
    /// Number of flights beyond a limit of speed, acceleration, jerk, yaw rate or pitch rate.
    pub limit_violations: usize,
    /// First incidents (such flights, and paths without a flight), each in words.
    pub incidents: Vec<String>,
}

/// A planned path with the scene and number that identify it.
struct Job<'a> {
    ground: &'a Ground,
    judge: &'a PlainBvh,
    track: &'a TargetTrack,
    movers: Vec<Vec<OrientedBox>>,
    name: String,
}

/// Evaluation of one flight.
struct Verdict {
    visibility: f64,
    /// From boxes that stand still.
    clearance_m: f64,
    /// From boxes that move.
    moving_m: f64,
    kinematics: Kinematics,
}

/// Plans and evaluates `count` paths.
pub fn many(options: &ManyOptions<'_>) -> ManyReport {
    let mut report = ManyReport {
        planner: options.contender.name().to_owned(),
        threads: rayon::current_num_threads(),
        min_clearance_m: CAP_M,
        min_moving_m: CAP_M,
        movers: options.movers,
        ..ManyReport::default()
    };
    let scenes: Vec<(SceneKind, u64, usize)> = scenes(options);
    for round in scenes.chunks(SCENES_PER_ROUND) {
        plan_round(options, round, &mut report);
        (options.progress)(report.paths, options.count);
    }
    report.visibility /= report.planned.max(1) as f64;
    let papers_s = PAPER_S_PER_TRAJECTORY * report.paths as f64;
    report.times_paper = papers_s / report.planning_wall_s.max(1e-9);
    report.times_paper_undisturbed = papers_s * report.threads as f64 / report.planning_cpu_s.max(1e-9);
    report
}

/// (kind, seed, walkers) of every required scene.
fn scenes(options: &ManyOptions<'_>) -> Vec<(SceneKind, u64, usize)> {
    let kinds = options.kinds.len().max(1);
    let scene = |index: usize| {
        let kind = options.kinds.get(index % kinds).copied().unwrap_or(SceneKind::Light);
        let walkers = WALKERS.min(options.count - index * WALKERS);
        (kind, options.seed + (index / kinds) as u64, walkers)
    };
    (0..options.count.div_ceil(WALKERS)).map(scene).collect()
}

fn plan_round(options: &ManyOptions<'_>, round: &[(SceneKind, u64, usize)], report: &mut ManyReport) {
    let grounds: Vec<(Ground, PlainBvh, u64)> = round
        .par_iter()
        .map(|&(kind, seed, walkers)| {
            let (ground, boxes) = Ground::scene_and_boxes(kind, seed, walkers);
            (ground, PlainBvh::build(&boxes), seed)
        })
        .collect();
    let jobs: Vec<Job<'_>> = grounds
        .iter()
        .flat_map(|(ground, judge, seed)| {
            ground.tracks.iter().enumerate().map(move |(path, track)| {
                let name = format!("{} --seed {seed}, path {path}", ground.name);
                let own = Seed::of_item(*seed, "movers", &ground.name).child("path", path as u64);
                let movers = movers_around(track, options.movers, own);
                Job { ground, judge, track, movers, name }
            })
        })
        .collect();
    let plan = |job: &Job<'_>, movers: &[Vec<OrientedBox>]| {
        timed(|| options.contender.plan_among(movers, job.ground, job.track, &options.config))
    };
    if options.movers > 0 {
        report.still_cpu_s += jobs.par_iter().map(|job| plan(job, &[]).1).collect::<Vec<f64>>().iter().sum::<f64>();
    }
    let begin = Instant::now();
    let planned: Vec<(Result<Planned, String>, f64)> = jobs.par_iter().map(|job| plan(job, &job.movers)).collect();
    report.planning_wall_s += begin.elapsed().as_secs_f64();
    let verdicts: Vec<Result<Verdict, String>> =
        jobs.par_iter().zip(&planned).map(|(job, (planned, _))| judge(job, planned)).collect();
    for ((job, (_, cpu_s)), verdict) in jobs.iter().zip(&planned).zip(verdicts) {
        report.paths += 1;
        report.planning_cpu_s += cpu_s;
        report.add(job, verdict, &options.config);
    }
}

fn judge(job: &Job<'_>, planned: &Result<Planned, String>) -> Result<Verdict, String> {
    let waypoints: &[DVec3] = &planned.as_ref().map_err(Clone::clone)?.waypoints;
    if waypoints.len() != job.track.len() || waypoints.iter().any(|waypoint| !waypoint.is_finite()) {
        return Err("the flight is not one finite waypoint per frame".to_owned());
    }
    let ends = waypoints.iter().skip(1).chain(waypoints.last());
    let clearance_m = waypoints
        .iter()
        .zip(ends)
        .map(|(&from, &to)| job.judge.segment_clearance_m(from, to, CAP_M))
        .fold(CAP_M, f64::min);
    let moving_m = least_distance_m(waypoints, &job.movers, CAP_M);
    let map = ExactMap::among(job.ground.exact.as_ref(), &job.movers);
    let seen = |frame: usize| map.visibility(frame, waypoints[frame], &job.track.states[frame], job.track.height_m);
    let visibility = (0..waypoints.len()).map(seen).sum::<f64>() / waypoints.len().max(1) as f64;
    Ok(Verdict { visibility, clearance_m, moving_m, kinematics: Kinematics::of(job.track, waypoints, 0) })
}

impl ManyReport {
    fn add(&mut self, job: &Job<'_>, verdict: Result<Verdict, String>, config: &MucoConfig) {
        let verdict = match verdict {
            Ok(verdict) => verdict,
            Err(reason) => return self.incident(format!("no flight: {}: {reason}", job.name)),
        };
        self.planned += 1;
        self.visibility += verdict.visibility;
        self.min_clearance_m = self.min_clearance_m.min(verdict.clearance_m);
        self.min_moving_m = self.min_moving_m.min(verdict.moving_m);
        let (found, limits) = (verdict.kinematics, config.stated_limits());
        self.max_speed_mps = self.max_speed_mps.max(found.speed_mps);
        self.max_acceleration_mps2 = self.max_acceleration_mps2.max(found.acceleration_mps2);
        self.max_jerk_mps3 = self.max_jerk_mps3.max(found.jerk_mps3);
        self.max_yaw_rate_deg_s = self.max_yaw_rate_deg_s.max(found.yaw_rate_deg_s);
        self.max_pitch_rate_deg_s = self.max_pitch_rate_deg_s.max(found.pitch_rate_deg_s);
        let (clearance_m, moving_m) = (verdict.clearance_m, verdict.moving_m);
        let words = format!("{}: clearance {clearance_m:.3} m, from what moves {moving_m:.3} m", job.name);
        let least_m = clearance_m.min(moving_m);
        if least_m < COLLISION_M - ROUNDING {
            self.collisions += 1;
            self.incident(format!("collision: {words}"));
        } else if least_m < limits.clearance_m - ROUNDING {
            self.margin_violations += 1;
            self.incident(format!("too near: {words}"));
        }
        let beyond = found.violations(&limits);
        if !beyond.is_empty() {
            self.limit_violations += 1;
            self.incident(format!("beyond the limits: {}: {}", job.name, beyond.join("; ")));
        }
    }

    fn incident(&mut self, words: String) {
        if self.incidents.len() < LISTED {
            self.incidents.push(words);
        }
    }
}

impl fmt::Display for ManyReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let each_ms = 1e3 * self.planning_cpu_s / self.paths.max(1) as f64;
        let (wall_s, threads) = (self.planning_wall_s, self.threads);
        writeln!(
            f,
            "{} paths by {}: {wall_s:.1} s on {threads} threads, {each_ms:.2} ms of CPU each",
            self.paths, self.planner
        )?;
        let (wall, undisturbed) = (self.times_paper, self.times_paper_undisturbed);
        writeln!(
            f,
            "{wall:.0} times as fast as the paper's 25 minutes for 6,000 trajectories ({undisturbed:.0} undisturbed)"
        )?;
        if self.movers > 0 {
            let ratio = self.planning_cpu_s / self.still_cpu_s.max(1e-9);
            let (movers, least_m) = (self.movers, self.min_moving_m);
            writeln!(
                f,
                "among {movers} boxes that move: {ratio:.2} times the CPU time of the same paths without them"
            )?;
            writeln!(f, "least distance from a box that moves {least_m:.3} m, moments a 25th of a frame apart")?;
        }
        let none = self.paths - self.planned;
        writeln!(f, "{} flights, {none} paths without; mean visibility {:.4}", self.planned, self.visibility)?;
        writeln!(
            f,
            "collisions = {} (swept path nearer than {COLLISION_M} m to an unsimplified box)",
            self.collisions
        )?;
        let (near, least_m) = (self.margin_violations, self.min_clearance_m);
        writeln!(f, "nearer than the limit = {near}, least clearance {least_m:.3} m")?;
        writeln!(
            f,
            "beyond the limits = {}; largest speed {:.2} m/s, acceleration {:.2} m/s^2, jerk {:.2} m/s^3",
            self.limit_violations, self.max_speed_mps, self.max_acceleration_mps2, self.max_jerk_mps3
        )?;
        let (yaw, pitch) = (self.max_yaw_rate_deg_s, self.max_pitch_rate_deg_s);
        writeln!(f, "largest yaw rate {yaw:.1} degrees/s, pitch rate {pitch:.1} degrees/s")?;
        self.incidents.iter().try_for_each(|incident| writeln!(f, "  {incident}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(contender: Contender, config: MucoConfig) -> ManyReport {
        let kinds = vec![SceneKind::Alley, SceneKind::Canyon];
        let (seed, count, movers, progress) = (3, 23, 50, &|_, _| {});
        many(&ManyOptions { kinds, seed, count, movers, contender, config, progress })
    }

    #[test]
    fn every_path_is_planned_and_judged_and_ours_come_nowhere_near() {
        let report = check(Contender::Cosfly, MucoConfig::default());
        assert_eq!((report.paths, report.planned), (23, 23), "{report}");
        assert_eq!((report.collisions, report.margin_violations, report.limit_violations), (0, 0, 0), "{report}");
        assert!(report.visibility > 0.9 && report.min_clearance_m >= 1.5, "{report}");
    }

    #[test]
    fn what_breaks_a_limit_is_counted_and_named() {
        let mut config = MucoConfig::default();
        config.limits.acceleration_mps2 = 0.1;
        let report = check(Contender::Paper, config);
        assert!(report.limit_violations > 0, "{report}");
        assert!(report.incidents.iter().any(|words| words.contains("--seed 3, path 0")), "{report}");
    }
}
