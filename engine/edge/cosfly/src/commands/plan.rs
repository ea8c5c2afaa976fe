//! `cosfly plan`: items of each stage, cached ones, those that would run and why, predicted size.

use crate::arguments::{RecipeArguments, StoreArguments};
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use crate::text::{bytes, count};
use clap::Parser;
use cosfly_runner::{Plan, Reason};
use serde_json::json;
use std::fmt::Write;

/// Show the DAG of a recipe: items per stage, what is cached, what would run and why, predicted size
#[derive(Debug, Parser)]
#[command(name = "plan")]
pub struct Arguments {
    #[command(flatten)]
    recipe: RecipeArguments,
    #[command(flatten)]
    store: StoreArguments,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let recipe = self.recipe.load(console)?;
        let store = self.store.open_to_read()?;
        let plan = cosfly_runner::plan(&recipe, &store)?;
        console.print(&if self.json { json(&plan) } else { table(&plan) })?;
        Ok(exit::SUCCESS)
    }
}

/// The plan for programs.
fn json(plan: &Plan<'_>) -> String {
    let stages = plan.stages.iter().map(|stage| {
        let reasons =
            stage.reasons.iter().map(|(reason, items)| json!({ "reason": reason.to_string(), "items": items }));
        json!({
            "stage": stage.name.as_str(), "uses": stage.kind, "items": stage.items(), "cached": stage.cached(),
            "to_run": stage.to_run(), "predicted_bytes": stage.predicted_bytes, "reasons": reasons.collect::<Vec<_>>(),
        })
    });
    let predicted: u64 = plan.stages.iter().map(|stage| stage.predicted_bytes).sum();
    let whole = json!({ "to_run": plan.to_run(), "predicted_bytes": predicted, "stages": stages.collect::<Vec<_>>() });
    format!("{whole:#}\n")
}

/// Text of a plan: aligned columns, with the reasons below each stage that has items to run.
fn table(plan: &Plan<'_>) -> String {
    let names = plan.stages.iter().map(|stage| stage.name.as_str().len()).max().unwrap_or(0).max("stage".len());
    let kinds = plan.stages.iter().map(|stage| stage.kind.len()).max().unwrap_or(0).max("uses".len());
    let shared = shared_reason(plan);
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{:names$}  {:kinds$}  {:>7}  {:>7}  {:>7}  predicted",
        "stage", "uses", "items", "cached", "to run"
    );
    for stage in &plan.stages {
        let predicted =
            if stage.to_run() == 0 { "-".to_owned() } else { format!("about {}", bytes(stage.predicted_bytes)) };
        let _ = writeln!(
            text,
            "{:names$}  {:kinds$}  {:>7}  {:>7}  {:>7}  {predicted}",
            stage.name,
            stage.kind,
            stage.items(),
            stage.cached(),
            stage.to_run(),
        );
        if shared.is_none() {
            for (reason, items) in &stage.reasons {
                let _ = writeln!(text, "{:names$}  because {reason} ({})", "", count(*items, "item"));
            }
        }
    }
    let written = bytes(plan.stages.iter().map(|stage| stage.predicted_bytes).sum());
    let mut reasons = plan.stages.iter().flat_map(|stage| &stage.reasons);
    let is_bound = reasons.any(|(reason, _)| matches!(reason, Reason::Upstream(_)));
    let _ = match (plan.to_run(), shared) {
        (0, _) => writeln!(text, "\nEverything is cached."),
        (left, _) if is_bound => writeln!(
            text,
            "\nAt most {} would run: items whose inputs turn out as they were are kept. At most about {written} would be written.",
            count(left, "task"),
        ),
        (left, shared) => writeln!(
            text,
            "\n{} would run{}; about {written} would be written.",
            count(left, "task"),
            shared.map_or(String::new(), |reason| format!(", because {reason}")),
        ),
    };
    text
}

/// The one reason for everything that would run, where there is only one (such as a first run).
fn shared_reason(plan: &Plan<'_>) -> Option<String> {
    let mut reasons: Vec<String> =
        plan.stages.iter().flat_map(|stage| &stage.reasons).map(|(reason, _)| reason.to_string()).collect();
    let several = reasons.len() > 1;
    reasons.dedup();
    if several && reasons.len() == 1 { reasons.pop() } else { None }
}
