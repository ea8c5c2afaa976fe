//! Step 3 of the clean-up: where the horizontal velocity reverses, a sliding average takes the place of the path.

use cosfly_frames::{DVec2, DVec3};

/// Half of the window that is averaged, frames.
const HALF_WINDOW: usize = 2;
/// Steps shorter than this have no direction to reverse, metres.
const STANDING_M: f64 = 0.1;

/// Averages the horizontal places of the waypoints near a reversal over five frames; returns how many changed. The
/// altitude has its own filter.
pub fn remove_oscillation(waypoints: &mut [DVec3]) -> usize {
    let before = waypoints.to_vec();
    let step = |i: usize| -> DVec2 { (before[i + 1] - before[i]).truncate() };
    let reverses = |i: usize| {
        let (a, b) = (step(i), step(i + 1));
        a.dot(b) < 0.0 && a.length() > STANDING_M && b.length() > STANDING_M
    };
    let mut changed = 0;
    for i in HALF_WINDOW..before.len().saturating_sub(HALF_WINDOW) {
        if (i - HALF_WINDOW..i + HALF_WINDOW - 1).any(reverses) {
            let window = &before[i - HALF_WINDOW..=i + HALF_WINDOW];
            let mean = window.iter().sum::<DVec3>() / window.len() as f64;
            waypoints[i] = DVec3::new(mean.x, mean.y, before[i].z);
            changed += 1;
        }
    }
    changed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn oscillation_shrinks_and_steady_flight_stays() {
        let steady: Vec<DVec3> = (0..20).map(|i| DVec3::X * f64::from(i)).collect();
        let mut path = steady.clone();
        assert_eq!(remove_oscillation(&mut path), 0);
        assert_eq!(path, steady);
        let mut shaking: Vec<DVec3> = (0..20).map(|i| DVec3::X * f64::from(i % 2)).collect();
        assert!(remove_oscillation(&mut shaking) > 10);
        assert!(shaking[4..16].windows(2).all(|w| w[1].distance(w[0]) < 0.5));
    }

    #[test]
    fn short_paths_are_left_alone() {
        for length in 0..5 {
            let mut path: Vec<DVec3> = (0..length).map(|i| DVec3::X * f64::from(i % 2)).collect();
            remove_oscillation(&mut path);
            assert_eq!(path.len(), length as usize);
        }
    }
}
