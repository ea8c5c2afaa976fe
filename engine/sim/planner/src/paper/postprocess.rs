//! The seven post-processing steps (paper, appendix A.4), each kept only when it does not raise the cost.

use super::projection::project;
use super::repair::{redistribute_spikes, smooth_altitude};
use crate::config::MucoConfig;
use crate::obstacles::{Surroundings, local::LocalObstacles};
use crate::problem::Problem;
use cosfly_frames::{DVec2, DVec3, real};

/// Occluded runs longer than this many frames are straightened.
const LONG_RUN_FRAMES: usize = 5;
/// Below this visibility a frame counts as occluded.
const OCCLUDED_BELOW: f64 = 0.5;
/// Frames over which a replaced stretch is blended into the rest.
const RAMP_FRAMES: usize = 6;
/// Azimuths tried for an occluded run.
const AZIMUTHS: usize = 24;
/// Occluded runs that are looked at, at most.
const MAX_RUNS: usize = 6;
/// Frames of a stretch that is tested for a detour.
const DETOUR_FRAMES: usize = 12;
/// A stretch this many times longer than its chord is a detour.
const DETOUR_RATIO: f64 = 1.5;

/// Applies all steps to `waypoints`; returns how many waypoints the final check still finds unsafe.
pub fn postprocess(
    problem: &Problem<'_>,
    obstacles: &mut LocalObstacles<'_>,
    config: &MucoConfig,
    waypoints: &mut Vec<DVec3>,
) -> usize {
    let clearance = config.limits.clearance_m;
    keep_if_cheaper(problem, obstacles, waypoints, |o, w| straighten_occluded_runs(problem, o, w));
    keep_if_cheaper(problem, obstacles, waypoints, |_, w| remove_detours(w));
    keep_if_cheaper(problem, obstacles, waypoints, |_, w| remove_oscillation(w));
    obstacles.focus_on(waypoints);
    project(problem, obstacles, clearance, 3, waypoints);
    redistribute_spikes(config.limits.speed_mps * problem.track.dt_s, waypoints);
    smooth_altitude(obstacles, clearance, config.view.min_altitude_m, waypoints);
    project(problem, obstacles, clearance, 1, waypoints)
}

