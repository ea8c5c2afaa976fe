//! The town of a task, decoded once for all tasks that share it.

use crate::artifacts::TOWN;
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_flight::World;
use cosfly_stage::{Artifact, Inputs};
use std::sync::Arc;

/// Links the town to the output of a task.
pub fn link_town(inputs: &Inputs<'_>, outputs: &mut dyn OutputSink) -> Result<()> {
    outputs.link(TOWN.blob, inputs.one("town")?.blobs[TOWN.blob])
}

/// Refuses an input that was made in another town than the one at port `town`: a flight planned in one town and
/// filmed in another would be certified against buildings that are not in the picture.
pub fn check_same_town(inputs: &Inputs<'_>, port: &str) -> Result<()> {
    let town = inputs.one("town")?;
    for artifact in inputs.all(port) {
        if artifact.blobs.get(TOWN.blob) != town.blobs.get(TOWN.blob) {
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
    inputs.decoded(artifact, TOWN.blob, |bytes| TOWN.decode(bytes).map(World::new))
}
