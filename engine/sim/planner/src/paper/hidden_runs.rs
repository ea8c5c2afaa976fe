//! Stretches in which the target is hidden for long, and how a change of one runs into the rest.

use core::ops::Range;
use cosfly_frames::DVec3;
use cosfly_surroundings::Surroundings;

/// Below this visibility a frame counts as hidden.
const HIDDEN_BELOW: f64 = 0.5;

/// The runs of more than `longer_than` hidden frames, in order.
pub fn hidden_runs(surroundings: &dyn Surroundings, waypoints: &[DVec3], longer_than: usize) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut first = 0;
    for frame in 0..=waypoints.len() {
        let hidden = waypoints.get(frame).is_some_and(|&w| surroundings.visibility(frame, w) < HIDDEN_BELOW);
        if !hidden {
            if frame - first > longer_than {
                runs.push(first..frame);
            }
            first = frame + 1;
        }
    }
    runs
}

/// Value of a stretch of waypoints: the sum of their visibility, 0 for those that are unsafe.
pub fn safe_sight(
    surroundings: &dyn Surroundings,
    clearance_m: f64,
    run: Range<usize>,
    at: impl Fn(usize) -> DVec3,
) -> f64 {
    let worth = |frame: usize| {
        let waypoint = at(frame);
        match surroundings.nearest(frame, waypoint, clearance_m) {
            None => surroundings.visibility(frame, waypoint),
            Some(_) => 0.0,
        }
    };
    run.map(worth).sum()
}

/// The frames that a change of `run` touches, each with the share of the change that it takes: 1 within the run,
/// falling to 0 over `ramp_frames` on both sides, smoothly.
pub fn ramp(run: &Range<usize>, ramp_frames: usize, frames: usize) -> impl Iterator<Item = (usize, f64)> + use<> {
    let run = run.clone();
    let reach = run.start.saturating_sub(ramp_frames)..(run.end + ramp_frames).min(frames);
    reach.map(move |frame| {
        let outside = run.start.saturating_sub(frame).max((frame + 1).saturating_sub(run.end));
        let linear = 1.0 - outside as f64 / (ramp_frames + 1) as f64;
        (frame, linear * linear * (3.0 - 2.0 * linear))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Fog;

    impl Surroundings for Fog {
        fn visibility(&self, _: usize, position: DVec3) -> f64 {
            f64::from(u8::from(!(10.0..20.0).contains(&position.x) && position.x != 25.0))
        }
        fn nearest(&self, _: usize, position: DVec3, _: f64) -> Option<(f64, DVec3)> {
            (position.y > 0.0).then_some((1.0, -DVec3::Y))
        }
        fn ground_z_m(&self, _: f64, _: f64) -> f64 {
            0.0
        }
    }

    #[test]
    fn only_long_runs_are_found_also_at_the_end() {
        let path: Vec<DVec3> = (0..30).map(|i| DVec3::X * f64::from(i)).collect();
        assert_eq!(hidden_runs(&Fog, &path, 5), vec![10..20]);
        assert_eq!(hidden_runs(&Fog, &path[..16], 5), vec![10..16]);
        assert_eq!(hidden_runs(&Fog, &path[..15], 5), vec![]);
        assert_eq!(hidden_runs(&Fog, &[], 5), vec![]);
    }

    #[test]
    fn unsafe_frames_are_worth_nothing() {
        assert_eq!(safe_sight(&Fog, 1.5, 0..5, |_| DVec3::ZERO), 5.0);
        assert_eq!(safe_sight(&Fog, 1.5, 0..5, |_| DVec3::Y), 0.0);
    }

    #[test]
    fn ramps_rise_to_one_within_the_run() {
        let shares: Vec<(usize, f64)> = ramp(&(10..12), 3, 13).collect();
        assert_eq!(shares.iter().map(|s| s.0).collect::<Vec<_>>(), [7, 8, 9, 10, 11, 12]);
        assert!(shares[0].1 < shares[1].1 && shares[2].1 < 1.0 && shares[3].1 == 1.0 && shares[5].1 < 1.0);
    }
}
