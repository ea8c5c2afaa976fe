//! Steps 5 and 6 of the clean-up: velocity repair and altitude smoothing (paper, safety layers 3 and 4).

use cosfly_frames::DVec3;
use cosfly_surroundings::Surroundings;

/// Weights of the low-pass filter of the altitude, from two frames before to two after.
const LOW_PASS: [f64; 5] = [1.0, 2.0, 3.0, 2.0, 1.0];

/// Spreads steps longer than `longest_m` over the waypoints that follow: each moves no further than allowed, and what
/// is missing is carried on until the path is caught up. Returns how many waypoints moved.
pub fn spread_spikes(longest_m: f64, waypoints: &mut [DVec3]) -> usize {
    let mut moved = 0;
    for i in 1..waypoints.len() {
        let step = waypoints[i] - waypoints[i - 1];
        if step.length() > longest_m {
            waypoints[i] = waypoints[i - 1] + step.clamp_length_max(longest_m);
            moved += 1;
        }
    }
    moved
}

/// Low-pass filter of the altitude. A frame that would sink keeps its altitude where sinking costs clearance or goes
/// below `floor_m` above ground ("SDF-aware descent check"); one that rises is not asked. Returns how many frames kept
/// theirs.
pub fn smooth_altitude(
    surroundings: &dyn Surroundings,
    clearance_m: f64,
    floor_m: f64,
    waypoints: &mut [DVec3],
) -> usize {
    let before: Vec<f64> = waypoints.iter().map(|w| w.z).collect();
    let mut kept = 0;
    for (frame, waypoint) in waypoints.iter_mut().enumerate() {
        let near = |k: usize| before[(frame + k).saturating_sub(2).min(before.len() - 1)];
        let sum: f64 = LOW_PASS.iter().enumerate().map(|(k, share)| share * near(k)).sum();
        let moved = DVec3::new(waypoint.x, waypoint.y, sum / LOW_PASS.iter().sum::<f64>());
        let sinks = moved.z < waypoint.z;
        let low = moved.z < surroundings.ground_z_m(moved.x, moved.y) + floor_m;
        if sinks && (low || surroundings.nearest(frame, moved, clearance_m).is_some()) {
            kept += 1;
        } else {
            *waypoint = moved;
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{Nothing, with_wall};
    use super::*;

    #[test]
    fn a_spike_is_spread_until_the_path_is_caught_up() {
        let mut path: Vec<DVec3> = (0..10).map(|i| DVec3::X * if i < 3 { 0.0 } else { 9.0 }).collect();
        assert_eq!(spread_spikes(2.0, &mut path), 4);
        assert!(path.windows(2).all(|w| w[1].distance(w[0]) <= 2.0 + 1e-9));
        assert_eq!(path[9].x, 9.0);
    }

    #[test]
    fn altitude_oscillation_shrinks() {
        let mut path: Vec<DVec3> =
            (0..20).map(|i| DVec3::new(f64::from(i), 0.0, 30.0 + 3.0 * f64::from(i % 2))).collect();
        assert_eq!(smooth_altitude(&Nothing, 1.5, 20.0, &mut path), 0);
        assert!(path.windows(2).skip(2).take(14).all(|w| (w[1].z - w[0].z).abs() < 1.0));
    }

    #[test]
    fn nobody_sinks_into_an_obstacle_or_below_the_floor() {
        with_wall(|_, obstacles, path| {
            // The wall's top is at 30 m; one waypoint stands just free above it among lower ones beside it.
            path.iter_mut().for_each(|w| *w = DVec3::new(w.x, 8.0, 25.0));
            path[10] = DVec3::new(path[10].x, 0.0, 31.6);
            assert!(smooth_altitude(obstacles, 1.5, 20.0, path) >= 1);
            assert_eq!(path[10].z, 31.6);
            path.iter_mut()
                .enumerate()
                .for_each(|(i, w)| *w = DVec3::new(w.x, 40.0, if i == 10 { 20.0 } else { 19.0 }));
            smooth_altitude(obstacles, 1.5, 20.0, path);
            assert_eq!(path[10].z, 20.0);
        });
    }
}
