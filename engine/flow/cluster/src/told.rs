//! The part of a run that was reported: every task once, from the records of the store.

use cosfly_diagnose::Diagnostic;
use cosfly_fingerprint::Digest;
use cosfly_runner::Plan;
use cosfly_stage::{Produced, RunEvent, Work};
use cosfly_store::Store;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

/// Reported ends of tasks.
pub(crate) struct Told<'a> {
    pub(crate) store: &'a Store,
    pub(crate) report: &'a (dyn Fn(RunEvent) + Sync),
    finished: BTreeSet<Digest>,
    /// Failures by plan digest.
    pub(crate) failed: BTreeMap<Digest, Box<Diagnostic>>,
    /// Two results of one action, of tasks that are finished with the earlier one.
    #[expect(clippy::vec_box, reason = "diagnostics are boxed wherever they go")]
    pub(crate) divergences: Vec<Box<Diagnostic>>,
    /// Ends without a result, by plan digest.
    lost: BTreeMap<Digest, u32>,
    /// Stages with such ends.
    pub(crate) lossy: BTreeSet<usize>,
}

/// Ends of a task without a result after which it counts as failed.
const MOST_LOSSES: u32 = 3;

impl<'a> Told<'a> {
    pub(crate) fn new(store: &'a Store, report: &'a (dyn Fn(RunEvent) + Sync)) -> Self {
        Self {
            store,
            report,
            finished: BTreeSet::new(),
            failed: BTreeMap::new(),
            divergences: Vec::new(),
            lost: BTreeMap::new(),
            lossy: BTreeSet::new(),
        }
    }

    /// Number of reported tasks, and of ends without a result: it grows as long as something happens.
    pub(crate) fn progress(&self) -> usize {
        self.finished.len() + self.failed.len() + self.lost.values().sum::<u32>() as usize
    }

    /// Reports the plan where it is the first one, and otherwise what was finished since.
    pub(crate) fn planned(&mut self, plan: &Plan<'_>, is_first: bool) {
        if is_first {
            let stages = plan.stages.iter().map(|stage| (stage.name.clone(), stage.items(), stage.cached()));
            (self.report)(RunEvent::Planned { stages: stages.collect() });
        }
        for (index, stage) in plan.stages.iter().enumerate() {
            for (item, digest) in stage.plans.iter().enumerate().filter(|(item, _)| stage.finished[*item].is_some()) {
                if is_first {
                    self.finished.insert(*digest);
                } else {
                    self.finished(plan, index, item);
                }
            }
        }
    }

    /// Reports a task where the store has its result; false where it has none.
    pub(crate) fn finished(&mut self, plan: &Plan<'_>, stage: usize, item: usize) -> bool {
        let digest = plan.stages[stage].plans[item];
        if self.finished.contains(&digest) {
            return true;
        }
        let known = plan.stages[stage].finished[item].clone();
        let Some(finished) = known.or_else(|| self.store.finished(&digest)) else { return false };
        self.finished.insert(digest);
        let produced = Produced::clone(&finished.record.produced);
        let id = plan.recipe.id(stage, item);
        (self.report)(RunEvent::Finished { id, work: Work::Ran, took: Duration::ZERO, produced });
        true
    }

    /// Notes the end of a task whose command failed; `words` are the engine's on it.
    pub(crate) fn ended_badly(&mut self, plan: &Plan<'_>, stage: usize, item: usize, words: &str) {
        let digest = plan.stages[stage].plans[item];
        let failure = self.store.failure(&digest);
        if self.finished(plan, stage, item) {
            if let Some(divergence) = failure.filter(|failure| failure.code == "nondeterministic-stage") {
                self.store.forget_failure(&digest);
                self.divergences.push(divergence);
            }
            return;
        }
        let id = plan.recipe.id(stage, item);
        let diagnostic = failure.or_else(|| {
            self.lossy.insert(stage);
            let losses = self.lost.entry(digest).or_insert(0);
            *losses += 1;
            (*losses >= MOST_LOSSES).then(|| lost(&id.to_string(), words))
        });
        if let Some(diagnostic) = diagnostic
            && self.failed.insert(digest, diagnostic.clone()).is_none()
        {
            (self.report)(RunEvent::Failed { id, diagnostic });
        }
    }
}

fn lost(id: &str, words: &str) -> Box<Diagnostic> {
    use cosfly_diagnose::Fault;
    let message = format!("`{id}` ended {MOST_LOSSES} times without a result on another machine");
    Diagnostic::new("cluster-task-lost", Fault::Machine, message)
        .because(words)
        .hint("ask for more memory or time with `--request`, and check that every worker can start cosfly and reach the store")
        .hint("exit code 2 of a command means another version of cosfly on the worker")
}
