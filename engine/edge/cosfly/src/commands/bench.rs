//! `cosfly bench`: measurements.

use super::Outcome;
use crate::exit;
use cosfly_diagnose::Diagnostic;

/// The engine with cheap items, in a scratch store on the disk of the current folder.
pub fn engine(items: u64) -> Outcome {
    let one = |refusal| vec![refusal];
    let scratch = std::env::current_dir()
        .and_then(tempfile::tempdir_in)
        .map_err(|error| one(Diagnostic::io("make a scratch folder here", &error)))?;
    let jobs = std::thread::available_parallelism().map_or(1, usize::from);
    let figures = cosfly_runner::bench_engine(&scratch.path().join("store"), items as usize, jobs).map_err(one)?;
    crate::print(&format!(
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
    ))?;
    Ok(exit::SUCCESS)
}

/// Box queries against other libraries' trees.
pub fn geometry(seed: u64, json: bool) -> Outcome {
    let table = cosfly_bench::geometry::geometry(seed);
    let as_json = || serde_json::to_string_pretty(&table).unwrap_or_default() + "\n";
    crate::print(&if json { as_json() } else { table.to_string() })?;
    Ok(exit::SUCCESS)
}
