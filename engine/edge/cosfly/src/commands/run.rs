//! `cosfly run`: makes everything that a recipe describes; prints the result, its place and what to open next.

use super::elsewhere;
use crate::arguments::{ClusterArguments, Place, RecipeArguments, StoreArguments, threads};
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use crate::text::{bytes, count, duration};
use clap::Parser;
use cosfly_cluster::shell_word;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_recipe::Recipe;
use cosfly_runner::{Delivery, RejectionOrigin, RejectionReason, RunOptions, RunOutcome, RunSummary, deliver};
use cosfly_stage::{ItemId, StageName, StageRole};
use cosfly_store::check_out_folder;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Rejections that are listed.
const MOST_REJECTIONS: usize = 10;

/// Make everything a recipe describes
#[derive(Debug, Parser)]
#[command(
    name = "run",
    after_help = "\
Examples:
  cosfly run recipes/small.toml
  cosfly run recipes/carla_town.toml --jobs 1 --out /data/town
  cosfly run recipes/carla_town.toml --stage expert
  cosfly run recipes/carla_town.toml --set stages.expert.weights.visibility=5 --set seed=7
  cosfly run recipes/carla_town.toml --on hq --store /shared/store --request frames:cpus=4,time=2h
  cosfly run recipes/carla_town.toml --on emit --store /shared/store > commands.jsonl"
)]
pub struct Arguments {
    #[command(flatten)]
    recipe: RecipeArguments,
    #[command(flatten)]
    store: StoreArguments,
    /// Folder for the dataset [default: out/<recipe name>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Make this stage and what it needs, nothing else [default: every stage that no other reads]
    #[arg(long, value_name = "NAME")]
    stage: Option<String>,
    /// Tasks at the same time [default: one per core]
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    #[command(flatten)]
    cluster: ClusterArguments,
    /// Print the summary as JSON
    #[arg(long)]
    json: bool,
    /// Print errors and the last line only
    #[arg(long, short)]
    quiet: bool,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let began = Instant::now();
        let recipe = self.recipe.load(console)?;
        let asked = self.stage.as_deref().map(|name| asked_stage(&recipe, name)).transpose()?;
        let folder =
            self.stage.as_ref().map_or_else(|| recipe.name.clone(), |stage| format!("{}.{stage}", recipe.name));
        let out = self.out.clone().unwrap_or_else(|| PathBuf::from("out").join(folder));
        check_out_folder(&self.store.folder(), &out)?;
        let store = self.store.open()?;
        let jobs = threads(self.jobs);
        let options = RunOptions { jobs, asked, cancelled: console.cancelled(), ..RunOptions::default() };
        let wanted = asked.unwrap_or_else(|| delivered_stage(&recipe));
        if self.cluster.on == Place::Emit {
            return elsewhere::emit(&recipe, &store, wanted, asked, &self.cluster, console);
        }
        let progress = console.run_progress(self.quiet);
        let delivery = match self.cluster.on {
            Place::Hq => {
                elsewhere::deliver(&recipe, &store, wanted, &out, options, &self.cluster, (&*progress, console))
            }
            _ => {
                let _deadline = console.deadline(None);
                deliver(&recipe, &store, wanted, &out, &options, &*progress)
            }
        };
        drop(progress);
        let delivery = delivery?;
        if self.json {
            console.print(&json(&recipe, &delivery, &out, began.elapsed()))?;
        } else {
            let took = duration(began.elapsed());
            if !self.quiet {
                console.print(&stages(&delivery.summary))?;
            }
            let wanted = &recipe.stages[wanted].name;
            let store = self.store.bucket().map_or_else(|| self.store.folder(), PathBuf::from);
            console.print(&result(&delivery, wanted, &out, &store, &took, self.quiet))?;
        }
        Ok(ended(&delivery.summary, console))
    }
}

/// Index of the stage called `name`.
fn asked_stage(recipe: &Recipe, name: &str) -> Result<usize> {
    recipe.position(name).ok_or_else(|| {
        let names: Vec<&str> = recipe.stages.iter().map(|stage| stage.name.as_str()).collect();
        let problem = Diagnostic::new("run-unknown-stage", Fault::Recipe, format!("the recipe has no stage `{name}`"));
        match cosfly_diagnose::nearest_name(name, names.iter().copied()) {
            Some(near) => problem.hint(format!("did you mean `{near}`?")),
            None => {
                let made: Vec<&str> = names.iter().copied().filter(|it| it.starts_with(&format!("{name}_"))).collect();
                match &made[..] {
                    [] => problem.hint(format!("its stages are `{}`", names.join("`, `"))),
                    made => problem.hint(format!("ask for one of `{}`", made.join("`, `"))),
                }
            }
        }
    })
}

/// Index of the stage whose artifact is the result: the last one that publishes, else the last stage.
fn delivered_stage(recipe: &Recipe) -> usize {
    recipe.stages.iter().rposition(|stage| stage.has_role(StageRole::Publishes)).unwrap_or(recipe.stages.len() - 1)
}

