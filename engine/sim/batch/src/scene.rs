//! A town prepared for small pictures, once, for all cameras.

use crate::boxes::Boxes;
use crate::buried::seen_from_above;
use crate::ground::Ground;
use cosfly_frames::Seed;
use cosfly_maps::{GroundIndex, Town};
use cosfly_render::Scene;

/// Everything that the cameras of one town share. Immutable: any number of threads may draw from it.
pub struct BatchScene {
    pub(crate) boxes: Boxes,
    pub(crate) ground: Ground,
}

impl BatchScene {
    /// Prepares a town; `seed` draws its looks, as for [`Scene::new`].
    pub fn new(town: &Town, seed: Seed) -> Self {
        Self::of(town, &Scene::new(town, seed))
    }

    /// Prepares a town from its scene in the large renderer: the same faces.
    pub fn of(town: &Town, scene: &Scene) -> Self {
        let faces = scene.faces();
        // Six faces of each box come first, then the ground's.
        let boxes = faces.partition_point(|face| face.outward_in_world.is_some());
        let index = GroundIndex::new(town);
        let ground = seen_from_above(&faces[boxes..], &index);
        Self { boxes: Boxes::of(&faces[..boxes]), ground: Ground::of(ground.iter().collect()) }
    }

    /// Memory that the scene holds, bytes.
    pub fn bytes(&self) -> usize {
        self.boxes.bytes() + self.ground.bytes()
    }
}
