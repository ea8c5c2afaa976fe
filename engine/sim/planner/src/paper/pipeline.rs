//! The paper's pipeline from start to final check.

use super::counts::PaperCounts;
use super::descent::descend;
use super::differences::{Threads, context};
use super::focus::FocusedSurroundings;
use super::near_boxes::NearBoxes;
use super::postprocess::postprocess;
use super::start::initial_path;
use crate::config::muco::MucoConfig;
use crate::config::paper::PaperConfig;
use crate::gradient::total_cost;
use crate::problem::Problem;
use cosfly_frames::DVec3;
use cosfly_surroundings::local::LocalObstacles;

/// Flight of the paper's pipeline. Neither safe nor flyable until measured.
#[derive(Clone, Debug, PartialEq)]
pub struct PaperFlight {
    /// One waypoint per frame, world frame, metres.
    pub waypoints: Vec<DVec3>,
    /// Total cost at the start, after each iteration of the descent, and after post-processing (which may raise it).
    pub convergence: Vec<f64>,
    /// Iterations of the descent.
    pub iterations: u32,
    /// Counts of the work done.
    pub counts: PaperCounts,
    /// Waypoints nearer than the clearance limit to a planning box after the final check.
    pub unsafe_waypoints: usize,
}

/// Plans as the paper does, on the calling thread. Targets that have companions or are to be lost, and boxes that move,
/// are not in the paper; its pipeline takes them from the surroundings like everything else, only more slowly.
pub fn plan_paper(problem: &Problem<'_>, obstacles: &mut LocalObstacles<'_>, config: &MucoConfig) -> PaperFlight {
    match NearBoxes::new(obstacles, problem.track.len(), problem.view.safety_influence_m) {
        Some(mut near) => plan_paper_in(problem, &mut near, config, &config.paper, Threads::Caller),
        None => plan_paper_in(problem, obstacles, config, &config.paper, Threads::Caller),
    }
}

/// [`plan_paper`] in any surroundings, with its own parameters, and gradients on one thread or all, which gives the same
/// bytes.
pub fn plan_paper_in(
    problem: &Problem<'_>,
    surroundings: &mut dyn FocusedSurroundings,
    config: &MucoConfig,
    paper: &PaperConfig,
    threads: Threads,
) -> PaperFlight {
    let mut counts = PaperCounts::default();
    let mut waypoints = initial_path(problem, surroundings, config, paper, &mut counts);
    let descent = descend(problem, surroundings, &config.descent, threads, &mut waypoints);
    let iterations = descent.costs.len().saturating_sub(1) as u32;
    counts.gradients = descent.gradients;
    counts.steps_taken_back = descent.steps_taken_back;
    let unsafe_waypoints = postprocess(problem, surroundings, config, paper, &mut counts, &mut waypoints);
    let mut convergence = descent.costs;
    surroundings.focus_on(&waypoints);
    convergence.push(total_cost(problem.terms, &waypoints, &context(problem, surroundings.answers())));
    PaperFlight { waypoints, convergence, iterations, counts, unsafe_waypoints }
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{paper_config, with, with_street};
    use super::*;
    use cosfly_domain::OrientedBox;
    use cosfly_frames::TargetTrack;
    use cosfly_scenes::{Scene, SceneKind};
    use cosfly_surroundings::Surroundings;

    #[test]
    fn the_same_bytes_come_from_one_thread_and_four() {
        with_street(|problem, obstacles, config, _| {
            let alone = plan_paper(problem, obstacles, config);
            let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().unwrap();
            let scene = Scene::generate(SceneKind::Leafy, 2);
            let together = pool.install(|| {
                let mut result = None;
                with(problem.track, &scene.boxes, |problem, obstacles| {
                    let paper = PaperConfig::default();
                    result = Some(plan_paper_in(problem, obstacles, config, &paper, Threads::Pool));
                });
                result.unwrap()
            });
            assert_eq!(alone, together);
        });
    }

    #[test]
    fn the_same_bytes_come_from_every_vector_level() {
        with_street(|problem, obstacles, config, _| {
            let expected = plan_paper(problem, obstacles, config);
            for level in cosfly_frames::simd::Level::available() {
                let mut near = NearBoxes::new(obstacles, problem.track.len(), problem.view.safety_influence_m)
                    .unwrap()
                    .at_level(level);
                let paper = PaperConfig::default();
                let found = plan_paper_in(problem, &mut near, config, &paper, Threads::Caller);
                assert_eq!(found, expected, "{}", level.name());
            }
        });
    }

    #[test]
    fn a_light_street_is_seen_about_as_well_as_the_paper_says() {
        let scene = Scene::generate(SceneKind::Light, 1);
        let mut seen = 0.0;
        for index in 0..4 {
            let track = scene.walker(1, index);
            with(&track, &scene.boxes, |problem, obstacles| {
                let flight = plan_paper(problem, obstacles, &paper_config());
                assert_eq!(flight.waypoints.len(), track.len());
                assert_eq!(flight.convergence.len(), flight.iterations as usize + 2);
                let at = |(frame, w): (usize, &DVec3)| obstacles.visibility(frame, *w);
                seen += flight.waypoints.iter().enumerate().map(at).sum::<f64>() / (4 * track.len()) as f64;
            });
        }
        assert!((0.88..0.995).contains(&seen), "{seen}");
    }

    #[test]
    fn tracks_of_few_frames_and_of_none_are_planned_without_ado() {
        let scene = Scene::generate(SceneKind::Light, 1);
        for frames in 0..8 {
            let mut track = scene.walker(1, 0);
            track.states.truncate(frames);
            with_any(&track, &scene.boxes, frames);
            with_any(&track, &[], frames);
        }
    }

    fn with_any(track: &TargetTrack, boxes: &[OrientedBox], frames: usize) {
        if track.is_empty() {
            return;
        }
        with(track, boxes, |problem, obstacles| {
            assert_eq!(plan_paper(problem, obstacles, &paper_config()).waypoints.len(), frames);
        });
    }
}
