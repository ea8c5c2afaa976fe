//! Everything a run tells its reporters: one closed list. Reporters are the only code that prints.

use crate::Produced;
use cosfly_diagnose::Diagnostic;
use std::time::Duration;

/// How a task ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TaskOutcome {
    /// It ran and its output was published.
    Ran,
    /// Its inputs turned out equal to those of an earlier run: nothing was computed.
    Reused,
}

/// Something that happened in a run.
#[derive(Clone, Debug)]
pub enum RunEvent {
    /// The plan is known: per stage, in order, how many items there are and how many are cached.
    Planned {
        /// (stage, items, cached items).
        stages: Vec<(String, u64, u64)>,
    },
    /// A task began.
    Started {
        /// Stage name.
        stage: String,
        /// Item id.
        item: String,
    },
    /// A task ended well.
    Finished {
        /// Stage name.
        stage: String,
        /// Item id.
        item: String,
        /// Whether it computed anything.
        outcome: TaskOutcome,
        /// Wall time it took.
        took: Duration,
        /// Its notes, warnings and rejection.
        produced: Produced,
    },
    /// A task failed; what depends on it will not run, everything else will.
    Failed {
        /// Stage name.
        stage: String,
        /// Item id.
        item: String,
        /// Why.
        diagnostic: Box<Diagnostic>,
    },
    /// The run was asked to stop and is letting go.
    Stopping,
}
