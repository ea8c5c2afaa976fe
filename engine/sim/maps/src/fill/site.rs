//! [`FillSite`]: a town while it is being filled.

use cosfly_domain::{Obstacle, ObstacleKind, OrientedBox, SemanticLabel, Town};
use cosfly_frames::DVec3;
use cosfly_town::ground::GroundIndex;

/// The town while it is being filled.
pub struct FillSite<'a> {
    pub(super) town: &'a mut Town,
    terrain: GroundIndex,
    last_object_id: u32,
}

impl<'a> FillSite<'a> {
    /// The site of a town.
    pub fn new(town: &'a mut Town) -> Self {
        let terrain = GroundIndex::of_surfaces(&town.surfaces, |mesh| mesh.label == SemanticLabel::Terrain);
        let last_object_id = town.obstacles.iter().map(|one| one.object_id).max().unwrap_or(0);
        Self { town, terrain, last_object_id }
    }

    /// Identifier of a new thing.
    pub fn next_object_id(&mut self) -> u32 {
        self.last_object_id = self.last_object_id.saturating_add(1);
        self.last_object_id
    }

    /// Height of the open ground at a place; of the pavement beside it where the town has no terrain there.
    pub fn ground_m(&self, at: DVec3) -> f64 {
        self.terrain.ground_height_m(at.x, at.y).unwrap_or(at.z)
    }

    /// Adds an invented box of the thing `object_id`.
    pub fn add(&mut self, kind: ObstacleKind, object_id: u32, shape: OrientedBox) {
        self.town.obstacles.push(Obstacle { shape, kind, object_id, synthetic: true });
    }
}
