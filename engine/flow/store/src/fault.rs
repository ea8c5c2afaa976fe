//! Steps of publishing, at which tests can inject faults.

use std::io;

/// A step of publishing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PublishStep {
    /// Writes a blob to a temporary file.
    WriteBlob,
    /// Renames a finished temporary file to a blob.
    RenameBlob,
    /// Writes an action record to a temporary file.
    WriteAction,
    /// Makes the action record visible.
    RenameAction,
    /// Makes everything written so far durable.
    Sync,
    /// Writes a plan document to a temporary file.
    WriteDocument,
    /// Makes the plan document visible.
    RenameDocument,
    /// Writes a done record to a temporary file.
    WriteDone,
    /// Makes the done record visible.
    RenameDone,
    /// Writes the history or an index to a temporary file.
    WriteRun,
    /// Makes the history or index visible.
    RenameRun,
}

/// Source of faults: it may fail a step, as a full or broken disk would.
pub trait FaultPoints: Send + Sync {
    /// Called before every step; an error fails the step.
    fn before(&self, step: PublishStep) -> io::Result<()>;
}

/// Source without faults.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NoFaults;

impl FaultPoints for NoFaults {
    fn before(&self, _step: PublishStep) -> io::Result<()> {
        Ok(())
    }
}
