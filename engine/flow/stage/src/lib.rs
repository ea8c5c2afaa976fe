//! The stage contract: what a stage declares, what it is given, what it makes, and what a run reports.
//!
//! * [`StageKind`]: one entry of the registry; turns a stage's checked parameters into stages.
//! * [`Stage`]: declares its [`StageProperties`] as data, then runs on one item at a time.
//! * [`Inputs`], [`OutputSink`], [`TaskContext`]: everything a stage may touch while it runs.
//! * [`RunEvent`]: everything a run tells its reporters.

mod artifact;
mod event;
mod kind;
mod passing;
mod properties;

pub use artifact::{Artifact, BlobRef, BlobSource, Decoded, InputGroup, Inputs, OutputSink, Produced, SeekWrite};
pub use event::{RunEvent, TaskOutcome};
pub use kind::{ParameterError, Registry, StageKind, StagePart};
pub use passing::PassingFile;
pub use properties::{
    Fan, InputPort, ItemRule, PortSource, ReadSchema, Settle, Source, SourceCheck, StageProperties, Takes,
};

use cosfly_diagnose::Result;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// One step of a recipe, ready to run. New abilities become fields of [`StageProperties`], not methods.
pub trait Stage: Send + Sync {
    /// What this stage is: computed once, read by planning, caching and drawing.
    fn properties(&self) -> &StageProperties;

    /// Makes one item. Pure: the same inputs and context give the same bytes.
    fn run(&self, inputs: &Inputs<'_>, outputs: &mut dyn OutputSink, context: &TaskContext) -> Result<Produced>;
}

/// What a running task knows beside its inputs.
#[derive(Clone, Debug)]
pub struct TaskContext {
    /// Name of the stage in the recipe.
    pub stage: String,
    /// Item id.
    pub item: String,
    /// 32 bytes derived from (recipe seed, stage, item).
    pub seed: [u8; 32],
    /// The source files this stage declared, in the order of [`StageProperties::sources`], as bytes on disk.
    pub sources: Vec<PathBuf>,
    /// Set when the run is being stopped; long stages look at it between frames.
    pub cancelled: Arc<AtomicBool>,
}

impl TaskContext {
    /// An error when the run is being stopped, for `?` between pieces of long work.
    pub fn check_cancelled(&self) -> Result<()> {
        if self.cancelled.load(Ordering::Relaxed) {
            return Err(cosfly_diagnose::Diagnostic::new(
                "cancelled",
                cosfly_diagnose::Fault::Machine,
                format!("`{}/{}` was stopped", self.stage, self.item),
            ));
        }
        Ok(())
    }
}
