//! Steps of `flights`, each done in a process of its own: runs of the recipe, and commands on the finished dataset.

use super::flights_stages::registry;
use super::outcome::Refusals;
use crate::commands::process::{peak_mb, read_mb};
use clap::ValueEnum;
use cosfly::console::{Console, Progress, RunProgress};
use cosfly_diagnose::{Diagnostic, Fault, Stop};
use cosfly_lab::clock::{process_cpu_s, wall_s};
use cosfly_runner::{Delivery, RunOptions, RunOutcome, deliver};
use cosfly_store::Store;
use cosfly_versions::{difference, record, shelf};
use serde::{Deserialize, Serialize};
use std::ffi::OsString;
use std::fs;
use std::io::BufRead;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A step of the measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Step {
    /// The first run, into an empty store
    First,
    /// An unchanged run again
    Nothing,
    /// A run with another title of the dataset
    Title,
    /// A run with one flight more in a hundred
    More,
    /// An unchanged run again, after all others
    Again,
    /// `cosfly verify`
    Verify,
    /// `cosfly verify --jobs 1`
    VerifyAlone,
    /// `cosfly doctor`
    Doctor,
    /// `cosfly dataset lint`
    Lint,
    /// `cosfly eval`
    Eval,
    /// Tags as by `cosfly dataset tag`, for two versions
    Tag,
    /// `cosfly dataset list`
    List,
    /// `cosfly dataset diff`
    Diff,
    /// `cosfly export --format lerobot`
    Export,
    /// `cosfly preview`
    Preview,
    /// `cosfly gc --delete --keep-runs 1 --keep-days 0`
    Gc,
}

/// Place and size of the measurement.
pub struct Place {
    /// Folder of recipe, store and dataset.
    pub root: PathBuf,
    /// Number of walks; there are two flights for each.
    pub walks: u64,
    /// Tasks at the same time.
    pub jobs: usize,
}

/// Figures of one step.
#[derive(Debug, Serialize, Deserialize)]
pub struct Figures {
    /// Wall time, seconds.
    pub wall_s: f64,
    /// Time in user and system mode of all threads, seconds.
    pub cpu_s: f64,
    /// Megabytes that the process read; 0 where the system does not tell.
    pub read_mb: u64,
    /// Largest memory of the process, megabytes; 0 where the system does not tell.
    pub memory_mb: u64,
    /// Bytes of the dataset, where the step made it.
    pub dataset_bytes: Option<u64>,
    /// Step that was measured.
    pub what: String,
}

impl Step {
    /// All steps in their order.
    pub const ALL: &'static [Self] = &[
        Self::First,
        Self::Nothing,
        Self::Title,
        Self::More,
        Self::Again,
        Self::Verify,
        Self::VerifyAlone,
        Self::Doctor,
        Self::Lint,
        Self::Eval,
        Self::Tag,
        Self::List,
        Self::Diff,
        Self::Export,
        Self::Preview,
        Self::Gc,
    ];

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::First => "first",
            Self::Nothing => "nothing",
            Self::Title => "title",
            Self::More => "more",
            Self::Again => "again",
            Self::Verify => "verify",
            Self::VerifyAlone => "verify-alone",
            Self::Doctor => "doctor",
            Self::Lint => "lint",
            Self::Eval => "eval",
            Self::Tag => "tag",
            Self::List => "list",
            Self::Diff => "diff",
            Self::Export => "export",
            Self::Preview => "preview",
            Self::Gc => "gc",
        }
    }

    /// Name in the table.
    pub fn told(self) -> &'static str {
        match self {
            Self::First => "first run",
            Self::Nothing | Self::Again => "nothing to do",
            Self::Title => "another title",
            Self::More => "1 % more",
            Self::VerifyAlone => "verify --jobs 1",
            Self::Lint => "dataset lint",
            Self::Tag => "dataset tag",
            Self::List => "dataset list",
            Self::Diff => "dataset diff",
            Self::Export => "export lerobot",
            Self::Verify | Self::Doctor | Self::Eval | Self::Preview | Self::Gc => self.name(),
        }
    }
}

