//! `cosfly graph`: the DAG as a drawing.

use super::{Outcome, recipe};
use crate::arguments::{GraphArguments, GraphFormat};
use crate::exit;
use cosfly_recipe::Format;

/// Prints the drawing.
pub fn graph(arguments: &GraphArguments) -> Outcome {
    let recipe = recipe(&arguments.recipe)?;
    let format = match arguments.format {
        GraphFormat::Mermaid => Format::Mermaid,
        GraphFormat::Dot => Format::Dot,
    };
    crate::print(&cosfly_recipe::graph(&recipe, format))?;
    Ok(exit::SUCCESS)
}
