//! Does what a plan leaves to do: workers take ready tasks, one thread publishes what they finish.

use crate::leaf::{Ended, Settlement, Task, execute};
use crate::plan::{Plan, plan};
use crate::publisher::{Publication, Publisher};
use crate::schedule::{Schedule, State, TaskId};
use crate::summary::{Failure, RunOutcome, RunSummary, StageSummary};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_recipe::Recipe;
use cosfly_stage::{Artifact, InputGroup, RunEvent, TaskOutcome};
use cosfly_store::{Finished, Store};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How long to leave a task alone that another process is at.
const LOOK_AGAIN: Duration = Duration::from_millis(20);
/// How often a waiting worker looks whether the run is to stop.
const LOOK_UP: Duration = Duration::from_millis(50);
/// How often a task may find its inputs gone before the run gives it up.
const MOST_HEALINGS: u32 = 3;
/// A stage's own parallel work may nest other tasks on a thread's stack, at most one per thread.
const STACK_BYTES: usize = 32 << 20;

/// How to run.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Threads; results do not depend on it.
    pub jobs: usize,
    /// Set from anywhere to stop: running tasks finish or give up, finished ones are published.
    pub cancelled: Arc<AtomicBool>,
}

/// Plans and runs a recipe.
///
/// # Errors
/// Only what keeps a run from starting; everything else is in the summary.
pub fn run(
    recipe: &Recipe,
    store: &Store,
    options: &RunOptions,
    report: &(dyn Fn(RunEvent) + Sync),
) -> Result<RunSummary> {
    run_plan(plan(recipe, store)?, store, options, report)
}

/// Does what `plan` leaves to do.
///
/// # Errors
/// As [`run`].
pub fn run_plan(
    mut plan: Plan<'_>,
    store: &Store,
    options: &RunOptions,
    report: &(dyn Fn(RunEvent) + Sync),
) -> Result<RunSummary> {
    let stages = plan.stages.iter().map(|stage| (stage.name.clone(), stage.items(), stage.cached()));
    report(RunEvent::Planned { stages: stages.collect() });
    let ended = if plan.to_run() == 0 { None } else { Some(do_the_rest(&mut plan, store, options, report)?) };
    let mut summary = summarise(plan, store, ended);
    if summary.outcome != RunOutcome::Cancelled {
        let whole = summary.stages.iter().all(|stage| stage.failed + stage.skipped + stage.unfinished == 0);
        summary.outcome =
            if whole && summary.diagnostics.is_empty() { RunOutcome::Complete } else { RunOutcome::Failed };
    }
    Ok(summary)
}

/// How a finished task came to be finished.
#[derive(Clone, Copy, PartialEq, Eq)]
enum How {
    Cached,
    Ran,
    Reused,
}

/// What workers and the publisher share.
struct Shared {
    schedule: Schedule,
    /// By stage and item: what can be read.
    finished: Vec<Vec<Option<Finished>>>,
    /// By task: set once its done record is durable.
    how: Vec<Option<How>>,
    /// Tasks that another process was at.
    contended: Vec<TaskId>,
    /// Tasks that were reported as started.
    retried: BTreeSet<TaskId>,
    healings: BTreeMap<TaskId, u32>,
    failures: Vec<Failure>,
    #[expect(clippy::vec_box, reason = "diagnostics are boxed wherever they go")]
    diagnostics: Vec<Box<Diagnostic>>,
    /// The machine refuses to go on.
    broken: bool,
    stopping: bool,
}

struct Runner<'a> {
    plan: &'a Plan<'a>,
    store: &'a Store,
    options: &'a RunOptions,
    report: &'a (dyn Fn(RunEvent) + Sync),
    pool: rayon::ThreadPool,
    publisher: Publisher,
    shared: Mutex<Shared>,
    changed: Condvar,
}

