//! Geometric safety projection (paper, algorithm 1): unsafe waypoints are lifted, led round or pushed out.

use crate::obstacles::{Surroundings, local::LocalObstacles};
use crate::problem::Problem;
use cosfly_frames::{DVec3, real};

/// Penetration beyond which only a large push along the distance gradient is tried, metres.
const DEEP_M: f64 = 5.0;
/// A lift up to this height is preferred to everything else, metres.
const EASY_LIFT_M: f64 = 3.0;
/// Half-angle of the detour fan, degrees.
const FAN_DEG: f64 = 35.0;
/// What a hidden target weighs against a square metre of displacement.
const SIGHT_WEIGHT: f64 = 20.0;

/// Pushes every waypoint out to `clearance_m`, up to `rounds` times; returns how many are still unsafe.
pub fn project(
    problem: &Problem<'_>,
    obstacles: &LocalObstacles<'_>,
    clearance_m: f64,
    rounds: usize,
    waypoints: &mut [DVec3],
) -> usize {
    let mut unsafe_count = 0;
    for _ in 0..rounds {
        unsafe_count = 0;
        for (frame, waypoint) in waypoints.iter_mut().enumerate() {
            if !is_free(obstacles, frame, *waypoint, clearance_m) {
                *waypoint = corrected(problem, obstacles, frame, *waypoint, clearance_m);
                unsafe_count += usize::from(!is_free(obstacles, frame, *waypoint, clearance_m));
            }
        }
        if unsafe_count == 0 {
            break;
        }
    }
    unsafe_count
}

fn is_free(obstacles: &LocalObstacles<'_>, frame: usize, position: DVec3, clearance_m: f64) -> bool {
    obstacles.nearest(frame, position, clearance_m).is_none()
}

fn corrected(
    problem: &Problem<'_>,
    obstacles: &LocalObstacles<'_>,
    frame: usize,
    waypoint: DVec3,
    clearance_m: f64,
) -> DVec3 {
    let Some((distance, away)) = obstacles.nearest(frame, waypoint, clearance_m) else { return waypoint };
    if -distance > DEEP_M {
        return pushed_out(obstacles, frame, waypoint, clearance_m);
    }
    for step in 1..=6 {
        let lifted = waypoint + DVec3::Z * (EASY_LIFT_M * f64::from(step) / 6.0);
        if is_free(obstacles, frame, lifted, clearance_m) {
            return lifted;
        }
    }
    let price = |candidate: &DVec3| {
        let hidden = 1.0 - obstacles.visibility(frame, *candidate);
        candidate.distance_squared(waypoint) + SIGHT_WEIGHT * hidden * hidden
    };
    strategies(problem, frame, waypoint, away)
        .into_iter()
        .filter(|candidate| is_free(obstacles, frame, *candidate, clearance_m))
        .min_by(|a, b| price(a).total_cmp(&price(b)))
        .unwrap_or_else(|| pushed_out(obstacles, frame, waypoint, clearance_m))
}

/// Large steps along the gradient of the distance.
fn pushed_out(obstacles: &LocalObstacles<'_>, frame: usize, waypoint: DVec3, clearance_m: f64) -> DVec3 {
    let mut position = waypoint;
    for _ in 0..8 {
        match obstacles.nearest(frame, position, clearance_m) {
            Some((distance, away)) => position += (clearance_m - distance + 0.05) * away,
            None => break,
        }
    }
    position
}

/// Vertical lift, forward bypass, horizontal detour in a fan, local displacement.
fn strategies(problem: &Problem<'_>, frame: usize, waypoint: DVec3, away: DVec3) -> Vec<DVec3> {
    let mut candidates = Vec::new();
    let ahead = problem.walk.direction[frame].extend(0.0);
    let outward = DVec3::new(away.x, away.y, 0.0).normalize_or(ahead);
    for step in 1..=10 {
        let length = f64::from(step);
        candidates.push(waypoint + DVec3::Z * length);
        candidates.push(waypoint + ahead * length);
        candidates.push(waypoint - ahead * length);
        for turn_deg in [-FAN_DEG, -0.5 * FAN_DEG, 0.0, 0.5 * FAN_DEG, FAN_DEG] {
            let (sin, cos) = real::sin_cos(turn_deg.to_radians());
            let side = DVec3::new(cos * outward.x - sin * outward.y, sin * outward.x + cos * outward.y, 0.0);
            candidates.push(waypoint + side * length);
        }
    }
    for code in 0..27 {
        let digit = |power: i32| f64::from((code / power) % 3 - 1);
        let direction = DVec3::new(digit(1), digit(3), digit(9)).normalize_or_zero();
        candidates.push(waypoint + direction);
        candidates.push(waypoint + 2.0 * direction);
    }
    candidates
}
