//! The places where publishing can be interrupted, so that tests can interrupt it between every two of them.

use std::io;

/// A step of publishing, named before it happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Step {
    /// Bytes of a blob go to a temporary file.
    WriteBlob,
    /// A finished temporary becomes a blob.
    RenameBlob,
    /// An action record goes to a temporary file.
    WriteAction,
    /// The action record becomes visible.
    RenameAction,
    /// Everything written so far is forced to the disk.
    Sync,
    /// A plan document goes to a temporary file.
    WriteDocument,
    /// The plan document becomes visible.
    RenameDocument,
    /// A done record goes to a temporary file.
    WriteDone,
    /// The done record becomes visible.
    RenameDone,
    /// History and index go to temporary files.
    WriteRun,
    /// History and index become visible.
    RenameRun,
}

/// May refuse a step, as a full or broken disk would.
pub trait FaultPoints: Send + Sync {
    /// Called before every step.
    fn before(&self, step: Step) -> io::Result<()>;
}

/// Nothing is refused.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFaults;

impl FaultPoints for NoFaults {
    fn before(&self, _step: Step) -> io::Result<()> {
        Ok(())
    }
}