fn do_the_rest(
    plan: &mut Plan<'_>,
    store: &Store,
    options: &RunOptions,
    report: &(dyn Fn(RunEvent) + Sync),
) -> Result<Shared> {
    let jobs = options.jobs.clamp(1, 1024);
    for stage in (0..plan.stages.len()).filter(|stage| plan.stages[*stage].to_run() > 0) {
        plan.publish_stage(store, stage)?;
    }
    let finished: Vec<_> = plan.stages.iter_mut().map(|stage| std::mem::take(&mut stage.finished)).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs).stack_size(STACK_BYTES).build();
    let pool = pool.map_err(|error| {
        Diagnostic::new("machine-threads", Fault::Machine, format!("could not start {jobs} threads")).because(error)
    })?;
    let runner = Runner {
        shared: Mutex::new(Shared::new(plan.recipe, finished)),
        plan,
        store,
        options,
        report,
        pool,
        publisher: Publisher::default(),
        changed: Condvar::new(),
    };
    let sound = std::thread::scope(|scope| {
        let publishing = scope.spawn(|| runner.publish());
        let workers: Vec<_> = (0..jobs).map(|_| scope.spawn(|| runner.work())).collect();
        // All are joined before anything is decided.
        let failed = workers.into_iter().map(|worker| worker.join().is_err()).filter(|failed| *failed).count();
        runner.publisher.close();
        publishing.join().is_ok() && failed == 0
    });
    let mut shared = runner.shared.into_inner().unwrap_or_else(PoisonError::into_inner);
    if !sound {
        shared.diagnostics.push(Diagnostic::new("bug-panic", Fault::Bug, "the engine panicked; please report it"));
    }
    for (stage, finished) in plan.stages.iter_mut().zip(&mut shared.finished) {
        stage.finished = std::mem::take(finished);
    }
    Ok(shared)
}

impl Shared {
    fn new(recipe: &Recipe, finished: Vec<Vec<Option<Finished>>>) -> Self {
        let how = finished.iter().flatten().map(|finished| finished.as_ref().map(|_| How::Cached)).collect();
        Self {
            schedule: Schedule::new(recipe, |stage, item| finished[stage][item].is_some()),
            finished,
            how,
            contended: Vec::new(),
            retried: BTreeSet::new(),
            healings: BTreeMap::new(),
            failures: Vec::new(),
            diagnostics: Vec::new(),
            broken: false,
            stopping: false,
        }
    }

    /// The blobs of a task can be read from now on.
    fn finish(&mut self, task: TaskId, finished: Finished) {
        let (stage, item) = self.schedule.place(task);
        self.finished[stage][item] = Some(finished);
        self.schedule.finish(task);
    }
}

