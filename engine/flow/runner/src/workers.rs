//! Workers that take ready tasks, and one thread that publishes what they finish.

use crate::inputs::{Results, SharedInputs};
use crate::intermediates::Intermediates;
use crate::leaf::{Ended, Settlement, Task, execute};
use crate::options::RunOptions;
use crate::plan::Plan;
use crate::processor_time::processor_s;
use crate::publisher::{Publication, Publisher};
use crate::schedule::{Schedule, State, TaskIndex};
use crate::summary::{Ending, Failure, RunSummary};
use cosfly_diagnose::{Diagnostic, Fault, Result, counted};
use cosfly_recipe::{Arrival, Recipe};
use cosfly_stage::{ItemId, Produced, RunEvent, Work};
use cosfly_store::{ActionRecord, Costs, Finished, Store};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Pause before a task that another process is working on is tried again.
const LOOK_AGAIN: Duration = Duration::from_millis(20);
/// Pause after which a waiting worker looks if the run is to stop.
const LOOK_UP: Duration = Duration::from_millis(50);
/// Times that a task may find its inputs gone before it fails.
const MOST_HEALINGS: u32 = 3;
/// Stack of a thread. Parallel work of a stage may nest other tasks on a thread's stack, at most one per thread.
const STACK_BYTES: usize = 32 << 20;

/// State of a run after its work.
#[derive(Default)]
pub(crate) struct AfterWork {
    /// Endings of all tasks, by stage and item.
    pub(crate) endings: Vec<Vec<Ending>>,
    /// The first failed tasks.
    pub(crate) failures: Vec<Failure>,
    /// Measured tasks of each stage, seconds of a clock.
    pub(crate) costs: Vec<Costs>,
    /// Processor time of the work, seconds; `None` where the system does not tell.
    pub(crate) processor_s: Option<f64>,
    /// Failures that belong to no task.
    #[expect(clippy::vec_box, reason = "diagnostics are boxed wherever they go")]
    pub(crate) diagnostics: Vec<Box<Diagnostic>>,
    /// True where the run was asked to stop.
    pub(crate) stopped: bool,
}

/// State that workers and the publisher share.
struct Shared<'r> {
    recipe: &'r Recipe,
    schedule: Schedule,
    /// Results that can be read, by stage and item.
    results: Results,
    inputs: SharedInputs,
    /// Work of each task; set once its done record is durable.
    work: Vec<Option<Work>>,
    /// Tasks that another process was working on.
    contended: Vec<TaskIndex>,
    healings: BTreeMap<TaskIndex, u32>,
    /// Tasks whose intermediate blobs are needed again.
    wanted_whole: BTreeSet<TaskIndex>,
    /// Set where intermediate blobs are removed.
    intermediates: Option<Intermediates<'r>>,
    /// Measured tasks of each stage.
    costs: Vec<Costs>,
    failures: Vec<Failure>,
    #[expect(clippy::vec_box, reason = "diagnostics are boxed wherever they go")]
    diagnostics: Vec<Box<Diagnostic>>,
    /// True where the machine refuses to go on.
    broken: bool,
    stopping: bool,
}

struct Workers<'a, 'r> {
    plan: &'a Plan<'r>,
    store: &'a Store,
    options: &'a RunOptions,
    report: &'a (dyn Fn(RunEvent) + Sync),
    pool: rayon::ThreadPool,
    publisher: Publisher,
    shared: Mutex<Shared<'r>>,
    changed: Condvar,
}

