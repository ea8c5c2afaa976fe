//! Attempts of growing effort: search, refine, smooth, judge, until a flight is valid and sees what the lattice promises.

use super::judge::{Judge, KEEP_OUT_EXTRA_M};
use super::lattice::LatticeSize;
use super::losses::{LossPlan, reached_s};
use super::refine::{RefineSpace, Rounds, refine};
use super::search::{Effort, search};
use super::smoother::Objective;
use super::viterbi::SearchSpace;
use crate::certificate::Measured;
use crate::config::muco::MucoConfig;
use crate::config::search::SearchEffort;
use crate::error::PlanError;
use crate::found::Found;
use crate::problem::Problem;
use cosfly_frames::DVec3;
use cosfly_surroundings::Surroundings;
use cosfly_surroundings::local::LocalObstacles;
use std::cell::RefCell;

/// A flight that sees less than this share of what the lattice's best way sees is searched again with more effort.
const GOOD_SHARE: f64 = 0.955;
/// Where more than this share of the nodes is closed, the fast lattice may have missed the only gaps from which the
/// target is seen: there, less than [`GOOD_IN_GAPS`] is searched again.
const TIGHT_SHARE: f64 = 0.5;
const GOOD_IN_GAPS: f64 = 0.99;
/// When nothing valid is found: (cost of motion, distance kept beyond the limit) of calmer and calmer searches.
const CALMER: [(f64, f64); 4] = [(1.0, 0.15), (6.0, 0.25), (40.0, 0.6), (200.0, 0.1)];
/// Distance kept beyond the limit by the first searches; the fast one looks at every second frame only.
const FAST_EXTRA_M: f64 = 0.45;
const FULL_EXTRA_M: f64 = 0.25;
/// Smoothing of a refined flight, which nearly holds its limits.
const LIGHT: Objective = Objective { rounds: 2, iterations: 60, nearness: 0.15, acceleration: 0.2, jerk: 1.0 };
/// Smoothing of the lattice's way (or of the paper's flight), when light smoothing was not enough.
pub const THOROUGH: Objective = Objective { rounds: 4, iterations: 160, nearness: 0.05, acceleration: 0.5, jerk: 2.0 };
/// Light weights of calm presets, which are flattened beyond what the limits ask.
const CALM_LIGHT: Objective = Objective { acceleration: 10.0, jerk: 20.0, ..LIGHT };
const CALM_THOROUGH: Objective = Objective { acceleration: 2.0, jerk: 5.0, ..THOROUGH };
/// Steps of refinement per round: heavy weights of smoothness need more of them.
const STEPS: usize = 3;
const CALM_STEPS: usize = 5;

/// Times that a flight which sees nearly all that the lattice promises is refined and smoothed once more: what it lacks
/// are single frames between layers. Where much is hidden, that gains little for half as much time again.
const TOUCH_UPS: usize = 2;
const NEARLY_ALL: f64 = 0.95;

thread_local! {
    /// Buffers kept from one flight to the next; every use fills them anew.
    static WORKSHOP: RefCell<Workshop> = RefCell::default();
}

/// Values that depend on the pace of the preset.
struct Pace {
    steps: usize,
    light: Objective,
    thorough: Objective,
}

impl Pace {
    fn of(config: &MucoConfig) -> Self {
        if config.preset.is_calm() {
            Self { steps: CALM_STEPS, light: CALM_LIGHT, thorough: CALM_THOROUGH }
        } else {
            Self { steps: STEPS, light: LIGHT, thorough: THOROUGH }
        }
    }
}

#[derive(Default)]
struct Workshop {
    search: SearchSpace,
    refine: RefineSpace,
}

