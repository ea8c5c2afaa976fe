//! `cosfly plan`: items of each stage, cached ones, those that would run and why, predicted size.

use crate::arguments::{RecipeArguments, StoreArguments};
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use crate::text::{bytes, count, duration};
use clap::Parser;
use cosfly_diagnose::plausible;
use cosfly_recipe::Recipe;
use cosfly_runner::{Plan, PlannedStage, Reason};
use cosfly_stage::Asks;
use serde_json::json;
use std::fmt::Write;
use std::time::Duration;

const SECONDS_PER_HOUR: f64 = 3600.0;

/// Show the DAG of a recipe: items per stage, what is cached, what would run and why, predicted size and time
#[derive(Debug, Parser)]
#[command(
    name = "plan",
    after_help = "\
Time is predicted from tasks measured on this machine, in this store: run a small part of a recipe first.

Examples:
  cosfly plan recipes/carla_town.toml
  cosfly plan recipes/carla_town.toml --set stages.walkers.count=6000 --price 0.04"
)]
pub struct Arguments {
    #[command(flatten)]
    recipe: RecipeArguments,
    #[command(flatten)]
    store: StoreArguments,
    /// Price of a core-hour, in any currency: prints the price of what would run
    #[arg(long, value_name = "MONEY", value_parser = price)]
    price: Option<f64>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

fn price(text: &str) -> Result<f64, String> {
    let price: f64 = text.parse().map_err(|_| "it is not a number".to_owned())?;
    match plausible(price) {
        Ok(price) if price >= 0.0 => Ok(price),
        Ok(_) => Err("it must be at least 0".to_owned()),
        Err(fault) => Err(format!("it {fault}")),
    }
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let recipe = self.recipe.load(console)?;
        let store = self.store.open_to_read()?;
        let plan = cosfly_runner::plan(&recipe, &store)?;
        console.print(&if self.json {
            json(&recipe, &plan, self.price)
        } else {
            table(&plan) + &passing(&recipe, &plan) + &questions(&recipe, &plan) + &cost(&plan, self.price)
        })?;
        Ok(exit::SUCCESS)
    }
}

/// The plan for programs.
fn json(recipe: &Recipe, plan: &Plan<'_>, price: Option<f64>) -> String {
    let stages = plan.stages.iter().map(|stage| {
        let reasons =
            stage.reasons.iter().map(|(reason, items)| json!({ "reason": reason.to_string(), "items": items }));
        let asks = asks(recipe, stage).map(|asks| {
            let (few, many) = (stage.to_run().saturating_mul(asks.questions), stage.to_run().saturating_mul(asks.most_questions));
            json!({
                "questions": few, "most_questions": many, "input_tokens": few.saturating_mul(asks.input_tokens),
                "output_tokens": few.saturating_mul(asks.output_tokens), "price": asks.price(few), "most_price": asks.price(many),
            })
        });
        json!({
            "asks": asks,
            "stage": stage.name.as_str(), "uses": stage.kind, "items": stage.items(), "cached": stage.cached(),
            "to_run": stage.to_run(), "not_needed": stage.not_needed(), "made_again": stage.spent,
            "predicted_core_s": stage.predicted_s, "predicted_bytes": stage.predicted_bytes,
            "predicted_files": stage.predicted_files, "reasons": reasons.collect::<Vec<_>>(),
        })
    });
    let predicted: u64 = plan.stages.iter().map(|stage| stage.predicted_bytes).sum();
    let files: u64 = plan.stages.iter().map(|stage| stage.predicted_files).sum();
    let (core_s, is_whole) = predicted_s(plan);
    let whole = json!({
        "to_run": plan.to_run(), "predicted_bytes": predicted, "predicted_files": files, "predicted_core_s": core_s, "all_measured": is_whole,
        "predicted_price": price.map(|price| price * core_s / SECONDS_PER_HOUR), "stages": stages.collect::<Vec<_>>(),
    });
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
        if stage.not_needed() > 0 {
            let lost = count(stage.not_needed(), "item");
            let _ = writeln!(text, "{:names$}  {lost} not in the store, and not needed: what is made of them is", "");
        }
        if stage.spent > 0 {
            let spent = count(stage.spent, "item");
            let _ = writeln!(text, "{:names$}  {spent} may be made again: intermediate files were removed", "");
        }
        if shared.is_none() {
            for (reason, items) in &stage.reasons {
                let _ = writeln!(text, "{:names$}  because {reason} ({})", "", count(*items, "item"));
            }
        }
    }
    let files = plan.stages.iter().map(|stage| stage.predicted_files).sum();
    let written = bytes(plan.stages.iter().map(|stage| stage.predicted_bytes).sum());
    let written = format!("{written} in {}", count(files, "file"));
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