fn keep_if_cheaper(
    problem: &Problem<'_>,
    obstacles: &mut LocalObstacles<'_>,
    waypoints: &mut Vec<DVec3>,
    change: impl Fn(&LocalObstacles<'_>, &mut [DVec3]),
) {
    obstacles.focus_on(waypoints);
    let mut candidate = waypoints.clone();
    change(obstacles, &mut candidate);
    if candidate == *waypoints {
        return;
    }
    let before = problem.cost(obstacles, waypoints);
    obstacles.focus_on(&candidate);
    if problem.cost(obstacles, &candidate) < before {
        *waypoints = candidate;
    }
}

/// Step 1: stretches in which the target is hidden for long take the azimuth from which it is seen best.
pub fn straighten_occluded_runs(problem: &Problem<'_>, obstacles: &LocalObstacles<'_>, waypoints: &mut [DVec3]) {
    let hidden: Vec<bool> =
        waypoints.iter().enumerate().map(|(i, &w)| obstacles.visibility(i, w) < OCCLUDED_BELOW).collect();
    let mut first = 0;
    let mut runs = 0;
    while first < hidden.len() && runs < MAX_RUNS {
        let length = hidden[first..].iter().take_while(|&&occluded| occluded).count();
        if length > LONG_RUN_FRAMES {
            bridge(problem, obstacles, first..first + length, waypoints);
            runs += 1;
        }
        first += length.max(1);
    }
}

/// Puts the run on the best common azimuth and ramps to it from both sides.
fn bridge(
    problem: &Problem<'_>,
    obstacles: &LocalObstacles<'_>,
    run: core::ops::Range<usize>,
    waypoints: &mut [DVec3],
) {
    let feet = |i: usize| problem.track.states[i].feet_in_world;
    let middle = (run.start + run.end) / 2;
    let sight = waypoints[middle] - feet(middle);
    let radius = sight.truncate().length();
    let seen_from = |offset: DVec3| run.clone().map(|i| obstacles.visibility(i, feet(i) + offset)).sum::<f64>();
    let candidates = (0..AZIMUTHS).map(|a| {
        let (sin, cos) = real::sin_cos(real::TAU * a as f64 / AZIMUTHS as f64);
        DVec3::new(cos * radius, sin * radius, sight.z)
    });
    let Some(best) = candidates.max_by(|a, b| seen_from(*a).total_cmp(&seen_from(*b))) else { return };
    let reach = run.start.saturating_sub(RAMP_FRAMES)..(run.end + RAMP_FRAMES).min(waypoints.len());
    for i in reach {
        let outside = run.start.saturating_sub(i).max((i + 1).saturating_sub(run.end));
        let share = 1.0 - outside as f64 / (RAMP_FRAMES + 1) as f64;
        waypoints[i] = waypoints[i].lerp(feet(i) + best, share.clamp(0.0, 1.0));
    }
}

/// Step 2: stretches much longer than their chord become straight.
pub fn remove_detours(waypoints: &mut [DVec3]) {
    let mut first = 0;
    while first + DETOUR_FRAMES < waypoints.len() {
        let stretch = &mut waypoints[first..=first + DETOUR_FRAMES];
        let (from, to) = (stretch[0], stretch[DETOUR_FRAMES]);
        let way: f64 = stretch.windows(2).map(|w| w[1].distance(w[0])).sum();
        let chord = to.distance(from);
        if way > DETOUR_RATIO * chord && way - chord > 4.0 {
            for (k, waypoint) in stretch.iter_mut().enumerate() {
                *waypoint = from.lerp(to, k as f64 / DETOUR_FRAMES as f64);
            }
            first += DETOUR_FRAMES;
        } else {
            first += DETOUR_FRAMES / 2;
        }
    }
}

/// Step 3: where the horizontal velocity reverses, a sliding average replaces the path.
pub fn remove_oscillation(waypoints: &mut [DVec3]) {
    let before = waypoints.to_vec();
    let step = |i: usize| -> DVec2 { (before[i + 1] - before[i]).truncate() };
    for i in 2..before.len().saturating_sub(2) {
        let reverses = (i - 2..i + 1).any(|k| step(k).dot(step(k + 1)) < -0.01);
        if reverses {
            let average = before[i - 2..=i + 2].iter().sum::<DVec3>() / 5.0;
            waypoints[i] = DVec3::new(average.x, average.y, before[i].z);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_detour_becomes_straight_and_a_straight_path_stays() {
        let straight: Vec<DVec3> = (0..30).map(|i| DVec3::X * f64::from(i)).collect();
        let mut path = straight.clone();
        remove_detours(&mut path);
        assert_eq!(path, straight);
        for (i, waypoint) in path.iter_mut().enumerate().take(12).skip(1) {
            waypoint.y += 8.0 * (i as f64 * 0.26).min(3.0);
        }
        let length = |p: &[DVec3]| p.windows(2).map(|w| w[1].distance(w[0])).sum::<f64>();
        let before = length(&path);
        remove_detours(&mut path);
        assert!(length(&path) < before);
    }

    #[test]
    fn oscillation_shrinks_and_steady_flight_stays() {
        let steady: Vec<DVec3> = (0..20).map(|i| DVec3::X * f64::from(i)).collect();
        let mut path = steady.clone();
        remove_oscillation(&mut path);
        assert_eq!(path, steady);
        let mut shaking: Vec<DVec3> = (0..20).map(|i| DVec3::X * f64::from(i % 2)).collect();
        remove_oscillation(&mut shaking);
        assert!(shaking[4..16].windows(2).all(|w| w[1].distance(w[0]) < 0.5));
    }
}
