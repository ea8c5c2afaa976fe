//! `cosfly why`: the parameter or input that changed a key.

use crate::arguments::{RecipeArguments, StoreArguments};
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use clap::Parser;
use cosfly_runner::Explanation;
use serde_json::json;
use std::fmt::Write;

/// Say which field or input changed since a stage or an item was last made
#[derive(Debug, Parser)]
#[command(
    name = "why",
    after_help = "\
Examples:
  cosfly why recipes/carla_town.toml expert
  cosfly why recipes/carla_town.toml frames/expert-p00003"
)]
pub struct Arguments {
    #[command(flatten)]
    recipe: RecipeArguments,
    /// A stage, or one of its items
    #[arg(value_name = "STAGE[/ITEM]")]
    subject: String,
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
        let (stage, item) = match self.subject.split_once('/') {
            Some((stage, item)) => (stage, Some(item)),
            None => (self.subject.as_str(), None),
        };
        let explanation = cosfly_runner::why(&recipe, &store, stage, item)?;
        console.print(&if self.json { json(&explanation) } else { told(&explanation) })?;
        Ok(exit::SUCCESS)
    }
}

/// The explanation for programs.
fn json(explanation: &Explanation) -> String {
    let chain = explanation.chain.iter().map(|link| {
        let changes: Vec<String> = link.changes.iter().map(ToString::to_string).collect();
        json!({ "task": link.id.to_string(), "changes": changes })
    });
    let whole = json!({
        "task": explanation.id.to_string(), "cached": explanation.finished,
        "needed": explanation.needed, "chain": chain.collect::<Vec<_>>(),
    });
    format!("{whole:#}\n")
}

/// Text of an explanation: the chain from the task to the root cause, one indentation per step upstream.
fn told(explanation: &Explanation) -> String {
    let subject = &explanation.id;
    let mut text = match (explanation.finished, explanation.chain.is_empty()) {
        (true, true) => format!("`{subject}` is cached; nothing has changed since it was first made\n"),
        (true, false) => format!("`{subject}` is cached; the last time it was made, it was because\n"),
        (false, _) if !explanation.needed => {
            format!("`{subject}` would not run: everything that is made of it is finished; it is not cached, because\n")
        }
        (false, _) => format!("`{subject}` would run, because\n"),
    };
    for (depth, link) in explanation.chain.iter().enumerate() {
        let indent = "  ".repeat(depth + 1);
        for change in &link.changes {
            let _ = writeln!(text, "{indent}{}: {change}", link.id);
        }
    }
    text
}
