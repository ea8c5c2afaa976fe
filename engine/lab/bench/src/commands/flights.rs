//! `flights`: many tiny flights through the real logs, tables, manifest and delivery.

use super::flights_stages::registry;
use super::outcome::{Outcome, Refusals, print};
use clap::Args;
use cosfly_diagnose::Diagnostic;
use cosfly_runner::{Delivery, RunOptions, RunOutcome, deliver};
use cosfly_stage::Registry;
use cosfly_store::{GarbageOptions, Store, collect_garbage};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant, SystemTime};

/// Examples of the help text.
pub const EXAMPLES: &str = "\
Examples:
  cosfly-lab flights --count 10000
  cosfly-lab flights --count 100000 --jobs 2

The scratch folder is made in the current folder: it needs about 60 kB and five files for a flight.";

/// Arguments of `flights`.
#[derive(Args, Debug)]
pub struct FlightsArguments {
    /// Number of flights, half of them perturbed twins
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    pub count: u64,
    /// Tasks at the same time [default: one per core]
    #[arg(long, value_name = "N")]
    pub jobs: Option<usize>,
}

/// Recipe of the measurement.
const RECIPE: &str = r#"
name = "flights"
intermediates = "remove"
[stages.town]
use = "toy_town"
[stages.expert]
use = "toy_walks"
count = 1
[stages.perturbed]
use = "toy_twins"
inputs.walks = "expert"
[stages.frames]
use = "toy_films"
inputs = { town = "town", walks = ["expert", "perturbed"] }
[stages.dataset]
use = "dataset"
inputs = { town = "town", frames = "frames" }
windows = { size = 4, history = 2, stride = 1 }
"#;

/// A store and an output folder, and the recipe that is run into them.
struct Bench<'a> {
    root: &'a Path,
    registry: Registry,
    jobs: usize,
}

impl Bench<'_> {
    /// One run in an engine of its own, as a new process would do it.
    fn run(&self, walks: u64, title: &str) -> Result<(Duration, Delivery), Refusals> {
        reset_peak();
        let began = Instant::now();
        let sets = [format!("stages.expert.count={walks}"), format!("stages.dataset.title=\"{title}\"")];
        let recipe = cosfly_recipe::load(&self.root.join("flights.toml"), &sets, &self.registry)?;
        let store = Store::open(&self.root.join("store")).map_err(one)?;
        let options = RunOptions { jobs: self.jobs, ..RunOptions::default() };
        let last = recipe.stages.len() - 1;
        let delivery = deliver(&recipe, &store, last, &self.root.join("out"), &options, &|_| {}).map_err(one)?;
        if delivery.summary.outcome != RunOutcome::Complete {
            let mut failures: Refusals = delivery.summary.failures.into_iter().map(|it| it.diagnostic).collect();
            failures.extend(delivery.summary.diagnostics);
            return Err(failures);
        }
        Ok((began.elapsed(), delivery))
    }
}

/// Measures publishing.
pub fn flights(arguments: &FlightsArguments) -> Outcome {
    let walks = arguments.count.div_ceil(2).max(1);
    let jobs = arguments.jobs.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
    let failed = |error: std::io::Error| one(Diagnostic::io("make a scratch folder here", &error));
    let scratch = std::env::current_dir().and_then(tempfile::tempdir_in).map_err(failed)?;
    fs::write(scratch.path().join("flights.toml"), RECIPE).map_err(failed)?;
    let bench = Bench { root: scratch.path(), registry: registry().map_err(one)?, jobs };
    print(&format!("{} flights, {jobs} jobs\n", 2 * walks))?;
    let row = |what: &str, (took, delivery): &(Duration, Delivery)| {
        let made: u64 = delivery.summary.stages.iter().map(|stage| stage.ran).sum();
        let files = delivery.folder.map_or(0, |folder| folder.files);
        print(&format!(
            "{what:<28}{:>9.2} s   {made:>7} tasks, {files:>7} files, at most {} MB of memory\n",
            took.as_secs_f64(),
            peak_mb()
        ))
    };
    let first = bench.run(walks, "one")?;
    row("first run", &first)?;
    row("nothing to do", &bench.run(walks, "one")?)?;
    row("another title", &bench.run(walks, "two")?)?;
    let more = walks.div_ceil(100);
    let added = bench.run(walks + more, "two")?;
    row(&format!("{} flights more", 2 * more), &added)?;
    row("nothing to do", &bench.run(walks + more, "two")?)?;
    let now = SystemTime::now() + Duration::from_secs(1);
    let options = GarbageOptions { keep_runs: 1, keep_age: Duration::ZERO, now, dry_run: false };
    collect_garbage(&bench.root.join("store"), &options).map_err(one)?;
    let bytes = added.1.folder.map_or(0, |folder| folder.bytes);
    print(&format!(
        "dataset {:.1} MB; store and dataset together {:.1} MB on the disk after `gc`\n",
        bytes as f64 / 1e6,
        used_bytes(bench.root) as f64 / 1e6
    ))
}

fn one(diagnostic: Box<Diagnostic>) -> Refusals {
    vec![diagnostic]
}

/// Bytes of all files below a folder, each file once whatever the number of its names.
fn used_bytes(folder: &Path) -> u64 {
    let mut seen = std::collections::BTreeSet::new();
    let mut open = vec![folder.to_owned()];
    let mut bytes = 0;
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).into_iter().flatten().flatten() {
            let Ok(metadata) = entry.metadata() else { continue };
            if metadata.is_dir() {
                open.push(entry.path());
            } else if is_new(&metadata, &mut seen) {
                bytes += metadata.len();
            }
        }
    }
    bytes
}

#[cfg(unix)]
fn is_new(metadata: &fs::Metadata, seen: &mut std::collections::BTreeSet<u64>) -> bool {
    seen.insert(std::os::unix::fs::MetadataExt::ino(metadata))
}

#[cfg(not(unix))]
fn is_new(_: &fs::Metadata, _: &mut std::collections::BTreeSet<u64>) -> bool {
    true
}

/// Forgets the peak of memory so far, where the system can.
fn reset_peak() {
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// Largest memory since the last reset, megabytes; 0 where the system does not tell.
fn peak_mb() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok()).unwrap_or(0) / 1000
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_flights_make_their_own_tables_only() {
        let scratch = tempfile::tempdir().unwrap();
        let groups = RECIPE.replace("windows", "walks_per_file = 4\nwindows");
        fs::write(scratch.path().join("flights.toml"), groups).unwrap();
        let bench = Bench { root: scratch.path(), registry: registry().unwrap(), jobs: 2 };
        let ran = |delivery: &Delivery, stage: &str| {
            let stages = &delivery.summary.stages;
            stages.iter().find(|it| it.name.as_str() == stage).map(|it| (it.ran, it.reused + it.cached)).unwrap()
        };
        let (_, first) = bench.run(8, "one").unwrap();
        assert_eq!(ran(&first, "dataset.tables"), (2, 0));
        let (_, more) = bench.run(9, "one").unwrap();
        assert_eq!(ran(&more, "dataset.tables"), (1, 2));
        assert_eq!(ran(&more, "frames"), (2, 16));
        let (_, same) = bench.run(9, "one").unwrap();
        assert!(same.summary.stages.iter().all(|stage| stage.ran == 0) && !same.folder.unwrap().changed);
        let (_, renamed) = bench.run(9, "two").unwrap();
        assert_eq!(renamed.summary.stages.iter().map(|stage| stage.ran).sum::<u64>(), 1);
        assert!(bench.root.join("out/data/trajectories/train-00002.parquet").exists());
    }
}
