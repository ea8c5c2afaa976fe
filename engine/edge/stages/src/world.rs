//! A town decoded once for all tasks that share it, with its obstacle BVH and its ground.

use crate::codec;
use crate::ports::TOWN;
use cosfly_diagnose::Result;
use cosfly_geometry::BoxBvh;
use cosfly_maps::{GroundIndex, Town};
use cosfly_stage::Inputs;
use std::sync::Arc;

/// The town at port `town`, ready for queries.
pub struct World {
    /// The model.
    pub town: Town,
    /// All unsimplified boxes; primitive index = obstacle index.
    pub exact: BoxBvh,
    /// Height of the ground.
    pub ground: GroundIndex,
}

/// The town at port `town` of a task.
pub fn world(inputs: &Inputs<'_>) -> Result<Arc<World>> {
    inputs.decoded(inputs.one("town")?, "town", |bytes| {
        let town: Town = codec::decode(TOWN, bytes)?;
        let exact = BoxBvh::build(town.obstacles.iter().map(|obstacle| obstacle.shape).collect());
        let ground = GroundIndex::new(&town);
        Ok(World { town, exact, ground })
    })
}
