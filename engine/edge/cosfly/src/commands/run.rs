//! `cosfly run`: makes everything a recipe describes, and says what was made, where, and what to open next.

use super::{Outcome, recipe, store_dir};
use crate::arguments::RunArguments;
use crate::reporter::{Reporter, colour};
use crate::text::{bytes, count, duration};
use crate::{exit, interrupt};
use cosfly_fingerprint::Digest;
use cosfly_recipe::Recipe;
use cosfly_runner::{Delivery, RunOptions, RunOutcome, RunSummary, deliver};
use cosfly_store::{Store, check_out_folder};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Runs the recipe and delivers the dataset.
pub fn run(arguments: &RunArguments) -> Outcome {
    let began = Instant::now();
    let recipe = recipe(&arguments.recipe)?;
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out").join(&recipe.name));
    check_out_folder(&store_dir(&arguments.store), &out).map_err(|refusal| vec![refusal])?;
    let store = Store::open(&store_dir(&arguments.store)).map_err(|refusal| vec![refusal])?;
    let jobs = arguments.jobs.map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), usize::from);
    let options = RunOptions { jobs, cancelled: interrupt::flag() };
    let reporter = Reporter::new(arguments.quiet);
    let wanted = delivered_stage(&recipe);
    let delivery = deliver(&recipe, &store, wanted, &out, &options, &|event| reporter.show(event));
    reporter.finish();
    let delivery = delivery.map_err(|refusal| vec![refusal])?;
    if arguments.json {
        crate::print(&json(&recipe, &delivery, &out))?;
    } else {
        let took = duration(began.elapsed());
        if !arguments.quiet {
            crate::print(&stages(&delivery.summary))?;
        }
        crate::print(&result(&delivery, wanted, &out, &store_dir(&arguments.store), &took, arguments.quiet))?;
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
    let rejected = rejections(run);
    for (stage, item, reason) in rejected.iter().take(10) {
        let _ = writeln!(text, "rejected: {stage}/{item}: {reason}");
    }
    if rejected.len() > 10 {
        let _ = writeln!(text, "... and {} more", rejected.len() - 10);
    }
    text + "\n"
}

/// Where rejections began: one travels down to every stage below, with the reason at its end.
fn rejections(run: &RunSummary) -> Vec<(&str, &str, &str)> {
    let mut first: Vec<(&str, &str, &str)> = Vec::new();
    let mut seen: BTreeSet<(&str, &str)> = BTreeSet::new();
    for (stage, item, reason) in run.rejected() {
        // The item's own id stands behind the stages' names: `expert-p00003`.
        let root = item.rsplit('-').next().unwrap_or(item);
        let cause = reason.strip_prefix("its expert was rejected: ").unwrap_or(reason);
        if seen.insert((root, cause)) {
            first.push((stage, item, reason));
        }
    }
    first
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
            let _ = writeln!(text, "  draw it     cosfly preview {}", out.display());
            if let Some(log) = first_log(out) {
                let _ = writeln!(text, "  look at it  {} (Foxglove, Rerun)", log.display());
            }
        }
        None => {
            let next = match delivery.summary.outcome {
                RunOutcome::Failed => "mend what is named above and run the same command again",
                RunOutcome::Complete | RunOutcome::Cancelled => "run the same command to go on",
            };
            let _ = writeln!(
                text,
                "`{wanted}` is not finished after {took}; what is finished is kept in {}: {next}",
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
                "digest": digest_of(run, &stage.name).to_string(),
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

/// One digest over everything that the finished items of a stage hold: equal exactly when all their bytes are.
fn digest_of(run: &RunSummary, stage: &str) -> Digest {
    let mut lines = String::new();
    for (item, finished) in run.finished_items(stage) {
        for (name, blob) in &finished.record.outputs {
            let _ = writeln!(lines, "{item}/{name} {}", blob.digest);
        }
    }
    Digest::of(lines.as_bytes())
}
