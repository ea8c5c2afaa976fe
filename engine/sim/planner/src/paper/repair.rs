//! Velocity repair and altitude smoothing (paper, section 3.3, safety layers 3 and 4).

use crate::obstacles::{Surroundings, local::LocalObstacles};
use cosfly_frames::DVec3;

/// Spreads steps longer than `longest_m` over the waypoints that follow: each is moved no further than allowed,
/// and what is missing is carried on until the path is caught up.
pub fn redistribute_spikes(longest_m: f64, waypoints: &mut [DVec3]) {
    for i in 1..waypoints.len() {
        let step = waypoints[i] - waypoints[i - 1];
        if step.length() > longest_m {
            waypoints[i] = waypoints[i - 1] + step.clamp_length_max(longest_m);
        }
    }
}

/// Low-pass filter of the altitude; a frame descends only while that keeps `clearance_m` and `floor_m` above
/// ground.
pub fn smooth_altitude(obstacles: &LocalObstacles<'_>, clearance_m: f64, floor_m: f64, waypoints: &mut [DVec3]) {
    let before: Vec<f64> = waypoints.iter().map(|w| w.z).collect();
    for (i, waypoint) in waypoints.iter_mut().enumerate() {
        let last = before.len() - 1;
        let near = [-2_isize, -1, 0, 1, 2].map(|k| before[i.saturating_add_signed(k).min(last)]);
        let z = (near[0] + 2.0 * near[1] + 3.0 * near[2] + 2.0 * near[3] + near[4]) / 9.0;
        let moved = DVec3::new(waypoint.x, waypoint.y, z);
        let low = z < waypoint.z && z < obstacles.ground_z_m(waypoint.x, waypoint.y) + floor_m;
        if !low && obstacles.nearest(i, moved, clearance_m).is_none() {
            *waypoint = moved;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spike_is_spread_until_the_path_is_caught_up() {
        let mut path: Vec<DVec3> = (0..10).map(|i| DVec3::X * if i < 3 { 0.0 } else { 9.0 }).collect();
        redistribute_spikes(2.0, &mut path);
        assert!(path.windows(2).all(|w| w[1].distance(w[0]) <= 2.0 + 1e-9));
        assert_eq!(path[9].x, 9.0);
    }
}
