//! Laws of the engine, held on toy stages.

mod caching;
mod crashing;
mod explaining;
mod healing;
mod intermediates;
mod sharing;
mod single;

use cosfly_recipe::Recipe;
use cosfly_runner::{RunOptions, RunSummary, run};
use cosfly_stage::{Fan, RunEvent};
use cosfly_store::{ActionRecord, Store};
use cosfly_toys::{Hook, Toy, toy_recipe};
use serde_json::json;
use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};

/// Items that ran, as `stage/item`, in order.
#[derive(Clone, Default)]
struct Log(Arc<Mutex<Vec<String>>>);

impl Log {
    fn hook(&self) -> Hook {
        let log = Arc::clone(&self.0);
        Arc::new(move |context| {
            log.lock().unwrap().push(context.id.to_string());
            Ok(())
        })
    }

    /// Items that ran since the last call, sorted.
    fn take(&self) -> Vec<String> {
        let mut ran = std::mem::take(&mut *self.0.lock().unwrap());
        ran.sort();
        ran
    }
}

/// A recipe in the shape of the real ones: a town, paths in it, experts, perturbed ones, a dataset of all.
fn town_toys(paths: usize, log: &Log) -> Vec<Toy> {
    let mut toys = vec![
        Toy::new("town", 1, &[]),
        Toy::new("walkers", paths, &[(0, Fan::Broadcast)]),
        Toy::new("expert", 0, &[(1, Fan::Each), (0, Fan::Broadcast)]),
        Toy::new("noisy", 0, &[(2, Fan::Each)]),
        Toy::new("dataset", 1, &[(2, Fan::Gather), (3, Fan::Gather)]),
    ];
    for toy in &mut toys {
        toy.hook = log.hook();
        toy.parameters = json!({ "speed": { "min_mps": 0.5 } });
    }
    toys
}

fn recipe(toys: &[Toy]) -> Recipe {
    toy_recipe("toys", 7, toys).unwrap()
}

fn options(jobs: usize) -> RunOptions {
    RunOptions { jobs, cancelled: Arc::new(AtomicBool::new(false)), ..RunOptions::default() }
}

fn run_quietly(recipe: &Recipe, store: &Store) -> RunSummary {
    run(recipe, store, &options(2), &|_| {}).unwrap()
}

/// Runs and returns the events, too.
fn run_with_events(recipe: &Recipe, store: &Store, options: &RunOptions) -> (RunSummary, Vec<RunEvent>) {
    let events = Mutex::new(Vec::new());
    let summary = run(recipe, store, options, &|event| events.lock().unwrap().push(event)).unwrap();
    (summary, events.into_inner().unwrap())
}

/// `stage/item` of all tasks that were reported as finished, sorted.
fn reported_finished(events: &[RunEvent]) -> Vec<String> {
    let mut finished: Vec<String> = events
        .iter()
        .filter_map(|event| match event {
            RunEvent::Finished { id, .. } => Some(id.to_string()),
            _ => None,
        })
        .collect();
    finished.sort();
    finished
}

/// Records of all finished items, by `stage/item`.
fn records(summary: &RunSummary) -> BTreeMap<String, ActionRecord> {
    let stages = summary.stages.iter().enumerate();
    stages
        .flat_map(|(index, stage)| {
            let items = summary.finished_items(index);
            items.map(move |(item, finished)| (format!("{}/{item}", stage.name), (*finished.record).clone()))
        })
        .collect()
}

/// Index of the stage called `name` in a recipe of toys.
fn at(toys: &[Toy], name: &str) -> usize {
    toys.iter().position(|toy| toy.name == name).unwrap()
}

/// (ran, reused, cached, failed, skipped, unfinished) over all stages.
fn counts(summary: &RunSummary) -> [u64; 6] {
    summary.stages.iter().fold([0; 6], |sum, stage| {
        let of = [stage.ran, stage.reused, stage.cached, stage.failed, stage.skipped, stage.unfinished];
        assert_eq!(of.iter().sum::<u64>() + stage.not_needed, stage.total, "{stage:?}");
        std::array::from_fn(|n| sum[n] + of[n])
    })
}

/// A store in a fresh folder.
fn fresh_store() -> (tempfile::TempDir, Store) {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(&folder.path().join("store")).unwrap();
    (folder, store)
}
