//! Options of a run.

use cosfly_diagnose::Diagnostic;
use cosfly_fingerprint::Digest;
use std::collections::BTreeMap;
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
    /// Tasks, by their plan digests, that failed on other machines: they are not tried again here.
    pub failed_elsewhere: BTreeMap<Digest, Box<Diagnostic>>,
}
