//! The seven post-processing steps (paper, appendix A.4), in its order, each as it is described.

use super::counts::PaperCounts;
use super::detours::remove_detours;
use super::focus::FocusedSurroundings;
use super::oscillation::remove_oscillation;
use super::projection::project;
use super::repair::{smooth_altitude, spread_spikes};
use super::straighten::straighten_hidden_runs;
use crate::config::muco::MucoConfig;
use crate::config::paper::PaperConfig;
use crate::problem::Problem;
use cosfly_frames::DVec3;

/// Applies all steps to `waypoints`; returns how many waypoints the final check still finds unsafe.
pub fn postprocess(
    problem: &Problem<'_>,
    surroundings: &mut dyn FocusedSurroundings,
    config: &MucoConfig,
    paper: &PaperConfig,
    counts: &mut PaperCounts,
    waypoints: &mut [DVec3],
) -> usize {
    let clearance_m = config.limits.clearance_m;
    let longest_m = config.limits.speed_mps * problem.track.dt_s;
    let floor_m = problem.view.min_altitude_m;
    surroundings.focus_on(waypoints);
    counts.straightened_runs = straighten_hidden_runs(problem, surroundings.answers(), paper, clearance_m, waypoints);
    surroundings.focus_on(waypoints);
    counts.detours_removed = remove_detours(surroundings.answers(), clearance_m, waypoints);
    counts.oscillations_averaged = remove_oscillation(waypoints);
    surroundings.focus_on(waypoints);
    let projected = project(problem, surroundings.answers(), clearance_m, paper.projection_rounds, waypoints);
    counts.spikes_spread = spread_spikes(longest_m, waypoints);
    surroundings.focus_on(waypoints);
    counts.altitudes_kept = smooth_altitude(surroundings.answers(), clearance_m, floor_m, waypoints);
    surroundings.focus_on(waypoints);
    // The final check: what fails is projected once more, and what then fails is told.
    let checked = project(problem, surroundings.answers(), clearance_m, 1, waypoints);
    counts.projections = projected.corrected + checked.corrected;
    checked.unsafe_waypoints
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::with_wall;
    use super::*;
    use cosfly_surroundings::Surroundings;

    #[test]
    fn the_steps_leave_a_safe_visible_path_beside_a_wall() {
        with_wall(|problem, obstacles, path| {
            let (config, paper) = (MucoConfig::default(), PaperConfig::default());
            let mut counts = PaperCounts::default();
            path[30] = DVec3::new(path[30].x, 0.0, 25.0);
            let mean = |obstacles: &dyn Surroundings, path: &[DVec3]| {
                path.iter().enumerate().map(|(i, w)| obstacles.visibility(i, *w)).sum::<f64>() / path.len() as f64
            };
            let before = mean(obstacles, path);
            assert_eq!(postprocess(problem, obstacles, &config, &paper, &mut counts, path), 0);
            assert!(mean(obstacles, path) > before + 0.3, "{before} {}", mean(obstacles, path));
            assert_eq!(counts.straightened_runs, 1);
        });
    }
}
