//! Options of a run.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Options of a run.
#[derive(Clone, Debug, Default)]
pub struct RunOptions {
    /// Number of threads; no result depends on it.
    pub jobs: usize,
    /// Number of the stage that is asked for; without one, all stages that no other reads.
    pub asked: Option<usize>,
    /// Set from anywhere to stop: running tasks finish or give up, finished ones are published.
    pub cancelled: Arc<AtomicBool>,
}
