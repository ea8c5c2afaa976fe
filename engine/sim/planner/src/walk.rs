//! Walking direction of the target, smoothed, and its steadiness (paper, section 3.2, viewpoint cost).

use cosfly_frames::{DVec2, TargetTrack};

/// Half of the window over which the walking direction is taken, seconds: the paper's 15 frames at its step of 0.5 s.
const HALF_WINDOW_S: f64 = 7.5;

/// Walking direction and directness per frame.
pub struct Walk {
    /// Horizontal unit vector of the net displacement over +-7.5 s; zero while standing.
    pub direction: Vec<DVec2>,
    /// Net displacement divided by the way walked in the window, 0..=1: falls while turning, 0 while standing.
    pub directness: Vec<f64>,
}

impl Walk {
    /// Reads the directions off a track.
    pub fn of(track: &TargetTrack) -> Self {
        let feet: Vec<DVec2> = track.states.iter().map(|state| state.feet_in_world.truncate()).collect();
        let mut way = vec![0.0; feet.len()];
        for i in 1..feet.len() {
            way[i] = way[i - 1] + feet[i].distance(feet[i - 1]);
        }
        let half_window = (HALF_WINDOW_S / track.dt_s).round().max(1.0) as usize;
        let window = |i: usize| {
            let (first, last) = (i.saturating_sub(half_window), i.saturating_add(half_window).min(feet.len() - 1));
            (feet[last] - feet[first], way[last] - way[first])
        };
        let direction = (0..feet.len()).map(|i| window(i).0.normalize_or_zero()).collect();
        let directness = (0..feet.len())
            .map(|i| {
                let (net, way) = window(i);
                if way > 0.05 { (net.length() / way).min(1.0) } else { 0.0 }
            })
            .collect();
        Self { direction, directness }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_frames::{DVec3, TargetState};

    /// A walk once around a square of 10 m at 1 m/s, from `dt_s` to `dt_s`.
    fn square(dt_s: f64) -> TargetTrack {
        let states = (0..(40.0 / dt_s) as usize).map(|frame| {
            let (side, along_m) = ((frame as f64 * dt_s / 10.0) as usize, (frame as f64 * dt_s) % 10.0);
            let (x, y) = [(along_m, 0.0), (10.0, along_m), (10.0 - along_m, 10.0), (0.0, 10.0 - along_m)][side.min(3)];
            TargetState { feet_in_world: DVec3::new(x, y, 0.0), heading_rad: 0.0, speed_mps: 1.0 }
        });
        TargetTrack { dt_s, height_m: 1.7, radius_m: 0.3, states: states.collect() }
    }

    #[test]
    fn the_walking_direction_does_not_depend_on_the_time_step() {
        let [coarse, fine] = [0.5, 0.1].map(|dt_s| Walk::of(&square(dt_s)));
        for frame in 0..64 {
            let apart = coarse.direction[frame].distance(fine.direction[5 * frame]);
            assert!(apart < 0.05, "frame {frame}: {apart}");
            assert!((coarse.directness[frame] - fine.directness[5 * frame]).abs() < 0.05, "frame {frame}");
        }
    }
}
