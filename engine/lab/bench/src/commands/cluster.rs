//! `cluster`: a run of cheap items on a running HyperQueue server; `task run`: its commands.

use super::outcome::{Outcome, print};
use clap::Args;
use cosfly_diagnose::Diagnostic;
use std::path::PathBuf;

/// Arguments of `cluster`.
#[derive(Args, Debug)]
pub struct ClusterArguments {
    /// Items per stage; there are six stages
    #[arg(long, value_name = "N", default_value_t = 1000)]
    pub items: u64,
    /// Items a command, of all stages of a chain
    #[arg(long, value_name = "N", default_value_t = 64)]
    pub batch: u32,
    /// Commands of one stage only: chains of cheap stages share none
    #[arg(long)]
    pub apart: bool,
}

/// Arguments of `task run`.
#[derive(Args, Debug)]
pub struct TaskArguments {
    /// Always `run`
    pub verb: String,
    /// Store
    #[arg(long)]
    pub store: PathBuf,
    /// Threads of a task
    #[arg(long)]
    pub jobs: u16,
    /// Digests of plans
    pub plans: Vec<String>,
}

/// Measures a run on HyperQueue with cheap items, in a scratch store on the disk of the current folder.
pub fn cluster(arguments: &ClusterArguments) -> Outcome {
    let one = |refusal| vec![refusal];
    let io = |error: std::io::Error| vec![Diagnostic::io("make a scratch folder here", &error)];
    let scratch = std::env::current_dir().and_then(tempfile::tempdir_in).map_err(io)?;
    let program = vec![std::env::current_exe().map_err(io)?.to_string_lossy().into_owned()];
    let store = scratch.path().join("store");
    let items = arguments.items as usize;
    let figures = cosfly_toys::bench_cluster(&store, items, arguments.batch, arguments.apart, &program).map_err(one)?;
    print(&format!(
        "{} tasks in six stages as {} commands on HyperQueue, a durable store, 16 KiB written per task\n\
         cold                {:>9.3} s   {:.2} ms per task\n\
         found finished      {:>9.3} s\n",
        figures.tasks,
        figures.commands,
        figures.cold.as_secs_f64(),
        figures.cold.as_secs_f64() * 1e3 / figures.tasks.max(1) as f64,
        figures.pruned.as_secs_f64(),
    ))
}

/// Runs toys by their plan digests.
pub fn task(arguments: &TaskArguments) -> Outcome {
    cosfly_toys::run_toys(&arguments.store, &arguments.plans).map_err(|refusal| vec![refusal])
}
