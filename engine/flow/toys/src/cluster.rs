//! Overhead of a run on HyperQueue: the six stages of cheap items of [`crate::bench_engine`], as commands on workers.

use crate::bench::bench_recipe;
use crate::toy_kind::ToyKind;
use cosfly_cluster::{Command, Driver, Hq, RequestChange, leaves, requests_of};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_runner::{RunOptions, RunOutcome, plan, run, run_tasks};
use cosfly_stage::Registry;
use cosfly_store::Store;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Wall times of a six-stage recipe on HyperQueue.
#[derive(Clone, Debug)]
pub struct ClusterFigures {
    /// Number of tasks on the workers: all but the last one.
    pub tasks: usize,
    /// Number of commands.
    pub commands: usize,
    /// Time of planning, publishing documents, submitting, running and following, with an empty store.
    pub cold: Duration,
    /// Time in which a finished run is opened, planned and found finished.
    pub pruned: Duration,
}

/// Runs six stages of `items` items each, `batch` items a command, on the running HyperQueue server; `program` starts
/// [`run_toys`] with the arguments of `cosfly task run`. With `apart`, no stages share commands.
///
/// # Errors
/// Refusals of HyperQueue, `bench-failed` where tasks fail.
pub fn bench_cluster(
    folder: &Path,
    items: usize,
    batch: u32,
    apart: bool,
    program: &[String],
) -> Result<ClusterFigures> {
    let recipe = bench_recipe(items, 0.5)?;
    let mut changes = vec![RequestChange::read(&format!("*:batch={batch}"))?];
    // Stages of other requests share no commands.
    for stage in recipe.stages.iter().skip(1).step_by(2).filter(|_| apart) {
        changes.push(RequestChange::read(&format!("{}:batch={}", stage.name, batch + 1))?);
    }
    let requests = requests_of(&recipe, &changes)?;
    let hq = Hq::connect()?;
    let store = Store::open(folder)?;
    let root = std::path::absolute(folder).map_err(|error| Diagnostic::io("find the store", &error))?;
    let command = Command { program: program.to_vec(), store: root.to_string_lossy().into_owned() };
    let commands = leaves(&plan(&recipe, &store)?, &BTreeSet::new(), |_| false, &requests).len();
    let driver = Driver {
        recipe: &recipe,
        store: &store,
        wanted: usize::MAX,
        asked: None,
        command,
        requests,
        cancelled: Arc::default(),
    };
    let start = Instant::now();
    let elsewhere = driver.run(&hq, &|_| {})?;
    let cold = start.elapsed();
    if let Some(failure) = elsewhere.failed.into_values().chain(elsewhere.divergences).next() {
        return Err(failure);
    }
    let summary = run(&recipe, &store, &RunOptions::default(), &|_| {})?;
    if summary.outcome != RunOutcome::Complete || summary.stages.iter().any(|stage| stage.ran > 0) {
        return Err(Diagnostic::new("bench-failed", Fault::Bug, "HyperQueue left something to do"));
    }
    drop(store);
    let start = Instant::now();
    let left = plan(&recipe, &Store::open(folder)?)?.to_run();
    let pruned = start.elapsed();
    debug_assert_eq!(left, 0);
    Ok(ClusterFigures { tasks: 6 * items, commands, cold, pruned })
}

/// `task run` for toys: runs the tasks with the digests.
///
/// # Errors
/// The first failure.
pub fn run_toys(store: &Path, plans: &[String]) -> Result<()> {
    let plans: Vec<Digest> = plans.iter().filter_map(|plan| plan.parse().ok()).collect();
    if plans.is_empty() {
        return Ok(());
    }
    let registry = Registry::new(vec![Box::new(ToyKind { version: 1 })]);
    let ends =
        run_tasks(&Store::open_as_worker(store)?, &registry, &plans, &RunOptions { jobs: 1, ..RunOptions::default() })?;
    ends.into_iter().try_for_each(|end| end.map(drop))
}
