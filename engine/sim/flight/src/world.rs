//! A town with its obstacle BVH and its ground, ready for queries.

use cosfly_domain::Town;
use cosfly_geometry::BoxBvh;
use cosfly_town::GroundIndex;

/// A town, ready for queries.
pub struct World {
    /// Model of the town.
    pub town: Town,
    /// All unsimplified boxes; primitive index = obstacle index.
    pub exact: BoxBvh,
    /// Height of the ground.
    pub ground: GroundIndex,
}

impl World {
    /// Prepares a town for queries.
    pub fn new(town: Town) -> Self {
        let exact = BoxBvh::build(town.obstacles.iter().map(|obstacle| obstacle.shape).collect());
        let ground = GroundIndex::new(&town);
        Self { town, exact, ground }
    }
}
