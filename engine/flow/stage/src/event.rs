//! Events of a run, a closed list. Reporters are the only code that prints.

use crate::{ItemId, Produced, StageName};
use cosfly_diagnose::Diagnostic;
use std::time::Duration;

/// Work that a finished task needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// None: the item was finished before, or by another process meanwhile.
    Cached,
    /// The item was computed.
    Ran,
    /// None: the inputs are equal to those of an earlier run.
    Reused,
}

/// An event of a run.
#[derive(Clone, Debug)]
pub enum RunEvent {
    /// The plan is known.
    Planned {
        /// Stage, items, cached items, in the order of the recipe.
        stages: Vec<(StageName, u64, u64)>,
    },
    /// A task is finished and its output is on the disk.
    Finished {
        /// Finished item.
        id: ItemId,
        /// Work that the task needed.
        work: Work,
        /// Wall time.
        took: Duration,
        /// Notes, warnings and rejection.
        produced: Produced,
    },
    /// A task failed; items that depend on it do not run, all others do.
    Failed {
        /// Item of the failed task.
        id: ItemId,
        /// Reason.
        diagnostic: Box<Diagnostic>,
    },
    /// The run is stopping; running tasks are ending.
    Stopping,
}
