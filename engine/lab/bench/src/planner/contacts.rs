//! The judge of flights among boxes that move. It shares no code with the planner: places are sampled finely in time, and
//! distances are measured in each box's own axes.

use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, real};

/// Moments that are looked at from frame to frame.
const MOMENTS: usize = 25;

/// Smallest distance of a flight from boxes that move, over moments a 25th of a frame apart, capped at `cap_m`, metres. Between
/// frames the drone goes straight and evenly; a box does, too, and turns the shorter way.
pub fn least_distance_m(waypoints: &[DVec3], movers: &[Vec<OrientedBox>], cap_m: f64) -> f64 {
    let mut least = cap_m;
    for places in movers {
        for frame in 0..waypoints.len() {
            let next = (frame + 1).min(waypoints.len() - 1);
            let (a, b) = (&places[frame], &places[next]);
            // The drone and the box each go less than this from their places at the frame.
            let ways = waypoints[frame].distance(waypoints[next]) + a.center_in_world.distance(b.center_in_world);
            let reach = a.half_extents_m.length().max(b.half_extents_m.length());
            if waypoints[frame].distance(a.center_in_world) - ways - reach >= least {
                continue;
            }
            for moment in 0..=MOMENTS {
                let share = moment as f64 / MOMENTS as f64;
                let drone = waypoints[frame] + (waypoints[next] - waypoints[frame]) * share;
                least = least.min(distance_m(drone, a, b, share));
            }
        }
    }
    least
}

/// Distance from a box part of the way between two places.
fn distance_m(drone: DVec3, a: &OrientedBox, b: &OrientedBox, share: f64) -> f64 {
    let middle = a.center_in_world + (b.center_in_world - a.center_in_world) * share;
    let turn = (b.yaw_rad - a.yaw_rad + real::PI).rem_euclid(real::TAU) - real::PI;
    let (sin, cos) = real::sin_cos(a.yaw_rad + turn * share);
    let away = drone - middle;
    let half = a.half_extents_m + (b.half_extents_m - a.half_extents_m) * share;
    let beyond = [
        (away.x * cos + away.y * sin).abs() - half.x,
        (away.y * cos - away.x * sin).abs() - half.y,
        away.z.abs() - half.z,
    ];
    let outside = beyond.iter().map(|beyond| beyond.max(0.0) * beyond.max(0.0)).sum::<f64>().sqrt();
    if outside > 0.0 { outside } else { beyond.into_iter().fold(f64::NEG_INFINITY, f64::max) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_that_passes_between_two_frames_is_met() {
        let shape = |y: f64| OrientedBox {
            center_in_world: DVec3::new(0.0, y, 20.0),
            half_extents_m: DVec3::new(2.0, 0.5, 0.5),
            yaw_rad: 0.5 * real::PI,
        };
        let hover = [DVec3::new(1.0, 0.0, 20.0); 2];
        let least = |from: f64, to: f64| least_distance_m(&hover, &[vec![shape(from), shape(to)]], 9.0);
        assert!((least(-10.0, 10.0) - 0.5).abs() < 1e-9);
        assert!((least(-10.0, -6.0) - (16.0f64 + 0.25).sqrt()).abs() < 1e-9);
    }
}
