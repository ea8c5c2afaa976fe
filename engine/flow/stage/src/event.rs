//! Everything a run tells its reporters: one closed list. Reporters are the only code that prints.

use crate::{ItemId, Produced, StageName};
use cosfly_diagnose::Diagnostic;
use std::time::Duration;

/// Work that a finished task took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// None: it was finished before, or by another process meanwhile.
    Cached,
    /// It was computed.
    Ran,
    /// None: its inputs turned out equal to those of an earlier run.
    Reused,
}

/// Something that happened in a run.
#[derive(Clone, Debug)]
pub enum RunEvent {
    /// The plan is known.
    Planned {
        /// Stage, items, cached items, in the order of the recipe.
        stages: Vec<(StageName, u64, u64)>,
    },
    /// A task is finished and its output is on the disk.
    Finished {
        /// Item that it made.
        id: ItemId,
        /// Work that it took.
        work: Work,
        /// Wall time.
        took: Duration,
        /// Notes, warnings and rejection.
        produced: Produced,
    },
    /// A task failed; what depends on it will not run, everything else will.
    Failed {
        /// Item that it should have made.
        id: ItemId,
        /// Reason.
        diagnostic: Box<Diagnostic>,
    },
    /// The run was asked to stop; running tasks are ending.
    Stopping,
}
