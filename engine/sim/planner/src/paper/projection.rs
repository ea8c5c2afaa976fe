//! Geometric safety projection (paper, algorithm 1): unsafe waypoints are lifted, led round or pushed out.

use super::neighbourhood::Neighbourhood;
use crate::problem::Problem;
use cosfly_frames::{DVec3, real};
use cosfly_surroundings::Surroundings;

/// Penetration beyond which only a large push along the distance gradient is tried, metres.
const DEEP_M: f64 = 5.0;
/// A lift up to this height is preferred to everything else, metres.
const EASY_LIFT_M: f64 = 3.0;
/// Step of the small lifts, metres.
const LIFT_STEP_M: f64 = 0.5;
/// Longest displacement of the other strategies, metres.
const LONGEST_M: u32 = 10;
/// Half-angle of the detour fan, degrees.
const FAN_DEG: f64 = 35.0;
/// Pushes along the distance gradient, at most.
const PUSHES: u32 = 8;
/// Pushes end this much beyond the limit, metres.
const PUSH_EXTRA_M: f64 = 0.05;

/// Result of a projection.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Projected {
    /// Corrections of waypoints, over all rounds.
    pub corrected: usize,
    /// Waypoints that are still unsafe.
    pub unsafe_waypoints: usize,
}

/// Pushes every waypoint out to `clearance_m`, up to `rounds` times.
pub fn project(
    problem: &Problem<'_>,
    surroundings: &dyn Surroundings,
    clearance_m: f64,
    rounds: u32,
    waypoints: &mut [DVec3],
) -> Projected {
    let mut done = Projected { corrected: 0, unsafe_waypoints: count_unsafe(surroundings, clearance_m, waypoints) };
    for _ in 0..rounds {
        if done.unsafe_waypoints == 0 {
            break;
        }
        for frame in 0..waypoints.len() {
            let corrected = corrected(problem, surroundings, clearance_m, frame, waypoints);
            done.corrected += usize::from(corrected != waypoints[frame]);
            waypoints[frame] = corrected;
        }
        done.unsafe_waypoints = count_unsafe(surroundings, clearance_m, waypoints);
    }
    done
}

/// Number of waypoints nearer to an obstacle than `clearance_m`.
pub fn count_unsafe(surroundings: &dyn Surroundings, clearance_m: f64, waypoints: &[DVec3]) -> usize {
    waypoints.iter().enumerate().filter(|(frame, w)| surroundings.nearest(*frame, **w, clearance_m).is_some()).count()
}

/// Algorithm 1 for one waypoint; a safe one stays.
fn corrected(
    problem: &Problem<'_>,
    surroundings: &dyn Surroundings,
    clearance_m: f64,
    frame: usize,
    waypoints: &[DVec3],
) -> DVec3 {
    let waypoint = waypoints[frame];
    let Some((distance, away)) = surroundings.nearest(frame, waypoint, clearance_m) else { return waypoint };
    let pushed = || pushed_out(surroundings, clearance_m, frame, waypoint);
    if -distance > DEEP_M {
        return pushed();
    }
    let is_free = |place: &DVec3| surroundings.nearest(frame, *place, clearance_m).is_none();
    let lift = |step: u32| waypoint + DVec3::Z * (LIFT_STEP_M * f64::from(step));
    if let Some(lifted) = (1..=(EASY_LIFT_M / LIFT_STEP_M) as u32).map(lift).find(is_free) {
        return lifted;
    }
    let mut near = Neighbourhood::around(problem, surroundings, frame, waypoints);
    strategies(problem, frame, waypoint, away)
        .into_iter()
        .filter(is_free)
        .map(|place| (near.cost_with(place), place))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map_or_else(pushed, |(_, place)| place)
}

/// Large steps along the gradient of the distance.
fn pushed_out(surroundings: &dyn Surroundings, clearance_m: f64, frame: usize, waypoint: DVec3) -> DVec3 {
    let mut position = waypoint;
    for _ in 0..PUSHES {
        match surroundings.nearest(frame, position, clearance_m) {
            Some((distance, away)) => position += (clearance_m - distance + PUSH_EXTRA_M) * away,
            None => break,
        }
    }
    position
}

/// Vertical lift, forward bypass, horizontal detour in a fan, local displacement.
fn strategies(problem: &Problem<'_>, frame: usize, waypoint: DVec3, away: DVec3) -> Vec<DVec3> {
    let mut places = Vec::new();
    let ahead = problem.walk.direction[frame].extend(0.0);
    let outward = DVec3::new(away.x, away.y, 0.0).normalize_or(ahead);
    for step in 1..=LONGEST_M {
        let length_m = f64::from(step);
        places.push(waypoint + DVec3::Z * length_m);
        places.push(waypoint + ahead * length_m);
        for turn_deg in [-FAN_DEG, -0.5 * FAN_DEG, 0.0, 0.5 * FAN_DEG, FAN_DEG] {
            let (sin, cos) = real::sin_cos(turn_deg.to_radians());
            let side = DVec3::new(cos * outward.x - sin * outward.y, sin * outward.x + cos * outward.y, 0.0);
            places.push(waypoint + side * length_m);
        }
    }
    for code in 0..27 {
        let digit = |power: i32| f64::from((code / power) % 3 - 1);
        let direction = DVec3::new(digit(1), digit(3), digit(9)).normalize_or_zero();
        places.push(waypoint + direction);
        places.push(waypoint + 2.0 * direction);
    }
    places
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::with_wall;
    use super::*;

    #[test]
    fn waypoints_in_and_near_a_wall_come_out() {
        with_wall(|problem, obstacles, path| {
            // The wall is 2 m thick, 30 m high, in the plane y = 0.
            for (frame, waypoint) in path.iter_mut().enumerate() {
                *waypoint = DVec3::new(waypoint.x, 0.4 * f64::from(frame as u32 % 5) - 0.8, 26.0);
            }
            let count = count_unsafe(obstacles, 1.5, path);
            assert!(count > 0);
            let done = project(problem, obstacles, 1.5, 5, path);
            assert_eq!(done.unsafe_waypoints, 0);
            assert!(done.corrected >= count);
            assert_eq!(project(problem, obstacles, 1.5, 5, path), Projected::default());
        });
    }

    #[test]
    fn a_small_lift_is_preferred() {
        with_wall(|problem, obstacles, path| {
            path[10] = DVec3::new(path[10].x, 0.0, 30.2);
            let place = corrected(problem, obstacles, 1.5, 10, path);
            assert_eq!(place, path[10] + DVec3::Z * 1.5);
        });
    }
}
