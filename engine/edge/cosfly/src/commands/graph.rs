//! `cosfly graph`: the DAG as a drawing.

use crate::arguments::RecipeArguments;
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use clap::{Parser, ValueEnum};
use cosfly_recipe::DrawingFormat;

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
    fn run(&self, console: &dyn Console) -> Outcome {
        let recipe = self.recipe.load(console)?;
        let format = match self.format {
            GraphFormat::Mermaid => DrawingFormat::Mermaid,
            GraphFormat::Dot => DrawingFormat::Dot,
        };
        console.print(&cosfly_recipe::graph(&recipe, format))?;
        Ok(exit::SUCCESS)
    }
}
