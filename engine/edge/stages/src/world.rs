//! A town decoded once for all tasks that share it, with its obstacle BVH and its ground.

use crate::codec;
use crate::ports::TOWN;
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_domain::Town;
use cosfly_geometry::BoxBvh;
use cosfly_stage::{Artifact, Inputs};
use cosfly_town::GroundIndex;
use std::sync::Arc;

/// The town at port `town`, ready for queries.
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

/// Name of the town's own blob, which every artifact that was made in the town carries as a link.
pub const TOWN_BLOB: &str = "town";

/// Links the town to the output of a task.
pub fn link_town(inputs: &Inputs<'_>, outputs: &mut dyn OutputSink) -> Result<()> {
    outputs.link(TOWN_BLOB, inputs.one("town")?.blobs[TOWN_BLOB])
}

/// Refuses an input that was made in another town than the one at port `town`: a flight planned in one town and
/// filmed in another would be certified against buildings that are not in the picture.
pub fn check_same_town(inputs: &Inputs<'_>, port: &str) -> Result<()> {
    let town = inputs.one("town")?;
    for artifact in inputs.all(port) {
        if artifact.blobs.get(TOWN_BLOB) != town.blobs.get(TOWN_BLOB) {
            return Err(Diagnostic::new(
                "towns-differ",
                Fault::Recipe,
                format!(
                    "`{}` was made in another town than `{}`, which is connected to `inputs.town`",
                    artifact.id, town.id.stage
                ),
            )
            .hint(format!("connect `inputs.town` and `inputs.{port}` so that both begin at the same `map` stage")));
        }
    }
    Ok(())
}

/// Town at port `town` of a task.
pub fn world(inputs: &Inputs<'_>) -> Result<Arc<World>> {
    world_of(inputs, inputs.one("town")?)
}

/// Town that an artifact was made in.
pub fn world_of(inputs: &Inputs<'_>, artifact: &Artifact) -> Result<Arc<World>> {
    inputs.decoded(artifact, TOWN_BLOB, |bytes| codec::decode(TOWN, bytes).map(World::new))
}