/// Does a step in this process.
pub fn do_step(step: Step, place: &Place) -> Result<Figures, Refusals> {
    let (wall, cpu) = (wall_s(), process_cpu_s());
    let more = place.walks + place.walks.div_ceil(100);
    let mut dataset_bytes = None;
    let mut made = |delivery: Delivery| {
        let ran: u64 = delivery.summary.stages.iter().map(|stage| stage.ran).sum();
        let files = delivery.folder.map_or(0, |folder| folder.files);
        dataset_bytes = delivery.folder.map(|folder| folder.bytes);
        format!("{ran} tasks, {files} files")
    };
    let cosfly = |arguments: &[&str]| command(place, arguments);
    let jobs = place.jobs.to_string();
    let what = match step {
        Step::First | Step::Nothing => made(run(place, place.walks, "one")?),
        Step::Title => made(run(place, place.walks, "two")?),
        Step::More | Step::Again => made(run(place, more, "two")?),
        Step::Verify => cosfly(&["verify", "out", "--jobs", &jobs])?,
        Step::VerifyAlone => cosfly(&["verify", "out", "--jobs", "1"])?,
        Step::Doctor => cosfly(&["doctor", "out"])?,
        Step::Lint => cosfly(&["dataset", "lint", "out"])?,
        Step::Eval => cosfly(&["eval", "out", "--out", "evaluated", "--history", "2", "--horizon", "2"])?,
        Step::Tag => tag(place, more)?,
        Step::List => cosfly(&["dataset", "list", "--store", "store"])?,
        Step::Diff => cosfly(&["dataset", "diff", "v1", "v2", "--store", "store"])?,
        Step::Export => {
            let out = place.root.join("exported");
            let _ = fs::remove_dir_all(&out);
            let what = cosfly(&["export", "out", "--format", "lerobot", "--out", "exported", "--jobs", &jobs])?;
            let _ = fs::remove_dir_all(&out);
            what
        }
        Step::Preview => cosfly(&["preview", "out"])?,
        Step::Gc => cosfly(&["gc", "--store", "store", "--delete", "--keep-runs", "1", "--keep-days", "0"])?,
    };
    let (wall_s, cpu_s) = (wall_s() - wall, process_cpu_s() - cpu);
    Ok(Figures { wall_s, cpu_s, read_mb: read_mb(), memory_mb: peak_mb(), dataset_bytes, what })
}

/// A run of the recipe, delivered.
pub(super) fn run(place: &Place, walks: u64, title: &str) -> Result<Delivery, Refusals> {
    let recipe = cosfly_recipe::load(&place.root.join("flights.toml"), &sets(walks, title), &registry().map_err(one)?)?;
    let store = Store::open(&place.root.join("store")).map_err(one)?;
    let options = RunOptions { jobs: place.jobs, ..RunOptions::default() };
    let last = recipe.stages.len() - 1;
    let delivery = deliver(&recipe, &store, last, &place.root.join("out"), &options, &|_| {}).map_err(one)?;
    if delivery.summary.outcome != RunOutcome::Complete {
        let mut failures: Refusals = delivery.summary.failures.into_iter().map(|it| it.diagnostic).collect();
        failures.extend(delivery.summary.diagnostics);
        return Err(failures);
    }
    Ok(delivery)
}

fn sets(walks: u64, title: &str) -> Vec<String> {
    vec![format!("stages.expert.count={walks}"), format!("stages.dataset.title=\"{title}\"")]
}

/// The named version `v1` of the first flights, and `v2` of all, as `cosfly dataset tag` records them. (The command knows no
/// toys.)
fn tag(place: &Place, more: u64) -> Result<String, Refusals> {
    let store = Store::open(&place.root.join("store")).map_err(one)?;
    let mut flights = vec![];
    for (name, walks) in [("v1", place.walks), ("v2", more)] {
        let sets = sets(walks, "two");
        let recipe = cosfly_recipe::load(&place.root.join("flights.toml"), &sets, &registry().map_err(one)?)?;
        let version = record::record(name, &recipe, &sets, &store, "lab").map_err(one)?;
        for earlier in shelf::all(&place.root.join("store")).map_err(one)? {
            difference::difference(&earlier.map_err(one)?, &version);
        }
        shelf::put(&place.root.join("store"), &version).map_err(one)?;
        flights.push(version.flights.len());
    }
    Ok(format!("versions of {} and {} flights", flights[0], flights[1]))
}

