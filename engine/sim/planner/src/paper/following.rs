//! Dynamic following (paper, algorithm 2, line 3): the start keeps its distance and its speed.

use crate::problem::Problem;
use cosfly_frames::DVec3;

/// Keeps every waypoint between the two horizontal distances from the target (metres, along its own bearing), and
/// every step within `longest_m`: what is missing is caught up later ("monitor distance, prevent overshooting").
/// Returns how many waypoints moved.
pub fn follow(problem: &Problem<'_>, ring_m: (f64, f64), longest_m: f64, waypoints: &mut [DVec3]) -> usize {
    let mut moved = 0;
    for i in 0..waypoints.len() {
        let before = waypoints[i];
        let feet = problem.track.states[i].feet_in_world;
        let sight = (before - feet).truncate();
        let distance = sight.length();
        if distance > 1e-6 && ring_m.0 <= ring_m.1 {
            let place = feet.truncate() + sight * (distance.clamp(ring_m.0, ring_m.1) / distance);
            waypoints[i] = place.extend(before.z);
        }
        if i > 0 {
            let step = waypoints[i] - waypoints[i - 1];
            if step.length() > longest_m {
                waypoints[i] = waypoints[i - 1] + step.clamp_length_max(longest_m);
            }
        }
        moved += usize::from(waypoints[i].distance_squared(before) > 1e-12);
    }
    moved
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::with_street;
    use super::*;

    #[test]
    fn distances_and_steps_are_kept() {
        with_street(|problem, _, _, path| {
            for w in path.iter_mut().skip(20) {
                w.x += 40.0;
            }
            assert!(follow(problem, (14.0, 24.0), 6.0, path) > 10);
            assert!(path.windows(2).all(|w| w[1].distance(w[0]) <= 6.0 + 1e-9));
            let last = path.len() - 1;
            let across = (path[last] - problem.track.states[last].feet_in_world).truncate().length();
            assert!((14.0 - 1e-9..=24.0 + 1e-9).contains(&across), "{across}");
        });
    }
}
