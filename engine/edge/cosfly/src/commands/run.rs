//! `cosfly run`: makes everything a recipe describes, and says what was made, where, and what to open next.

use super::{Outcome, recipe, store_dir};
use crate::arguments::RunArguments;
use crate::reporter::{Reporter, colour};
use crate::text::{bytes, count, duration};
use crate::{exit, interrupt};
use cosfly_recipe::Recipe;
use cosfly_runner::{Delivery, RunOptions, RunOutcome, RunSummary, deliver};
use cosfly_store::Store;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Runs the recipe and delivers the dataset.
pub fn run(arguments: &RunArguments) -> Outcome {
    let began = Instant::now();
    let recipe = recipe(&arguments.recipe)?;
    let store = Store::open(&store_dir(&arguments.store)).map_err(|refusal| vec![refusal])?;
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out").join(&recipe.name));
    let jobs = arguments.jobs.map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), usize::from);
    let options = RunOptions { jobs, cancelled: interrupt::flag() };
    let reporter = Reporter::new(arguments.quiet);
    let wanted = delivered_stage(&recipe);
    let delivery = deliver(&recipe, &store, wanted, &out, &options, &|event| reporter.show(event));
    reporter.finish();
    let delivery = delivery.map_err(|refusal| vec![refusal])?;
    if arguments.json {
        crate::print(&json(&recipe, &delivery, &out));
    } else {
        let took = duration(began.elapsed());
        if !arguments.quiet {
            crate::print(&stages(&delivery.summary));
        }
        crate::print(&result(&delivery, wanted, &out, &store_dir(&arguments.store), &took, arguments.quiet));
    }
    Ok(ended(&delivery.summary))
}

/// The stage whose artifact is the result: the last `dataset`, else the last stage.
fn delivered_stage(recipe: &Recipe) -> &str {
    let dataset = recipe.stages.iter().rev().find(|stage| stage.kind == "dataset" && stage.name == stage.recipe_name);
    dataset.or(recipe.stages.last()).map_or("", |stage| stage.name.as_str())
}

/// The exit code, after printing what went wrong without a task failing (failed tasks were reported as they failed).
fn ended(summary: &RunSummary) -> u8 {
    if summary.outcome == RunOutcome::Cancelled {
        return exit::STOPPED;
    }
    for diagnostic in &summary.diagnostics {
        eprintln!("{}", cosfly_diagnose::render(diagnostic, colour()));
    }
    let failed = summary.failures.iter().map(|failure| exit::code_of(&failure.diagnostic));
    failed.chain(summary.diagnostics.iter().map(|diagnostic| exit::code_of(diagnostic))).max().unwrap_or(exit::SUCCESS)
}

/// What every stage came to.
fn stages(run: &RunSummary) -> String {
    let width = run.stages.iter().map(|stage| stage.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for stage in &run.stages {
        let parts: Vec<String> = [
            (stage.cached, "cached"),
            (stage.ran, "made"),
            (stage.reused, "found equal"),
            (stage.failed, "failed"),
            (stage.skipped, "skipped"),
            (stage.unfinished, "not finished"),
        ]
        .into_iter()
        .filter(|(number, _)| *number > 0)
        .map(|(number, what)| format!("{number} {what}"))
        .collect();
        let _ = writeln!(text, "{:width$}  {}: {}", stage.name, count(stage.total, "item"), parts.join(", "));
        // The notes of a stage with one item are facts about the whole run; those of many items are too many.
        if stage.total == 1 {
            for (_, _, produced) in run.produced().filter(|(name, ..)| *name == stage.name) {
                for (name, fact) in &produced.notes {
                    let _ = writeln!(text, "{:width$}    {name}: {fact}", "");
                }
            }
        }
    }
    // A rejection travels down to the stages below; what a person wants to know is where it began.
    let mut rejected: Vec<(&str, &str, &str)> = run.rejected().collect();
    rejected.dedup_by(|later, first| later.2.ends_with(first.2));
    for (stage, item, reason) in rejected.iter().take(10) {
        let _ = writeln!(text, "rejected: {stage}/{item}: {reason}");
    }
    text + "\n"
}

/// Where the result is and what to open next.
fn result(delivery: &Delivery, wanted: &str, out: &Path, store: &Path, took: &str, quiet: bool) -> String {
    let mut text = String::new();
    match &delivery.folder {
        Some(folder) => {
            let state = if folder.changed { "" } else { " (unchanged)" };
            let _ = writeln!(
                text,
                "{} in {} of {}{state}, in {took}",
                out.display(),
                count(folder.files, "file"),
                bytes(folder.bytes)
            );
            if quiet {
                return text;
            }
            let _ = writeln!(text, "  start with  {}", out.join("README.md").display());
            let _ = writeln!(text, "  check it    cosfly verify {}", out.display());
            if let Some(log) = first_log(out) {
                let _ = writeln!(text, "  look at it  {} (Foxglove, Rerun)", log.display());
            }
        }
        None => {
            let _ = writeln!(
                text,
                "`{wanted}` is not finished after {took}; what is finished is kept in {}: run the same command to go on",
                store.display()
            );
        }
    }
    text
}

/// The first sensor log of the dataset, to look at.
fn first_log(out: &Path) -> Option<PathBuf> {
    let mut folder = out.join("mcap");
    loop {
        let mut entries: Vec<PathBuf> =
            std::fs::read_dir(&folder).ok()?.filter_map(|entry| Some(entry.ok()?.path())).collect();
        entries.sort();
        let first = entries.into_iter().next()?;
        if first.is_file() {
            return Some(first);
        }
        folder = first;
    }
}

/// The same for programs.
fn json(recipe: &Recipe, delivery: &Delivery, out: &Path) -> String {
    let run = &delivery.summary;
    let stages: Vec<serde_json::Value> = run
        .stages
        .iter()
        .map(|stage| {
            serde_json::json!({
                "stage": stage.name, "items": stage.total, "cached": stage.cached, "ran": stage.ran,
                "reused": stage.reused, "failed": stage.failed, "skipped": stage.skipped, "unfinished": stage.unfinished,
            })
        })
        .collect();
    let rejected: Vec<serde_json::Value> = run
        .rejected()
        .map(|(stage, item, reason)| serde_json::json!({ "stage": stage, "item": item, "reason": reason }))
        .collect();
    let whole = serde_json::json!({
        "recipe": recipe.name,
        "outcome": match run.outcome {
            RunOutcome::Complete => "complete",
            RunOutcome::Failed => "failed",
            RunOutcome::Cancelled => "stopped",
        },
        "stages": stages,
        "rejected": rejected,
        "out": delivery.folder.as_ref().map(|_| out.display().to_string()),
        "version": delivery.folder.as_ref().map(|folder| folder.version.to_string()),
        "files": delivery.folder.as_ref().map(|folder| folder.files),
        "bytes": delivery.folder.as_ref().map(|folder| folder.bytes),
    });
    serde_json::to_string_pretty(&whole).expect("a summary is plain JSON") + "\n"
}