/// A command of `cosfly` in the folder of the measurement; gives the last line of what it prints.
fn command(place: &Place, arguments: &[&str]) -> Result<String, Refusals> {
    let refused = |error: std::io::Error| one(Diagnostic::io("enter the folder of the measurement", &error));
    std::env::set_current_dir(&place.root).map_err(refused)?;
    let console = Quiet::default();
    match cosfly::call(arguments.iter().map(OsString::from), &console) {
        Ok(_) => Ok(console.last_line()),
        Err(cosfly::Refusal::Arguments(error)) => {
            Err(one(Diagnostic::new("bench-failed", Fault::Bug, error.to_string())))
        }
        Err(cosfly::Refusal::Work(refusals)) => Err(refusals),
    }
}

/// Keeps the end of what a command prints.
#[derive(Default)]
struct Quiet(std::sync::Mutex<String>);

impl Quiet {
    fn last_line(&self) -> String {
        self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner).clone()
    }
}

impl Console for Quiet {
    fn print(&self, text: &str) -> cosfly_diagnose::Result<bool> {
        if let Some(line) = text.lines().rfind(|line| !line.is_empty()) {
            *self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = line.to_owned();
        }
        Ok(true)
    }

    fn tell(&self, message: &str) {
        eprintln!("{message}");
    }

    fn input(&self) -> Box<dyn BufRead + '_> {
        Box::new(std::io::empty())
    }

    fn stop(&self) -> Stop {
        Stop::default()
    }

    fn cancelled(&self) -> Arc<AtomicBool> {
        Arc::default()
    }

    fn colour(&self) -> bool {
        false
    }

    fn progress(&self, _: &str, _: &str) -> Progress<'_> {
        Box::new(|_, _| {})
    }

    fn run_progress(&self, _: bool) -> RunProgress<'_> {
        Box::new(|_| {})
    }
}

fn one(diagnostic: Box<Diagnostic>) -> Refusals {
    vec![diagnostic]
}

#[cfg(test)]
mod tests {
    use super::super::flights::RECIPE;
    use super::*;

    #[test]
    fn more_flights_make_their_own_tables_only() {
        let scratch = tempfile::tempdir().unwrap();
        let groups = RECIPE.replace("windows", "walks_per_file = 4\nwindows");
        fs::write(scratch.path().join("flights.toml"), groups).unwrap();
        let place = Place { root: scratch.path().to_owned(), walks: 8, jobs: 2 };
        let ran = |delivery: &Delivery, stage: &str| {
            let stages = &delivery.summary.stages;
            stages.iter().find(|it| it.name.as_str() == stage).map(|it| (it.ran, it.reused + it.cached)).unwrap()
        };
        let first = run(&place, 8, "one").unwrap();
        assert_eq!(ran(&first, "dataset.tables"), (2, 0));
        let more = run(&place, 9, "one").unwrap();
        assert_eq!(ran(&more, "dataset.tables"), (1, 2));
        assert_eq!(ran(&more, "frames"), (2, 16));
        let same = run(&place, 9, "one").unwrap();
        assert!(same.summary.stages.iter().all(|stage| stage.ran == 0) && !same.folder.unwrap().changed);
        let renamed = run(&place, 9, "two").unwrap();
        assert_eq!(renamed.summary.stages.iter().map(|stage| stage.ran).sum::<u64>(), 1);
        assert!(place.root.join("out/data/trajectories/train-00002.parquet").exists());
    }

    #[test]
    fn steps_are_called_as_on_the_command_line() {
        for step in Step::ALL {
            assert_eq!(Step::from_str(step.name(), false), Ok(*step));
        }
        assert_eq!(Step::ALL.len(), Step::value_variants().len());
    }
}
