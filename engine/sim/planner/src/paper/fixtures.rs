//! Tracks and boxes for the tests of the pipeline's steps.

use super::counts::PaperCounts;
use super::start::initial_path;
use crate::config::muco::MucoConfig;
use crate::config::paper::PaperConfig;
use crate::config::view::ViewConfig;
use crate::problem::Problem;
use crate::terms::built_in_terms;
use crate::walk::Walk;
use crate::weights::Preset;
use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec3, TargetState, TargetTrack};
use cosfly_scenes::{Scene, SceneKind};
use cosfly_surroundings::Surroundings;
use cosfly_surroundings::ground::GroundGrid;
use cosfly_surroundings::local::LocalObstacles;

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

/// Planning boxes around a track, under the paper's weights.
pub fn with(track: &TargetTrack, boxes: &[OrientedBox], check: impl FnOnce(&Problem<'_>, &mut LocalObstacles<'_>)) {
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
