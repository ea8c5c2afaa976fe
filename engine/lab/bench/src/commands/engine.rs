//! `engine`: the runner with cheap items.

use super::outcome::{Outcome, print};
use clap::Args;
use cosfly_diagnose::Diagnostic;

/// Arguments of `engine`.
#[derive(Args, Debug)]
pub struct EngineArguments {
    /// Items per stage; there are six stages
    #[arg(long, value_name = "N", default_value_t = 1000)]
    pub items: u64,
}

/// Measures the engine with cheap items, in a scratch store on the disk of the current folder.
pub fn engine(arguments: &EngineArguments) -> Outcome {
    let one = |refusal| vec![refusal];
    let scratch = std::env::current_dir()
        .and_then(tempfile::tempdir_in)
        .map_err(|error| one(Diagnostic::io("make a scratch folder here", &error)))?;
    let jobs = std::thread::available_parallelism().map_or(1, usize::from);
    let figures =
        cosfly_toys::bench_engine(&scratch.path().join("store"), arguments.items as usize, jobs).map_err(one)?;
    print(&format!(
        "{} tasks in six stages, {jobs} jobs, a durable store, 16 KiB written per task\n\
         cold                                {:>9.3} s   {:.2} ms per task\n\
         everything cached                   {:>9.3} s\n\
         a parameter of stage three changed  {:>9.3} s   {} tasks ran\n\
         changed back                        {:>9.3} s   {} tasks ran\n",
        figures.tasks,
        figures.cold.as_secs_f64(),
        figures.cold_ms_per_task(),
        figures.no_op.as_secs_f64(),
        figures.change.as_secs_f64(),
        figures.change_ran,
        figures.change_back.as_secs_f64(),
        figures.change_back_ran,
    ))
}
