//! Step 1 of the clean-up: hidden stretches fly straight beside the target, where it is seen best.

use super::hidden_runs::{hidden_runs, ramp, safe_sight};
use crate::config::paper::PaperConfig;
use crate::problem::Problem;
use core::ops::Range;
use cosfly_frames::{DVec3, real};
use cosfly_surroundings::Surroundings;

/// Azimuths that are tried.
const AZIMUTHS: usize = 24;

/// Gives every long hidden run the azimuth round the target from which it is seen best in total, at the height and
/// distance that it has in the middle of the run; returns how many runs changed. "Straightening" is read as keeping
/// one offset from the target through the run. A run that no azimuth sees better stays.
pub fn straighten_hidden_runs(
    problem: &Problem<'_>,
    surroundings: &dyn Surroundings,
    paper: &PaperConfig,
    clearance_m: f64,
    waypoints: &mut [DVec3],
) -> usize {
    let mut changed = 0;
    for run in hidden_runs(surroundings, waypoints, paper.hidden_run_frames as usize) {
        if let Some(offset) = best_offset(problem, surroundings, clearance_m, &run, waypoints) {
            for (frame, share) in ramp(&run, paper.ramp_frames as usize, waypoints.len()) {
                waypoints[frame] = waypoints[frame].lerp(feet(problem, frame) + offset, share);
            }
            changed += 1;
        }
    }
    changed
}

fn feet(problem: &Problem<'_>, frame: usize) -> DVec3 {
    problem.track.states[frame].feet_in_world
}

/// The offset from the feet that sees most over the run, if it sees more than the run does.
fn best_offset(
    problem: &Problem<'_>,
    surroundings: &dyn Surroundings,
    clearance_m: f64,
    run: &Range<usize>,
    waypoints: &[DVec3],
) -> Option<DVec3> {
    let middle = (run.start + run.end) / 2;
    let sight = waypoints[middle] - feet(problem, middle);
    let radius = sight.truncate().length();
    let bearing = real::atan2(sight.y, sight.x);
    let mut best = (safe_sight(surroundings, clearance_m, run.clone(), |frame| waypoints[frame]), None);
    // From the present azimuth outwards, so that the smallest turn wins among equals.
    for turn in 0..AZIMUTHS {
        let steps = turn.div_ceil(2) as f64 * if turn % 2 == 0 { 1.0 } else { -1.0 };
        let (sin, cos) = real::sin_cos(bearing + steps * real::TAU / AZIMUTHS as f64);
        let offset = DVec3::new(cos * radius, sin * radius, sight.z);
        let seen = safe_sight(surroundings, clearance_m, run.clone(), |frame| feet(problem, frame) + offset);
        if seen > best.0 {
            best = (seen, Some(offset));
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::with_wall;
    use super::*;

    #[test]
    fn a_hidden_run_moves_to_where_the_target_is_seen() {
        with_wall(|problem, obstacles, path| {
            let paper = PaperConfig::default();
            assert_eq!(hidden_runs(obstacles, path, 5).len(), 1);
            assert_eq!(straighten_hidden_runs(problem, obstacles, &paper, 1.5, path), 1);
            assert!(hidden_runs(obstacles, path, 5).is_empty());
            assert_eq!(straighten_hidden_runs(problem, obstacles, &paper, 1.5, path), 0);
        });
    }
}