impl Runner<'_> {
    fn lock(&self) -> MutexGuard<'_, Shared> {
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn work(&self) {
        while let Some(task) = self.next_task() {
            self.attempt(task);
            self.changed.notify_all();
        }
        self.changed.notify_all();
    }

    /// The next task to attempt; nothing when the run is over or stops.
    fn next_task(&self) -> Option<TaskId> {
        let mut shared = self.lock();
        loop {
            if self.is_stopping(&mut shared) {
                return None;
            }
            if let Some(task) = shared.schedule.next() {
                return Some(task);
            }
            if !shared.schedule.is_busy() {
                return None;
            }
            let pause = if shared.contended.is_empty() { LOOK_UP } else { LOOK_AGAIN };
            (shared, _) = self.changed.wait_timeout(shared, pause).unwrap_or_else(PoisonError::into_inner);
            for task in std::mem::take(&mut shared.contended) {
                shared.schedule.put_back(task);
            }
        }
    }

    fn is_stopping(&self, shared: &mut Shared) -> bool {
        if self.options.cancelled.load(Ordering::Relaxed) && !std::mem::replace(&mut shared.stopping, true) {
            (self.report)(RunEvent::Stopping);
        }
        shared.stopping || shared.broken
    }

    fn attempt(&self, id: TaskId) {
        let (stage, item) = self.place(id);
        let task = self.task(id);
        if self.lock().retried.insert(id) {
            (self.report)(RunEvent::Started { stage: stage.to_owned(), item: item.to_owned() });
        }
        let started = Instant::now();
        match self.pool.install(|| execute(self.store, &task)) {
            Ok(Ended::AlreadyDone(finished)) => self.found_done(id, finished, started.elapsed()),
            Ok(Ended::Contended) => self.lock().contended.push(id),
            Ok(Ended::InputsLost) => self.heal(id),
            Ok(Ended::Settled(settlement)) => self.settled(id, settlement, started.elapsed()),
            Err(diagnostic) => self.failed(id, diagnostic),
        }
    }

    fn place(&self, id: TaskId) -> (&str, &str) {
        let (stage, item) = self.lock().schedule.place(id);
        let described = &self.plan.recipe.stages[stage];
        (&described.name, &described.items[item])
    }

    /// A task with what it reads.
    fn task(&self, id: TaskId) -> Task<'_> {
        let shared = self.lock();
        let (stage, item) = shared.schedule.place(id);
        let (described, planned) = (&self.plan.recipe.stages[stage], &self.plan.stages[stage]);
        let artifact = |arrival: &cosfly_recipe::Arrival| {
            let record = shared.finished[arrival.stage][arrival.item].as_ref();
            Artifact {
                stage: self.plan.recipe.stages[arrival.stage].name.clone(),
                item: arrival.id.to_string(),
                blobs: record.map(|finished| finished.record.outputs.clone()).unwrap_or_default(),
            }
        };
        let ports = described.connections.iter().map(|connection| {
            let artifacts = connection.arrivals_for(item).iter().map(artifact).collect();
            (connection.port.name.to_owned(), InputGroup { artifacts })
        });
        Task {
            plan: planned.plans[item],
            stage: &*described.stage,
            name: &described.name,
            item: &described.items[item],
            recipe_seed: self.plan.recipe.seed,
            definition: &planned.definition,
            sources: &planned.sources,
            ports: ports.collect(),
            cancelled: Arc::clone(&self.options.cancelled),
        }
    }

    /// Another process finished it while we were running.
    fn found_done(&self, id: TaskId, finished: Finished, took: Duration) {
        let produced = finished.record.produced.clone();
        let (stage, item) = self.place(id);
        let mut shared = self.lock();
        shared.how[id] = Some(How::Cached);
        shared.finish(id, finished);
        drop(shared);
        self.report_finished(stage, item, TaskOutcome::Reused, took, produced);
    }

    fn settled(&self, id: TaskId, settlement: Settlement, took: Duration) {
        let mut shared = self.lock();
        shared.diagnostics.extend(settlement.divergence.clone());
        drop(shared);
        // Queued before what depends on it can start, so that done records appear in dependency order.
        let finished = settlement.finished.clone();
        self.publisher.submit(Publication { task: id, settlement, took });
        self.lock().finish(id, finished);
    }

    fn failed(&self, id: TaskId, diagnostic: Box<Diagnostic>) {
        let (stage, item) = self.place(id);
        let mut shared = self.lock();
        if diagnostic.code == "cancelled" && self.is_stopping(&mut shared) {
            return shared.schedule.abandon(id);
        }
        // The next task would meet the same full disk.
        shared.broken |= diagnostic.code == "disk-full";
        shared.schedule.fail(id);
        if shared.failures.len() < RunSummary::MOST_FAILURES {
            let diagnostic = diagnostic.clone();
            shared.failures.push(Failure { stage: stage.to_owned(), item: item.to_owned(), diagnostic });
        }
        drop(shared);
        (self.report)(RunEvent::Failed { stage: stage.to_owned(), item: item.to_owned(), diagnostic });
    }

    /// Blobs that a task reads are gone: what made them runs again first.
    fn heal(&self, id: TaskId) {
        let mut shared = self.lock();
        let tries = shared.healings.entry(id).or_insert(0);
        *tries += 1;
        if *tries > MOST_HEALINGS {
            drop(shared);
            let message = "what it reads keeps vanishing from the store".to_owned();
            let diagnostic = Diagnostic::new("store-damaged", Fault::Machine, message)
                .hint("check the disk, or choose another folder with `--store`");
            return self.failed(id, diagnostic);
        }
        let (stage, item) = shared.schedule.place(id);
        let connections = &self.plan.recipe.stages[stage].connections;
        let mut lost: Vec<TaskId> = connections
            .iter()
            .flat_map(|connection| connection.arrivals_for(item))
            .filter(|arrival| {
                let finished = shared.finished[arrival.stage][arrival.item].as_ref();
                finished.is_none_or(|finished| !self.store.holds(&finished.record))
            })
            .map(|arrival| shared.schedule.task(arrival.stage, arrival.item))
            .collect();
        lost.sort_unstable();
        lost.dedup();
        if lost.is_empty() {
            shared.contended.push(id);
        } else {
            shared.schedule.wait_again(id, &lost);
        }
    }

    fn publish(&self) {
        let document = |id: TaskId| {
            let (stage, item) = self.lock().schedule.place(id);
            (self.plan.stages[stage].plans[item], self.plan.document(stage, item))
        };
        let durable = |publication: Publication| {
            let outcome = publication.settlement.outcome;
            let how = if outcome == TaskOutcome::Ran { How::Ran } else { How::Reused };
            self.lock().how[publication.task] = Some(how);
            let (stage, item) = self.place(publication.task);
            let produced = publication.settlement.finished.record.produced.clone();
            self.report_finished(stage, item, outcome, publication.took, produced);
        };
        let refused = |diagnostic: Box<Diagnostic>| {
            let mut shared = self.lock();
            if !std::mem::replace(&mut shared.broken, true) {
                shared.diagnostics.push(diagnostic);
            }
        };
        self.publisher.serve(self.store, document, durable, refused);
    }

    fn report_finished(
        &self,
        stage: &str,
        item: &str,
        outcome: TaskOutcome,
        took: Duration,
        produced: cosfly_stage::Produced,
    ) {
        let (stage, item) = (stage.to_owned(), item.to_owned());
        (self.report)(RunEvent::Finished { stage, item, outcome, took, produced });
    }
}

