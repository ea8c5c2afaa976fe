//! A stage, its context, and the statements that it makes about its items.

use crate::{Inputs, ItemId, StageProperties};
use cosfly_blobs::OutputSink;
use cosfly_diagnose::{Diagnostic, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// One step of a recipe, ready to run. New abilities become fields of [`StageProperties`], not methods.
pub trait Stage: Send + Sync {
    /// Declaration of the stage: computed once, read by planning, caching and drawing.
    fn properties(&self) -> &StageProperties;

    /// Makes one item. Pure: the same inputs and context give the same bytes.
    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced>;
}

/// Context of a running task, apart from its inputs.
#[derive(Clone, Debug)]
pub struct TaskContext {
    /// Item to be made.
    pub id: ItemId,
    /// Seed of the item: 32 bytes derived from the recipe's seed, the stage and the item.
    pub seed: [u8; 32],
    /// Source files that the stage declared, in the order of [`StageProperties::sources`].
    pub sources: Vec<PathBuf>,
    /// Set when the run is stopping; long stages check it between frames.
    pub cancelled: Arc<AtomicBool>,
}

/// Facts, warnings and rejection of an item. Stored beside the blobs and shown again when the item is cached.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Produced {
    /// Short facts for the summary, such as `boxes` = `65638 -> 2011`.
    pub notes: BTreeMap<String, String>,
    /// Warnings for users; never about lost data.
    pub warnings: Vec<String>,
    /// Reason why the item holds no usable result; published. An item whose input was rejected is rejected as well; the
    /// runner knows from the graph where a rejection began.
    pub rejected: Option<String>,
}

impl TaskContext {
    /// Fails when the run is stopping, for `?` between pieces of long work.
    ///
    /// # Errors
    /// [`cosfly_diagnose::Fault::Stopped`].
    pub fn check_cancelled(&self) -> Result<()> {
        if self.cancelled.load(Ordering::Relaxed) { Err(Diagnostic::stopped(&self.id)) } else { Ok(()) }
    }
}

impl Produced {
    /// Item without a usable result.
    pub fn rejected(reason: impl Into<String>) -> Self {
        Self { rejected: Some(reason.into()), ..Self::default() }
    }
}
