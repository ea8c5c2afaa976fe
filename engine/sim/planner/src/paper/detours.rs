//! Step 2 of the clean-up: stretches that bend far off their chord become straight.

use super::hidden_runs::safe_sight;
use cosfly_frames::DVec3;
use cosfly_surroundings::Surroundings;

/// Frames of a stretch that is looked at.
const STRETCH_FRAMES: usize = 12;
/// A stretch this many times longer than its chord is a detour ("high-curvature").
const DETOUR_RATIO: f64 = 1.5;
/// Length that a detour has beyond its chord at least, metres.
const DETOUR_EXTRA_M: f64 = 4.0;

/// Replaces detours by their chords; returns how many. A chord that is less safe or sees less than the detour is not
/// taken, for then the detour had a reason.
pub fn remove_detours(surroundings: &dyn Surroundings, clearance_m: f64, waypoints: &mut [DVec3]) -> usize {
    let mut removed = 0;
    let mut first = 0;
    while first + STRETCH_FRAMES < waypoints.len() {
        let stretch = first..first + STRETCH_FRAMES + 1;
        let (from, to) = (waypoints[first], waypoints[first + STRETCH_FRAMES]);
        let way: f64 = waypoints[stretch.clone()].windows(2).map(|w| w[1].distance(w[0])).sum();
        let chord = to.distance(from);
        let on_chord = |frame: usize| from.lerp(to, (frame - first) as f64 / STRETCH_FRAMES as f64);
        let worth = |at: &dyn Fn(usize) -> DVec3| safe_sight(surroundings, clearance_m, stretch.clone(), at);
        let detour = way > DETOUR_RATIO * chord && way - chord > DETOUR_EXTRA_M;
        if detour && worth(&on_chord) >= worth(&|frame| waypoints[frame]) {
            stretch.clone().for_each(|frame| waypoints[frame] = on_chord(frame));
            removed += 1;
            first += STRETCH_FRAMES;
        } else {
            first += STRETCH_FRAMES / 2;
        }
    }
    removed
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::Nothing;
    use super::*;

    #[test]
    fn a_detour_becomes_straight_and_a_straight_path_stays() {
        let straight: Vec<DVec3> = (0..30).map(|i| DVec3::X * f64::from(i)).collect();
        let mut path = straight.clone();
        assert_eq!(remove_detours(&Nothing, 1.5, &mut path), 0);
        assert_eq!(path, straight);
        for (i, waypoint) in path.iter_mut().enumerate().take(12).skip(1) {
            waypoint.y += 2.0 * i.min(12 - i) as f64;
        }
        assert_eq!(remove_detours(&Nothing, 1.5, &mut path), 1);
        assert!(path.iter().zip(&straight).all(|(a, b)| a.distance(*b) < 1e-9));
    }
}