/// Tries lattices from fast to fine, then calmer and calmer flights, and gives the best of what is valid, or the last
/// reason why nothing is.
pub fn escalate(
    problem: &Problem<'_>,
    obstacles: &mut LocalObstacles<'_>,
    config: &MucoConfig,
    judge: &mut Judge<'_>,
) -> Result<Found, PlanError> {
    WORKSHOP.with_borrow_mut(|workshop| {
        let mut reason = PlanError::NoWay("no effort was made".to_owned());
        let mut kept: Option<Found> = None;
        for (level, effort) in efforts(config).into_iter().enumerate() {
            match attempt(problem, obstacles, config, effort, judge, workshop) {
                Ok((mut found, closed_share)) => {
                    let certificate = &mut found.measured.certificate;
                    certificate.attempts = level as u32 + 1;
                    let (seen, promised) = (certificate.mean_visibility, certificate.lattice_visibility);
                    let better = kept.as_ref().is_none_or(|kept| seen > kept.measured.certificate.mean_visibility);
                    kept = if better { Some(found) } else { kept };
                    let again = config.search.effort == SearchEffort::Escalating && level == 0;
                    let tight = closed_share > TIGHT_SHARE && seen < GOOD_IN_GAPS;
                    if !again || (seen >= GOOD_SHARE * promised && !tight) {
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
    })
}

/// The search over the recipe's own lattice.
pub fn full_effort(config: &MucoConfig) -> Effort {
    let search = &config.search;
    let (azimuths, altitudes, radii) = (search.azimuths as usize, search.altitudes as usize, search.radii as usize);
    Effort {
        size: LatticeSize { azimuths, altitudes, radii },
        layer_frames: search.keyframe_frames as usize,
        motion_factor: config.preset.motion_factor(),
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
    let calmer = CALMER.map(|(factor, extra_m)| {
        let motion_factor = factor * full.motion_factor;
        Effort { motion_factor, keep_out_m: clearance + extra_m, ..full }
    });
    first.into_iter().chain(calmer).collect()
}

/// One search and everything after it: the flight and the share of closed nodes, or what stood in its way.
fn attempt(
    problem: &Problem<'_>,
    obstacles: &mut LocalObstacles<'_>,
    config: &MucoConfig,
    effort: Effort,
    judge: &mut Judge<'_>,
    workshop: &mut Workshop,
) -> Result<(Found, f64), PlanError> {
    obstacles.order_losses(Vec::new());
    let head = judge.head;
    let start = search(problem, obstacles, config, effort, head, &mut workshop.search)?;
    let losses: LossPlan = start.losses;
    obstacles.order_losses(losses.lost.clone());
    let mut waypoints = start.waypoints.clone();
    let pace = Pace::of(config);
    let rounds = Rounds { rounds: 2, steps: pace.steps };

    let refined = refine(problem, obstacles, config, rounds, head, &mut workshop.refine, &mut waypoints);
    judge.iterations += refined.steps;
    let mut measured;
    (waypoints, measured) = finish(config, obstacles, judge, waypoints, &start.waypoints);
    if !judge.publishable(&measured) {
        (waypoints, measured) = judge.make_flyable(obstacles, &start.waypoints, &start.waypoints, pace.thorough);
    }
    if !judge.publishable(&measured) {
        return Err(PlanError::Rules(measured.certificate.violations));
    }
    for _ in 0..TOUCH_UPS {
        let seen = measured.certificate.mean_visibility;
        if seen < NEARLY_ALL || seen >= start.visibility {
            break;
        }
        let mut touched = waypoints.clone();
        obstacles.focus_on(&touched);
        leave_shadows(obstacles, head.len(), &mut touched);
        let rounds = Rounds { rounds: 1, steps: 2 };
        judge.iterations += refine(problem, obstacles, config, rounds, head, &mut workshop.refine, &mut touched).steps;
        let (touched, again) = finish(config, obstacles, judge, touched, &waypoints);
        let more = again.certificate.mean_visibility > measured.certificate.mean_visibility;
        if !more || !judge.publishable(&again) {
            break;
        }
        (waypoints, measured) = (touched, again);
    }
    obstacles.focus_on(&waypoints);
    let mut convergence = refined.convergence;
    convergence.push(problem.cost(obstacles, &waypoints));
    let certificate = &mut measured.certificate;
    certificate.iterations = judge.iterations;
    certificate.filtered_boxes = obstacles.count() as u32;
    certificate.searches = start.searches;
    certificate.lattice_visibility = start.visibility;
    certificate.visibility_regret = (start.visibility - certificate.mean_visibility).max(0.0);
    certificate.occlusion_ordered_s = losses.ordered_s;
    certificate.occlusion_reached_s = reached_s(&losses, &measured.visibility, problem.track.dt_s);
    Ok((Found { waypoints, measured, convergence }, start.closed_share))
}

/// Bends the flight out of the shadows of single frames, to the nearest side, with its neighbours: refinement alone does
/// not pull waypoints that are deep in shadow, since where much is hidden the nearest way out is likely the wrong one.
fn leave_shadows(obstacles: &LocalObstacles<'_>, given: usize, waypoints: &mut [DVec3]) {
    const DEEPEST_M: f64 = 5.0;
    const BEYOND_M: f64 = 0.5;
    const RAMP_FRAMES: usize = 7;
    let before = waypoints.to_vec();
    let mut bend = vec![(0.0_f64, DVec3::ZERO); waypoints.len()];
    for (i, &waypoint) in before.iter().enumerate().skip(given) {
        let mut deepest = (0.0, DVec3::ZERO);
        obstacles.shadows(i, waypoint, &mut |slack_m, away| {
            if slack_m < deepest.0 {
                deepest = (slack_m, away);
            }
        });
        let (slack_m, away) = deepest;
        if !(-DEEPEST_M..0.0).contains(&slack_m) {
            continue;
        }
        let frames = i.saturating_sub(RAMP_FRAMES).max(given)..(i + RAMP_FRAMES + 1).min(waypoints.len());
        for k in frames {
            let t = 1.0 - k.abs_diff(i) as f64 / (RAMP_FRAMES + 1) as f64;
            let share = t * t * (3.0 - 2.0 * t);
            let size = share * (BEYOND_M - slack_m);
            bend[k] = if size > bend[k].0 { (size, size * away) } else { bend[k] };
        }
    }
    waypoints.iter_mut().zip(&bend).for_each(|(waypoint, bend)| *waypoint += bend.1);
}

/// A refined flight and its measurements; never lower than `safe` and the lowest altitude, and smoothed, from `safe`
/// where it comes too near an obstacle, if it needs that.
fn finish(
    config: &MucoConfig,
    obstacles: &LocalObstacles<'_>,
    judge: &mut Judge<'_>,
    mut refined: Vec<DVec3>,
    safe: &[DVec3],
) -> (Vec<DVec3>, Measured) {
    judge.raise(obstacles, &mut refined, safe);
    if judge.needs_nothing(obstacles, &refined) {
        let measured = judge.measure(&refined);
        if measured.certificate.holds {
            return (refined, measured);
        }
    }
    let keep_m = config.limits.clearance_m + KEEP_OUT_EXTRA_M;
    let safe = led_back(obstacles, &refined, safe, keep_m);
    judge.make_flyable(obstacles, &refined, &safe, Pace::of(config).light)
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
