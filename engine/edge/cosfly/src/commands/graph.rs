//! `cosfly graph`: the DAG as a drawing.

use crate::arguments::RecipeArguments;
use crate::command::{Command, Outcome};
use crate::exit;
use crate::output::print;
use clap::{Parser, ValueEnum};
use cosfly_recipe::Format;

/// Print the DAG as a Mermaid or DOT drawing
#[derive(Debug, Parser)]
#[command(name = "graph")]
pub struct Arguments {
    #[command(flatten)]
    recipe: RecipeArguments,
    /// Language of the drawing
    #[arg(long, value_enum, default_value_t = GraphFormat::Mermaid)]
    format: GraphFormat,
}

/// Languages of drawings.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum GraphFormat {
    /// For Markdown pages
    Mermaid,
    /// For Graphviz
    Dot,
}

impl Command for Arguments {
    fn run(&self) -> Outcome {
        let recipe = self.recipe.load()?;
        let format = match self.format {
            GraphFormat::Mermaid => Format::Mermaid,
            GraphFormat::Dot => Format::Dot,
        };
        print(&cosfly_recipe::graph(&recipe, format))?;
        Ok(exit::SUCCESS)
    }
}
