//! Steps of publishing, so that tests can interrupt it between every two of them.

use std::io;

/// A step of publishing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Step {
    /// A blob is written to a temporary file.
    WriteBlob,
    /// A finished temporary becomes a blob.
    RenameBlob,
    /// An action record is written to a temporary file.
    WriteAction,
    /// The action record becomes visible.
    RenameAction,
    /// Everything written so far is made durable.
    Sync,
    /// A plan document is written to a temporary file.
    WriteDocument,
    /// The plan document becomes visible.
    RenameDocument,
    /// A done record is written to a temporary file.
    WriteDone,
    /// The done record becomes visible.
    RenameDone,
    /// History or index is written to a temporary file.
    WriteRun,
    /// History or index becomes visible.
    RenameRun,
}

/// Source of faults: it may refuse a step, as a full or broken disk would.
pub trait FaultPoints: Send + Sync {
    /// Called before every step.
    fn before(&self, step: Step) -> io::Result<()>;
}

/// No faults.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NoFaults;

impl FaultPoints for NoFaults {
    fn before(&self, _step: Step) -> io::Result<()> {
        Ok(())
    }
}