/// Does what `plan` leaves to do, and fills in its results.
pub(crate) fn do_the_rest(
    plan: &mut Plan<'_>,
    store: &Store,
    options: &RunOptions,
    report: &(dyn Fn(RunEvent) + Sync),
) -> Result<AfterWork> {
    let jobs = options.jobs.clamp(1, 1024);
    // What nothing needs now may turn out to be needed.
    for stage in (0..plan.stages.len()).filter(|stage| plan.stages[*stage].cached() < plan.stages[*stage].items()) {
        plan.publish_stage(store, stage)?;
    }
    let results: Results = plan.stages.iter_mut().map(|stage| std::mem::take(&mut stage.finished)).collect();
    let pool = thread_pool(jobs)?;
    let workers = Workers {
        shared: Mutex::new(Shared::new(plan, results)),
        plan,
        store,
        options,
        report,
        pool,
        publisher: Publisher::default(),
        changed: Condvar::new(),
    };
    let before_s = processor_s();
    let sound = workers.run(jobs);
    let processor_s = processor_s().zip(before_s).map(|(after_s, before_s)| after_s - before_s);
    let mut shared = workers.shared.into_inner().unwrap_or_else(PoisonError::into_inner);
    if !sound {
        let message = "internal error: the engine panicked; please report it";
        shared.diagnostics.push(Diagnostic::new("bug-panic", Fault::Bug, message));
    }
    let endings = shared.endings();
    for (stage, results) in plan.stages.iter_mut().zip(shared.results) {
        stage.finished = results;
    }
    let Shared { failures, costs, diagnostics, stopping: stopped, .. } = shared;
    Ok(AfterWork { endings, failures, costs, processor_s, diagnostics, stopped })
}

/// Threads for the parallel work of stages.
pub(crate) fn thread_pool(jobs: usize) -> Result<rayon::ThreadPool> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs).stack_size(STACK_BYTES).build();
    pool.map_err(|error| {
        Diagnostic::new(
            "machine-threads",
            Fault::Machine,
            format!("could not start {jobs}", jobs = counted(jobs, "thread")),
        )
        .because(error)
    })
}

impl<'r> Shared<'r> {
    fn new(plan: &Plan<'r>, results: Results) -> Self {
        let recipe = plan.recipe;
        let work = results.iter().flatten().map(|finished| finished.as_ref().map(|_| Work::Cached)).collect();
        let will_run = |stage: usize, item: usize| plan.stages[stage].needed[item] && results[stage][item].is_none();
        let schedule = Schedule::new(recipe, |stage, item| !will_run(stage, item));
        let intermediates = || Intermediates::new(recipe, &schedule, &results);
        Self {
            intermediates: recipe.remove_intermediates.then(intermediates),
            recipe,
            schedule,
            results,
            inputs: SharedInputs::default(),
            work,
            contended: Vec::new(),
            healings: BTreeMap::new(),
            wanted_whole: BTreeSet::new(),
            costs: vec![Costs::default(); recipe.stages.len()],
            failures: Vec::new(),
            diagnostics: Vec::new(),
            broken: false,
            stopping: false,
        }
    }

    /// Makes the blobs of a task readable for others.
    fn finish(&mut self, task: TaskIndex, finished: Finished) {
        let (stage, item) = self.schedule.place(task);
        if self.results[stage][item].replace(finished).is_some() {
            self.inputs.forget(self.recipe, stage);
        }
        self.schedule.finish(task);
    }

    /// Removes the intermediate blobs that nothing needs any more now that `task` is durable.
    fn remove_spent(&mut self, store: &Store, task: TaskIndex, record: &ActionRecord) {
        let Some(intermediates) = &mut self.intermediates else { return };
        for blob in intermediates.finished(&self.schedule, &self.results, task, record) {
            if let Err(diagnostic) = store.remove_blob(&blob) {
                self.diagnostics.push(diagnostic);
            }
        }
    }

    /// Tasks that `task` reads and whose blobs are gone.
    fn lost_inputs(&self, store: &Store, task: TaskIndex) -> Vec<TaskIndex> {
        let (stage, item) = self.schedule.place(task);
        let mut lost = BTreeSet::new();
        let reader = &self.recipe.stages[stage].items[item];
        for connection in &self.recipe.stages[stage].connections {
            let is_lost = |arrival: &&Arrival| {
                let Some(finished) = &self.results[arrival.stage][arrival.item] else { return true };
                let mut seen =
                    finished.record.outputs.iter().filter(|(name, _)| connection.port.sees.shows(name, reader));
                seen.any(|(_, blob)| !store.holds_blob(blob))
            };
            let arrivals = connection.arrivals_for(item).iter().filter(is_lost);
            lost.extend(arrivals.map(|arrival| self.schedule.task(arrival.stage, arrival.item)));
        }
        lost.into_iter().collect()
    }

