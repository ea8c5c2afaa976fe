//! Overhead of the engine: six stages of very cheap items, as other engines are measured.

use crate::toy::{Toy, toy_recipe};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_recipe::Recipe;
use cosfly_runner::{RunOptions, RunOutcome, RunSummary, run};
use cosfly_stage::Fan;
use cosfly_store::Store;
use serde_json::json;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// Bytes written by each item.
const BYTES: u64 = 16 << 10;
/// Index of the stage whose parameter is changed, of six.
const CHANGED: usize = 2;

/// Wall times of a six-stage recipe. Each includes opening the store, planning and durable publishing.
#[derive(Clone, Debug)]
pub struct EngineFigures {
    /// Number of items of all stages together.
    pub tasks: u64,
    /// Time with an empty store.
    pub cold: Duration,
    /// Time with everything cached.
    pub no_op: Duration,
    /// Time after a parameter of the third stage changed.
    pub change: Duration,
    /// Number of tasks that ran after the change.
    pub change_ran: u64,
    /// Time after the parameter was changed back.
    pub change_back: Duration,
    /// Number of tasks that ran after the change back.
    pub change_back_ran: u64,
}

impl EngineFigures {
    /// Wall time of the cold run per task, milliseconds.
    pub fn cold_ms_per_task(&self) -> f64 {
        self.cold.as_secs_f64() * 1e3 / (self.tasks.max(1)) as f64
    }
}

/// Runs six stages of `items` items each in a store at `folder`, which must be empty or absent.
///
/// # Errors
/// `machine-io`, and `bench-failed` where the store is not empty.
pub fn bench_engine(folder: &Path, items: usize, jobs: usize) -> Result<EngineFigures> {
    let before = bench_recipe(items, 0.5)?;
    let after = bench_recipe(items, 0.7)?;
    let (cold, first) = timed(folder, &before, jobs)?;
    let (no_op, second) = timed(folder, &before, jobs)?;
    let (change, third) = timed(folder, &after, jobs)?;
    let (change_back, fourth) = timed(folder, &before, jobs)?;
    let tasks = 6 * items as u64;
    if ran(&first) != tasks || ran(&second) != 0 {
        return Err(Diagnostic::new("bench-failed", Fault::Bug, "the store at the start was not empty")
            .hint("choose an empty folder"));
    }
    Ok(EngineFigures {
        tasks,
        cold,
        no_op,
        change,
        change_ran: ran(&third),
        change_back,
        change_back_ran: ran(&fourth),
    })
}

fn ran(summary: &RunSummary) -> u64 {
    summary.stages.iter().map(|stage| stage.ran).sum()
}

fn timed(folder: &Path, recipe: &Recipe, jobs: usize) -> Result<(Duration, RunSummary)> {
    let start = Instant::now();
    let store = Store::open(folder)?;
    let options = RunOptions { jobs, cancelled: Arc::new(AtomicBool::new(false)), ..RunOptions::default() };
    let summary = run(recipe, &store, &options, &|_| {})?;
    let took = start.elapsed();
    if summary.outcome != RunOutcome::Complete {
        let first = summary.failures.into_iter().map(|failure| failure.diagnostic).chain(summary.diagnostics).next();
        return Err(first.unwrap_or_else(|| Diagnostic::new("bench-failed", Fault::Bug, "the run did not end")));
    }
    Ok((took, summary))
}

pub(crate) fn bench_recipe(items: usize, alpha: f64) -> Result<Recipe> {
    let names = ["map", "paths", "optimise", "perturb", "render", "caption"];
    let toys = names.iter().enumerate().map(|(index, name)| {
        let inputs = index.checked_sub(1).map(|upstream| (upstream, Fan::Each));
        let mut toy = Toy::new(name, items, inputs.as_slice());
        toy.parameters = json!({ "bytes": BYTES });
        if index == CHANGED {
            toy.parameters["alpha"] = alpha.into();
        }
        toy
    });
    toy_recipe("bench", 1, &toys.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_parameter_runs_what_reads_it_and_changed_back_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let figures = bench_engine(&folder.path().join("store"), 20, 2).unwrap();
        assert_eq!((figures.tasks, figures.change_ran, figures.change_back_ran), (120, 80, 0));
        assert!(figures.no_op < figures.cold && figures.cold_ms_per_task() > 0.0, "{figures:?}");
    }

    #[test]
    fn a_store_that_is_not_empty_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        bench_engine(folder.path(), 1, 1).unwrap();
        assert_eq!(bench_engine(folder.path(), 1, 1).unwrap_err().code, "bench-failed");
    }
}
