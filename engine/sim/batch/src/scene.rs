//! A town prepared for small pictures, once, for all cameras.

use crate::boxes::Boxes;
use crate::buried::seen_from_above;
use crate::ground::Ground;
use cosfly_domain::Town;
use cosfly_frames::Seed;
use cosfly_render::{Scene, SceneScan};
use cosfly_town::GroundIndex;

/// Everything that the cameras of one town share. Immutable: any number of threads may draw from it.
pub struct BatchScene {
    pub(crate) boxes: Boxes,
    pub(crate) ground: Ground,
    /// The scene of the large renderer, which draws colours.
    pub(crate) large: Option<Scene>,
    /// Whether that is a scan, which it draws whole.
    pub(crate) is_scan: bool,
}

impl BatchScene {
    /// Prepares a town; `seed` draws its looks, as for [`Scene::new`].
    pub fn new(town: &Town, seed: Seed) -> Self {
        Self::without_colours(town, &GroundIndex::new(town)).with_colours(town, seed)
    }

    /// Scene with all that colours need.
    pub fn with_colours(self, town: &Town, seed: Seed) -> Self {
        Self { large: Some(Scene::of_boxes(town, seed)), ..self }
    }

    /// Scene of a scan: its pictures are those of the large renderer, in all channels.
    pub fn with_scan(self, town: &Town, seed: Seed, scan: SceneScan) -> Self {
        Self { large: Some(Scene::new(town, seed).with_scan(scan)), is_scan: true, ..self }
    }

    /// Prepares a town with the index of its ground for all channels but colours: a small part of the memory.
    pub fn without_colours(town: &Town, index: &GroundIndex) -> Self {
        let mut faces = Scene::faces_of(town);
        // Six faces of each box come first, then the ground's.
        let boxes = faces.partition_point(|face| face.outward_in_world.is_some());
        // Ground has no instances: the field holds the number of each face.
        for (number, face) in (0u32..).zip(&mut faces).skip(boxes) {
            face.instance = number;
        }
        let ground = seen_from_above(&faces[boxes..], index);
        let ground = Ground::of(ground.iter().collect());
        Self { boxes: Boxes::of(&faces[..boxes]), ground, large: None, is_scan: false }
    }

    /// Memory that the scene holds without what colours need, bytes.
    pub fn bytes(&self) -> usize {
        self.boxes.bytes() + self.ground.bytes()
    }
}
