//! Walking direction of the target, smoothed, and its steadiness (paper, section 3.2, viewpoint cost).

use cosfly_frames::{DVec2, TargetTrack};

/// Half of the window over which the walking direction is taken, frames.
const HALF_WINDOW: usize = 15;

/// Walking direction and directness per frame.
pub struct Walk {
    /// Horizontal unit vector of the net displacement over +-15 frames; zero while standing.
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
        let window = |i: usize| {
            let (first, last) = (i.saturating_sub(HALF_WINDOW), (i + HALF_WINDOW).min(feet.len() - 1));
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