    /// Whether a task reads one that nothing needed when the run was planned, and that has no result.
    fn lacks_results(&self, task: TaskIndex) -> bool {
        let (stage, item) = self.schedule.place(task);
        self.recipe.stages[stage].reads(item).any(|arrival| self.results[arrival.stage][arrival.item].is_none())
    }

    /// Whether a task has a result.
    fn has_result(&self, task: TaskIndex) -> bool {
        let (stage, item) = self.schedule.place(task);
        self.results[stage][item].is_some()
    }

    fn endings(&self) -> Vec<Vec<Ending>> {
        let ending = |task: TaskIndex| match (self.schedule.state(task), self.work[task]) {
            (State::Failed, _) => Ending::Failed,
            (State::Skipped, _) => Ending::Skipped,
            (_, Some(work)) => Ending::Finished(work),
            (State::Finished, None) if !self.has_result(task) => Ending::NotNeeded,
            (_, None) => Ending::Cancelled,
        };
        let of_stage = |(stage, results): (usize, &Vec<Option<Finished>>)| {
            (0..results.len()).map(|item| ending(self.schedule.task(stage, item))).collect()
        };
        self.results.iter().enumerate().map(of_stage).collect()
    }
}

impl<'r> Workers<'_, 'r> {
    /// Runs to the end; false where a thread panicked.
    fn run(&self, jobs: usize) -> bool {
        std::thread::scope(|scope| {
            let publishing = scope.spawn(|| self.publish());
            let workers: Vec<_> = (0..jobs).map(|_| scope.spawn(|| self.work())).collect();
            // All are joined before anything is decided.
            let failed = workers.into_iter().map(|worker| worker.join().is_err()).filter(|failed| *failed).count();
            self.publisher.close();
            publishing.join().is_ok() && failed == 0
        })
    }

    fn lock(&self) -> MutexGuard<'_, Shared<'r>> {
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn work(&self) {
        while let Some(task) = self.next_task() {
            self.attempt(task);
            self.changed.notify_all();
        }
        self.changed.notify_all();
    }

    /// Next task to attempt; `None` when the run is over or stops.
    fn next_task(&self) -> Option<TaskIndex> {
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

    fn is_stopping(&self, shared: &mut Shared<'_>) -> bool {
        if self.options.cancelled.load(Ordering::Relaxed) && !std::mem::replace(&mut shared.stopping, true) {
            (self.report)(RunEvent::Stopping);
        }
        shared.stopping || shared.broken
    }

    fn attempt(&self, index: TaskIndex) {
        if self.lock().lacks_results(index) {
            return self.heal(index);
        }
        let task = self.task(index);
        if let Some(diagnostic) = self.options.failed_elsewhere.get(&task.plan) {
            return self.failed(index, diagnostic.clone());
        }
        let started = Instant::now();
        match self.pool.install(|| execute(self.store, &task)) {
            Ok(Ended::AlreadyDone(finished)) => self.found_done(index, finished, started.elapsed()),
            Ok(Ended::Contended) => self.lock().contended.push(index),
            Ok(Ended::InputsLost) => self.heal(index),
            Ok(Ended::Settled(settlement)) => self.settled(index, settlement, started.elapsed()),
            Err(diagnostic) => self.failed(index, diagnostic),
        }
    }

    fn id(&self, index: TaskIndex) -> ItemId {
        let (stage, item) = self.lock().schedule.place(index);
        self.plan.recipe.id(stage, item)
    }

    /// A task with its inputs.
    fn task(&self, index: TaskIndex) -> Task<'_> {
        let mut shared = self.lock();
        let shared = &mut *shared;
        let (stage, item) = shared.schedule.place(index);
        let recipe = self.plan.recipe;
        let planned = &self.plan.stages[stage];
        Task {
            plan: planned.plans[item],
            stage: &*recipe.stages[stage].stage,
            id: recipe.id(stage, item),
            recipe_seed: recipe.seed,
            definition: &planned.definition,
            sources: &planned.sources,
            ports: shared.inputs.of_task(recipe, &shared.results, stage, item),
            whole: shared.wanted_whole.contains(&index),
            cancelled: Arc::clone(&self.options.cancelled),
        }
    }

    /// Ends a task that another process finished meanwhile.
    fn found_done(&self, index: TaskIndex, finished: Finished, took: Duration) {
        let produced = Produced::clone(&finished.record.produced);
        let mut shared = self.lock();
        shared.work[index] = Some(Work::Cached);
        shared.finish(index, finished);
        drop(shared);
        self.report_finished(index, Work::Cached, took, produced);
    }

    fn settled(&self, index: TaskIndex, settlement: Settlement, took: Duration) {
        let mut shared = self.lock();
        shared.diagnostics.extend(settlement.divergence.clone());
        drop(shared);
        // Queued before what depends on it can start, so that done records appear in dependency order.
        let finished = settlement.finished.clone();
        self.publisher.submit(Publication { task: index, settlement, took });
        self.lock().finish(index, finished);
    }

    fn failed(&self, index: TaskIndex, diagnostic: Box<Diagnostic>) {
        let id = self.id(index);
        let mut shared = self.lock();
        if diagnostic.fault == Fault::Stopped && self.is_stopping(&mut shared) {
            return shared.schedule.abandon(index);
        }
        let (stage, item) = shared.schedule.place(index);
        // The next task would meet the same full disk.
        shared.broken |= diagnostic.fault == Fault::DiskFull;
        shared.schedule.fail(index);
        if shared.failures.len() < RunSummary::MOST_FAILURES {
            shared.failures.push(Failure { id: id.clone(), diagnostic: diagnostic.clone() });
        }
        drop(shared);
        let plan = &self.plan.stages[stage].plans[item];
        if diagnostic.fault != Fault::DiskFull && !self.options.failed_elsewhere.contains_key(plan) {
            // For those who look at the store; the run tells it anyway. Where it failed elsewhere, it was left there.
            let _ = self.store.put_failure(plan, &diagnostic);
        }
        (self.report)(RunEvent::Failed { id, diagnostic });
    }

    /// Makes the tasks run again whose blobs a task reads and did not find.
    fn heal(&self, index: TaskIndex) {
        let mut shared = self.lock();
        let tries = shared.healings.entry(index).or_insert(0);
        *tries += 1;
        if *tries > MOST_HEALINGS {
            drop(shared);
            let message = "its inputs keep vanishing from the store";
            let diagnostic = Diagnostic::new("store-damaged", Fault::Machine, message)
                .hint("check the disk, or choose another folder with `--store`");
            return self.failed(index, diagnostic);
        }
        let lost = shared.lost_inputs(self.store, index);
        if lost.is_empty() {
            shared.contended.push(index);
        } else {
            shared.wanted_whole.extend(&lost);
            shared.schedule.wait_again(index, &lost);
        }
    }

    fn publish(&self) {
        let document = |index: TaskIndex| {
            let (stage, item) = self.lock().schedule.place(index);
            (self.plan.stages[stage].plans[item], self.plan.document(stage, item))
        };
        let durable = |publication: Publication| {
            let Publication { task, settlement, took } = publication;
            let mut shared = self.lock();
            let is_first = shared.work[task].replace(settlement.work).is_none();
            if settlement.work == Work::Ran {
                let (stage, _) = shared.schedule.place(task);
                shared.costs[stage].items += 1;
                shared.costs[stage].seconds += took.as_secs_f64();
            }
            if is_first {
                shared.remove_spent(self.store, task, &settlement.finished.record);
            }
            drop(shared);
            self.report_finished(task, settlement.work, took, Produced::clone(&settlement.finished.record.produced));
        };
        let refused = |diagnostic: Box<Diagnostic>| {
            let mut shared = self.lock();
            if !std::mem::replace(&mut shared.broken, true) {
                shared.diagnostics.push(diagnostic);
            }
        };
        self.publisher.serve(self.store, document, durable, refused);
    }

    fn report_finished(&self, index: TaskIndex, work: Work, took: Duration, produced: Produced) {
        (self.report)(RunEvent::Finished { id: self.id(index), work, took, produced });
    }
}
