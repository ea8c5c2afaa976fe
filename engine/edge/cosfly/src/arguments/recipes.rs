//! Commands over a recipe: run, plan, ask why, draw, go on from a state.

use super::{RecipeArguments, StoreArguments};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Arguments of `run`.
#[derive(Args, Debug)]
pub struct RunArguments {
    #[command(flatten)]
    pub recipe: RecipeArguments,
    #[command(flatten)]
    pub store: StoreArguments,
    /// Folder for the dataset [default: out/<recipe name>]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Tasks at the same time [default: one per core]
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Print the summary as JSON
    #[arg(long)]
    pub json: bool,
    /// Print errors and the last line only
    #[arg(long, short)]
    pub quiet: bool,
}

/// Arguments of `plan`.
#[derive(Args, Debug)]
pub struct PlanArguments {
    #[command(flatten)]
    pub recipe: RecipeArguments,
    #[command(flatten)]
    pub store: StoreArguments,
}

/// Arguments of `plan-from`.
#[derive(Args, Debug)]
pub struct PlanFromArguments {
    #[command(flatten)]
    pub recipe: RecipeArguments,
    #[command(flatten)]
    pub store: StoreArguments,
    /// The trajectory that the drone left, such as expert-p00000; of a twin, its expert answers
    #[arg(long, value_name = "ID", required_unless_present = "batch")]
    pub trajectory: Option<String>,
    /// Frame of the trajectory at which the drone is there
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = from_zero, required_unless_present = "batch")]
    pub frame: Option<usize>,
    /// Where the drone is, metres
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, required_unless_present = "batch")]
    pub position: Option<Vec<f64>>,
    /// How it moves, m/s
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, default_values_t = [0.0, 0.0, 0.0], hide_default_value = true)]
    pub velocity: Vec<f64>,
    /// How much of the way to tell [default: to the trajectory's end]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub horizon: Option<f64>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Read states from standard input, one JSON object per line, and answer each with one line of JSON
    #[arg(long, conflicts_with_all = ["trajectory", "frame", "position", "velocity", "horizon"])]
    pub batch: bool,
}

/// Arguments of `why`.
#[derive(Args, Debug)]
pub struct WhyArguments {
    #[command(flatten)]
    pub recipe: RecipeArguments,
    /// A stage, or one of its items
    #[arg(value_name = "STAGE[/ITEM]")]
    pub subject: String,
    #[command(flatten)]
    pub store: StoreArguments,
}

/// Arguments of `graph`.
#[derive(Args, Debug)]
pub struct GraphArguments {
    #[command(flatten)]
    pub recipe: RecipeArguments,
    /// Language of the drawing
    #[arg(long, value_enum, default_value_t = GraphFormat::Mermaid)]
    pub format: GraphFormat,
}

/// Languages of drawings.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum GraphFormat {
    /// For Markdown pages
    Mermaid,
    /// For Graphviz
    Dot,
}

/// Counts of things that are numbered from 0.
fn from_zero(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| "it must be a whole number from 0 on".to_owned())
}
