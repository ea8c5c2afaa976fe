//! The graph of a recipe as Mermaid (for Markdown pages) or DOT (for Graphviz).

use crate::model::{Recipe, RecipeStage};
use std::fmt::Write;

/// Language of a graph drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawingFormat {
    /// <https://mermaid.js.org>, drawn by GitHub and mdBook.
    Mermaid,
    /// <https://graphviz.org>.
    Dot,
}

/// Text of the drawing of a recipe's stages and connections. Edges carry the port's name where it differs from the
/// stage's.
pub fn graph(recipe: &Recipe, format: DrawingFormat) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = match format {
        DrawingFormat::Mermaid => mermaid(recipe, &mut text),
        DrawingFormat::Dot => dot(recipe, &mut text),
    };
    text
}

fn mermaid(recipe: &Recipe, text: &mut String) -> std::fmt::Result {
    writeln!(text, "flowchart TD")?;
    for (index, stage) in recipe.stages.iter().enumerate() {
        writeln!(text, "    s{index}[\"{}<br/>{}\"]", stage.name, second_line(stage))?;
    }
    for edge in edges(recipe) {
        let label = edge.label.map_or_else(String::new, |label| format!("|{label}|"));
        writeln!(text, "    s{} -->{label} s{}", edge.from, edge.to)?;
    }
    Ok(())
}

fn dot(recipe: &Recipe, text: &mut String) -> std::fmt::Result {
    writeln!(text, "digraph \"{}\" {{", recipe.name)?;
    writeln!(text, "    rankdir=TB;")?;
    writeln!(text, "    node [shape=box, style=rounded, fontname=\"sans-serif\"];")?;
    writeln!(text, "    edge [fontname=\"sans-serif\", fontsize=10];")?;
    for stage in &recipe.stages {
        writeln!(text, "    \"{}\" [label=\"{}\\n{}\"];", stage.name, stage.name, second_line(stage))?;
    }
    for edge in edges(recipe) {
        let label = edge.label.map_or_else(String::new, |label| format!(" [label=\"{label}\"]"));
        writeln!(text, "    \"{}\" -> \"{}\"{label};", recipe.stages[edge.from].name, recipe.stages[edge.to].name)?;
    }
    writeln!(text, "}}")
}

fn second_line(stage: &RecipeStage) -> String {
    let items = stage.items.len();
    format!("{}, {items} item{}", stage.kind, if items == 1 { "" } else { "s" })
}

struct Edge<'a> {
    from: usize,
    to: usize,
    label: Option<&'a str>,
}

fn edges(recipe: &Recipe) -> impl Iterator<Item = Edge<'_>> {
    recipe.stages.iter().enumerate().flat_map(move |(to, stage)| {
        stage.connections.iter().flat_map(move |connection| {
            connection.upstreams.iter().map(move |from| {
                let port = connection.port.name;
                Edge { from: *from, to, label: (recipe.stages[*from].name != *port).then_some(port) }
            })
        })
    })
}
