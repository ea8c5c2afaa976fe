//! The paper's pipeline from start to final check.

use super::config::PaperConfig;
use super::descent::descend;
use super::differences::{Threads, context};
use super::near_boxes::NearBoxes;
use super::postprocess::postprocess;
use super::start::initial_path;
use crate::config::MucoConfig;
use crate::gradient::total_cost;
use crate::obstacles::{Surroundings, local::LocalObstacles};
use crate::problem::Problem;
use cosfly_frames::DVec3;

/// Surroundings that may get ready for queries near a set of waypoints; brute force and trees have nothing to do.
pub trait FocusedSurroundings {
    /// The surroundings to be asked.
    fn answers(&self) -> &(dyn Surroundings + Sync);

    /// Says that the next queries will be near these waypoints, one per frame (world frame, metres).
    fn focus_on(&mut self, waypoints: &[DVec3]) {
        let _ = waypoints;
    }
}

impl FocusedSurroundings for LocalObstacles<'_> {
    fn answers(&self) -> &(dyn Surroundings + Sync) {
        self
    }

    fn focus_on(&mut self, waypoints: &[DVec3]) {
        LocalObstacles::focus_on(self, waypoints);
    }
}

/// Where the pipeline's work went, in counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PaperCounts {
    /// Searched viewpoints.
    pub keyframes: usize,
    /// Candidates whose rays were cast.
    pub viewpoints_evaluated: u64,
    /// Waypoints moved by dynamic following.
    pub followed: usize,
    /// Hidden runs of the start that were led aside.
    pub bridged_runs: usize,
    /// Gradients computed.
    pub gradients: u32,
    /// Steps that were taken back.
    pub steps_taken_back: u32,
    /// Step 1: hidden runs with a new azimuth.
    pub straightened_runs: usize,
    /// Step 2: detours replaced by their chords.
    pub detours_removed: usize,
    /// Step 3: waypoints averaged.
    pub oscillations_averaged: usize,
    /// Steps 4 and 7: corrections of waypoints.
    pub projections: usize,
    /// Step 5: waypoints held back.
    pub spikes_spread: usize,
    /// Step 6: waypoints whose altitude could not be smoothed.
    pub altitudes_kept: usize,
}

/// What the paper's pipeline made of a track. Neither safe nor flyable until it is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct PaperFlight {
    /// One waypoint per frame, world frame, metres.
    pub waypoints: Vec<DVec3>,
    /// Total cost at the start, after each iteration of the descent, and after post-processing (which may raise it).
    pub convergence: Vec<f64>,
    /// Iterations of the descent.
    pub iterations: u32,
    /// Where the work went.
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
pub(super) mod tests {
    use super::*;
    use crate::config::ViewConfig;
    use crate::obstacles::ground::GroundGrid;
    use crate::scenes::{Scene, SceneKind};
    use crate::terms::built_in_terms;
    use crate::walk::Walk;
    use crate::weights::Preset;
    use cosfly_frames::{TargetState, TargetTrack};
    use cosfly_geometry::OrientedBox;

    /// A plain without anything.
    pub struct Nothing;

    impl Surroundings for Nothing {
        fn visibility(&self, _: usize, _: DVec3) -> f64 {
            1.0
        }
        fn nearest(&self, _: usize, _: DVec3, _: f64) -> Option<(f64, DVec3)> {
            None
        }
        fn ground_z_m(&self, _: f64, _: f64) -> f64 {
            0.0
        }
    }

    pub fn paper_config() -> MucoConfig {
        MucoConfig { preset: Preset::Paper, ..MucoConfig::default() }
    }

    fn with(track: &TargetTrack, boxes: &[OrientedBox], check: impl FnOnce(&Problem<'_>, &mut LocalObstacles<'_>)) {
        let (walk, view) = (Walk::of(track), ViewConfig::default());
        let terms = built_in_terms(&paper_config().resolved_weights());
        let problem = Problem { track, view: &view, walk: &walk, terms: &terms, built_in: terms.len(), first_frame: 0 };
        let ground = GroundGrid::sample(track, &|_, _| 0.0, 55.0);
        let mut obstacles = LocalObstacles::filter(track, boxes, &ground, 45.0, view.safety_influence_m);
        check(&problem, &mut obstacles);
    }

    /// A walk through a leafy street, and the paper's start above it.
    pub fn with_street(check: impl FnOnce(&Problem<'_>, &mut LocalObstacles<'_>, &MucoConfig, &mut Vec<DVec3>)) {
        let scene = Scene::generate(SceneKind::Leafy, 2);
        let mut track = scene.walker(2, 1);
        track.states.truncate(90);
        with(&track, &scene.boxes, |problem, obstacles| {
            let (config, paper) = (paper_config(), PaperConfig::default());
            let mut path = initial_path(problem, obstacles, &config, &paper, &mut PaperCounts::default());
            check(problem, obstacles, &config, &mut path);
        });
    }

    /// A walk along a wall (2 m thick in the plane y = 0, 30 m high, 60 m long), watched from the other side of it.
    pub fn with_wall(check: impl FnOnce(&Problem<'_>, &mut LocalObstacles<'_>, &mut Vec<DVec3>)) {
        let state = |i: usize| TargetState {
            feet_in_world: DVec3::new(0.7 * i as f64, -4.0, 0.0),
            heading_rad: 0.0,
            speed_mps: 1.4,
        };
        let states = (0..60).map(state).collect();
        let track = TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states };
        let wall = OrientedBox::from_corners(DVec3::new(-10.0, -1.0, 0.0), DVec3::new(50.0, 1.0, 30.0));
        with(&track, &[wall], |problem, obstacles| {
            let mut path = track.states.iter().map(|s| s.feet_in_world + DVec3::new(0.0, 16.0, 22.0)).collect();
            check(problem, obstacles, &mut path);
        });
    }

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