/// Exit code, after printing the failures that belong to no task (failed tasks were reported as they failed).
fn ended(summary: &RunSummary, console: &dyn Console) -> u8 {
    if summary.outcome == RunOutcome::Cancelled {
        return exit::STOPPED;
    }
    for diagnostic in &summary.diagnostics {
        console.tell(&cosfly_diagnose::render(diagnostic, console.colour()));
    }
    let failed = summary.failures.iter().map(|failure| exit::code_of(&failure.diagnostic));
    failed.chain(summary.diagnostics.iter().map(|diagnostic| exit::code_of(diagnostic))).max().unwrap_or(exit::SUCCESS)
}

/// Text about all stages and rejections.
fn stages(run: &RunSummary) -> String {
    let width = run.stages.iter().map(|stage| stage.name.as_str().len()).max().unwrap_or(0);
    let mut text = String::new();
    for (index, stage) in run.stages.iter().enumerate() {
        let parts: Vec<String> = [
            (stage.cached, "cached"),
            (stage.ran, "made"),
            (stage.reused, "found equal"),
            (stage.failed, "failed"),
            (stage.skipped, "skipped"),
            (stage.unfinished, "not finished"),
            (stage.not_needed, "not needed"),
        ]
        .into_iter()
        .filter(|(number, _)| *number > 0)
        .map(|(number, what)| format!("{number} {what}"))
        .collect();
        let _ = writeln!(text, "{:width$}  {}: {}", stage.name, count(stage.total, "item"), parts.join(", "));
        // The notes of a stage with one item are facts about the whole run; those of many items are too many.
        if stage.total == 1 {
            for (name, fact) in run.finished_items(index).flat_map(|(_, finished)| &finished.record.produced.notes) {
                let _ = writeln!(text, "{:width$}    {name}: {fact}", "");
            }
        }
    }
    // A rejection is inherited by everything that is made of the item: it is told once, where it began.
    let rejected: Vec<(ItemId, RejectionReason)> =
        run.rejections().filter(|(_, it)| it.origin == RejectionOrigin::Own).collect();
    for (id, RejectionReason { reason, .. }) in rejected.iter().take(MOST_REJECTIONS) {
        let _ = writeln!(text, "rejected: {id}: {reason}");
    }
    if rejected.len() > MOST_REJECTIONS {
        let _ = writeln!(text, "... and {} more", rejected.len() - MOST_REJECTIONS);
    }
    text + "\n"
}

/// Text about the result: its place, and what to open next.
fn result(delivery: &Delivery, wanted: &StageName, out: &Path, store: &Path, took: &str, quiet: bool) -> String {
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
            // The files of a single stage are no dataset.
            if quiet || !out.join("croissant.json").is_file() {
                return text;
            }
            let _ = writeln!(text, "  start with  {}", out.join("README.md").display());
            let folder = shell_word(&out.to_string_lossy());
            let _ = writeln!(text, "  check it    cosfly verify {folder}");
            let _ = writeln!(text, "  draw it     cosfly preview {folder}");
            if let Some(log) = first_log(out) {
                let _ = writeln!(text, "  look at it  {} (Foxglove, Rerun)", log.display());
            }
        }
        None => {
            let next = match delivery.summary.outcome {
                RunOutcome::Failed => "correct the errors above and run the same command again",
                RunOutcome::Complete | RunOutcome::Cancelled => "run the same command to continue",
            };
            let _ = writeln!(
                text,
                "`{wanted}` is not finished after {took}; finished items are kept in {}: {next}",
                store.display()
            );
        }
    }
    text
}

/// First sensor log of the dataset, to look at.
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

/// Summary and result for programs.
fn json(recipe: &Recipe, delivery: &Delivery, out: &Path, took: Duration) -> String {
    let run = &delivery.summary;
    let stages: Vec<serde_json::Value> = run
        .stages
        .iter()
        .enumerate()
        .map(|(index, stage)| {
            serde_json::json!({
                "stage": stage.name.as_str(), "items": stage.total, "cached": stage.cached, "ran": stage.ran,
                "reused": stage.reused, "failed": stage.failed, "skipped": stage.skipped, "unfinished": stage.unfinished,
                "not_needed": stage.not_needed,
                "digest": digest_of(run, index).to_string(),
            })
        })
        .collect();
    let rejected: Vec<serde_json::Value> = run
        .rejections()
        .map(|(ItemId { stage, item }, RejectionReason { reason, .. })| {
            serde_json::json!({ "stage": stage.as_str(), "item": item.to_string(), "reason": reason })
        })
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
        "seconds": took.as_secs_f64(),
        "core_seconds": run.processor_s,
    });
    serde_json::to_string_pretty(&whole).expect("a summary is plain JSON") + "\n"
}

/// Digest over the outputs of all finished items of a stage: equal exactly when all their bytes are equal.
fn digest_of(run: &RunSummary, stage: usize) -> Digest {
    let mut lines = String::new();
    for (item, finished) in run.finished_items(stage) {
        for (name, blob) in finished.record.outputs.iter() {
            let _ = writeln!(lines, "{item}/{name} {}", blob.digest);
        }
    }
    Digest::of(lines.as_bytes())
}
