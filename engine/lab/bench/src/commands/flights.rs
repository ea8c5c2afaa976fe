//! `flights`: many tiny flights through the real logs, tables, manifest and delivery, then what users do with the dataset.

use super::flights_steps::{Figures, Place, Step, do_step};
use super::outcome::{Outcome, Refusals, print};
use clap::Args;
use cosfly_diagnose::{Diagnostic, Fault};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Examples of the help text.
pub const EXAMPLES: &str = "\
Examples:
  cosfly-lab flights --count 10000
  cosfly-lab flights --count 100000 --jobs 2
  cosfly-lab flights --count 1000 --keep kept         keeps store and dataset; a step can be repeated with --only
  cosfly-lab flights --count 1000 --keep kept --only verify,doctor

Each step is a process of its own: `memory` is the most that it ever held, `cpu` its time in user and system mode, `read`
what it read. The scratch folder is made in the current folder: it needs about 80 kB and five files for a flight.";

/// Arguments of `flights`.
#[derive(Args, Debug)]
pub struct FlightsArguments {
    /// Number of flights, half of them perturbed twins
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    pub count: u64,
    /// Tasks at the same time [default: one per core]
    #[arg(long, value_name = "N")]
    pub jobs: Option<usize>,
    /// Folder of store and dataset, which stays [default: a scratch folder]
    #[arg(long, value_name = "DIR")]
    pub keep: Option<PathBuf>,
    /// Steps to do, in their order [default: all]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub only: Vec<Step>,
    /// Does one step in this process, and prints its figures as JSON
    #[arg(long, hide = true, requires = "keep")]
    pub step: Option<Step>,
}

/// Recipe of the measurement.
pub(super) const RECIPE: &str = r#"
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

/// Measures publishing and reading.
pub fn flights(arguments: &FlightsArguments) -> Outcome {
    let walks = arguments.count.div_ceil(2).max(1);
    let jobs = arguments.jobs.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
    if let (Some(step), Some(root)) = (arguments.step, &arguments.keep) {
        let figures = do_step(step, &Place { root: root.clone(), walks, jobs })?;
        return print(&serde_json::to_string(&figures).unwrap_or_default());
    }
    let failed = |error: std::io::Error| one(Diagnostic::io("make a scratch folder here", &error));
    let scratch = match &arguments.keep {
        Some(_) => None,
        None => Some(std::env::current_dir().and_then(tempfile::tempdir_in).map_err(failed)?),
    };
    let root = scratch.as_ref().map_or_else(|| arguments.keep.clone().unwrap_or_default(), |it| it.path().to_owned());
    fs::create_dir_all(&root).and_then(|()| fs::write(root.join("flights.toml"), RECIPE)).map_err(failed)?;
    print(&format!(
        "{} flights, {jobs} jobs; a process for each step\n\
         {:<18}{:>9}{:>9}{:>10}{:>12}  what\n",
        2 * walks,
        "step",
        "wall, s",
        "cpu, s",
        "read, MB",
        "memory, MB"
    ))?;
    let mut dataset_bytes = 0;
    for step in Step::ALL.iter().filter(|step| arguments.only.is_empty() || arguments.only.contains(step)) {
        let figures = in_a_process(*step, &root, arguments.count, jobs)?;
        dataset_bytes = figures.dataset_bytes.unwrap_or(dataset_bytes);
        print(&row(*step, &figures))?;
    }
    print(&format!(
        "dataset {:.1} MB; on the disk by blocks: dataset {:.1} MB, with its store {:.1} MB\n",
        dataset_bytes as f64 / 1e6,
        used_bytes(&[&root.join("out")]) as f64 / 1e6,
        used_bytes(&[&root.join("store"), &root.join("out")]) as f64 / 1e6
    ))
}

fn row(step: Step, figures: &Figures) -> String {
    let Figures { wall_s, cpu_s, read_mb, memory_mb, what, .. } = figures;
    format!("{:<18}{wall_s:>9.2}{cpu_s:>9.2}{read_mb:>10}{memory_mb:>12}  {what}\n", step.told())
}

/// Figures of a step that was done in a new process: what another step left in memory does not count.
fn in_a_process(step: Step, root: &Path, count: u64, jobs: usize) -> Result<Figures, Refusals> {
    let failed = |message: String| one(Diagnostic::new("bench-failed", Fault::Machine, message));
    let program = std::env::current_exe().map_err(|error| one(Diagnostic::io("find this program", &error)))?;
    let output = Command::new(program)
        .args(["flights", "--count", &count.to_string(), "--jobs", &jobs.to_string(), "--step", step.name()])
        .arg("--keep")
        .arg(root)
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| one(Diagnostic::io("start this program", &error)))?;
    if !output.status.success() {
        return Err(failed(format!("the step `{}` ended with {}", step.name(), output.status)));
    }
    serde_json::from_slice(&output.stdout).map_err(|error| failed(format!("the step `{}`: {error}", step.name())))
}

fn one(diagnostic: Box<Diagnostic>) -> Refusals {
    vec![diagnostic]
}

/// Bytes of the blocks of all files and folders below some folders, each file once whatever the number of its names, as `du` counts.
fn used_bytes(folders: &[&Path]) -> u64 {
    let mut seen = BTreeSet::new();
    let mut open: Vec<PathBuf> = folders.iter().map(|folder| (*folder).to_owned()).collect();
    let mut bytes = 0;
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).into_iter().flatten().flatten() {
            let Ok(metadata) = entry.metadata() else { continue };
            if metadata.is_dir() {
                open.push(entry.path());
            }
            if is_new(&metadata, &mut seen) {
                bytes += bytes_of_blocks(&metadata);
            }
        }
    }
    bytes
}

#[cfg(unix)]
fn bytes_of_blocks(metadata: &fs::Metadata) -> u64 {
    512 * std::os::unix::fs::MetadataExt::blocks(metadata)
}

#[cfg(not(unix))]
fn bytes_of_blocks(metadata: &fs::Metadata) -> u64 {
    metadata.len()
}

#[cfg(unix)]
fn is_new(metadata: &fs::Metadata, seen: &mut BTreeSet<u64>) -> bool {
    seen.insert(std::os::unix::fs::MetadataExt::ino(metadata))
}

#[cfg(not(unix))]
fn is_new(_: &fs::Metadata, _: &mut BTreeSet<u64>) -> bool {
    true
}