/// Requests of an item of a stage to a service outside.
fn asks(recipe: &Recipe, stage: &PlannedStage) -> Option<Asks> {
    recipe.stages[recipe.position(stage.name.as_str())?].stage.properties().asks
}

/// Text about requests to services outside; kept answers are not asked for again.
fn questions(recipe: &Recipe, plan: &Plan<'_>) -> String {
    let mut text = String::new();
    for stage in plan.stages.iter().filter(|stage| stage.to_run() > 0) {
        let Some(asks) = asks(recipe, stage) else { continue };
        let (few, many) =
            (stage.to_run().saturating_mul(asks.questions), stage.to_run().saturating_mul(asks.most_questions));
        let _ = write!(
            text,
            "`{}` has {} for its service, at most {many} with repeated ones, less those whose answers are kept: about {} input and {} output tokens",
            stage.name,
            count(few, "question"),
            few.saturating_mul(asks.input_tokens),
            few.saturating_mul(asks.output_tokens),
        );
        if asks.prices != [0.0; 2] {
            let _ = write!(text, ", {} to {}", money(asks.price(few)), money(asks.price(many)));
        }
        text += ".\n";
    }
    text
}

/// Text about bytes that the recipe removes again.
fn passing(recipe: &Recipe, plan: &Plan<'_>) -> String {
    let is_removed = |name: &str| {
        let stage = recipe.position(name).map(|at| &recipe.stages[at]);
        stage.is_some_and(|stage| !stage.stage.properties().intermediate.is_empty())
    };
    let removed = plan.stages.iter().filter(|stage| recipe.remove_intermediates && is_removed(stage.name.as_str()));
    match removed.map(|stage| stage.predicted_bytes).sum() {
        0 => String::new(),
        removed => format!(
            "About {} of them are intermediate and are removed as soon as what is made of them is finished.\n",
            bytes(removed)
        ),
    }
}

/// Time of everything that would run, core-seconds, and whether all of its stages were ever measured.
fn predicted_s(plan: &Plan<'_>) -> (f64, bool) {
    let to_run: Vec<Option<f64>> =
        plan.stages.iter().filter(|stage| stage.to_run() > 0).map(|stage| stage.predicted_s).collect();
    // A sum of nothing is -0.0.
    (0.0 + to_run.iter().flatten().sum::<f64>(), to_run.iter().all(Option::is_some))
}

/// Text about time and money.
fn cost(plan: &Plan<'_>, price: Option<f64>) -> String {
    let (core_s, is_whole) = predicted_s(plan);
    if plan.to_run() == 0 || (core_s == 0.0 && !is_whole) {
        return String::new();
    }
    let mut text = format!("About {} on one core", duration(Duration::from_secs_f64(core_s)));
    if let Some(price) = price {
        let _ = write!(text, ", {} at {price} per core-hour", money(price * core_s / SECONDS_PER_HOUR));
    }
    let unmeasured = plan.stages.iter().filter(|stage| stage.to_run() > 0 && stage.predicted_s.is_none());
    let names: Vec<String> = unmeasured.map(|stage| format!("`{}`", stage.name)).collect();
    let rest = if is_whole { String::new() } else { format!("; without {}, never measured here", names.join(", ")) };
    text + &rest + ".\n"
}

/// An amount with two decimals, or with two significant digits where it is small.
fn money(amount: f64) -> String {
    if amount == 0.0 || amount >= 0.1 { format!("{amount:.2}") } else { format!("{amount:.1e}") }
}

/// The one reason for everything that would run, where there is only one (such as a first run).
fn shared_reason(plan: &Plan<'_>) -> Option<String> {
    let mut reasons: Vec<String> =
        plan.stages.iter().flat_map(|stage| &stage.reasons).map(|(reason, _)| reason.to_string()).collect();
    let several = reasons.len() > 1;
    reasons.dedup();
    if several && reasons.len() == 1 { reasons.pop() } else { None }
}
