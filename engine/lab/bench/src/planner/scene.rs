//! Scenes with paths: seeded scenes, or any town with its walkers.

use cosfly_domain::OrientedBox;
use cosfly_frames::TargetTrack;
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_scenes::{Scene, SceneKind};

/// Function of the height of the ground at (x, y), metres.
pub type GroundHeight = Box<dyn Fn(f64, f64) -> f64 + Send + Sync>;

/// A map and the targets that walk in it.
pub struct Ground {
    /// Name in tables.
    pub name: String,
    /// Unsimplified boxes, for evaluation.
    pub exact: Box<dyn SpatialQuery>,
    /// Number of unsimplified boxes.
    pub exact_boxes: usize,
    /// Boxes for planning.
    pub planning_boxes: Vec<OrientedBox>,
    /// Height of the ground.
    pub height: GroundHeight,
    /// Tracks of the targets.
    pub tracks: Vec<TargetTrack>,
}

impl Ground {
    /// First `paths` walkers of a seeded scene. `fine` is planned on its coarse twin and evaluated on all its boxes.
    pub fn scene(kind: SceneKind, seed: u64, paths: usize) -> Self {
        Self::scene_and_boxes(kind, seed, paths).0
    }

    /// [`Self::scene`] and its unsimplified boxes.
    pub fn scene_and_boxes(kind: SceneKind, seed: u64, paths: usize) -> (Self, Vec<OrientedBox>) {
        let scene = Scene::generate(kind, seed);
        let coarse = if kind == SceneKind::Fine { SceneKind::Leafy } else { kind };
        let planning_boxes = Scene::generate(coarse, seed).boxes;
        let tracks = (0..paths as u64).map(|index| scene.walker(seed, index)).collect();
        let ground = Self {
            name: kind.name().to_owned(),
            exact_boxes: scene.boxes.len(),
            exact: Box::new(BoxBvh::build(scene.boxes.clone())),
            planning_boxes,
            height: Box::new(|_, _| 0.0),
            tracks,
        };
        (ground, scene.boxes)
    }
}