fn summarise(plan: Plan<'_>, store: &Store, ended: Option<Shared>) -> RunSummary {
    let mut stages = Vec::with_capacity(plan.stages.len());
    let mut task = 0;
    for planned in &plan.stages {
        let mut stage = StageSummary { name: planned.name.clone(), total: planned.items(), ..Default::default() };
        for _ in 0..planned.plans.len() {
            let count = match &ended {
                None => &mut stage.cached,
                Some(shared) => match (shared.schedule.state(task), shared.how[task]) {
                    (State::Failed, _) => &mut stage.failed,
                    (State::Skipped, _) => &mut stage.skipped,
                    (_, Some(How::Cached)) => &mut stage.cached,
                    (_, Some(How::Ran)) => &mut stage.ran,
                    (_, Some(How::Reused)) => &mut stage.reused,
                    (_, None) => &mut stage.unfinished,
                },
            };
            *count += 1;
            task += 1;
        }
        stages.push(stage);
    }
    let (mut failures, mut diagnostics, stopping, worked) = match ended {
        None => (Vec::new(), Vec::new(), false, false),
        Some(shared) => (shared.failures, shared.diagnostics, shared.stopping, true),
    };
    if let Err(diagnostic) = remember(&plan, store, worked) {
        diagnostics.push(diagnostic);
    }
    failures.sort_by_key(|failure| plan.recipe.position(&failure.stage));
    let outcome = if stopping { RunOutcome::Cancelled } else { RunOutcome::Complete };
    let mut summary = RunSummary::new(plan, outcome, stages);
    (summary.failures, summary.diagnostics) = (failures, diagnostics);
    summary
}

/// History for `why` and garbage collection, and the index for the next quick start.
fn remember(plan: &Plan<'_>, store: &Store, worked: bool) -> Result<()> {
    if !worked && plan.index_is_current {
        return Ok(());
    }
    store.record_run(&plan.recipe_id, &plan.as_past_run())?;
    let finished = plan.stages.iter().flat_map(|stage| stage.plans.iter().zip(&stage.finished));
    let entries = finished.filter_map(|(plan, finished)| Some((plan, finished.as_ref()?)));
    store.write_index(&plan.recipe_id, &plan.run_digest(), entries)
}
