//! `cosfly schema`: the generated schema and reference pages.

use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use clap::Parser;

/// Print the recipe's JSON Schema, or a generated reference page
#[derive(Debug, Parser)]
#[command(
    name = "schema",
    after_help = "\
Examples:
  cosfly schema > recipe.schema.json                  for editors: completion and checks of recipes
  cosfly schema --reference > recipe.md
  cosfly schema --tables > tables.md"
)]
pub struct Arguments {
    /// Print the recipe reference as Markdown
    #[arg(long, conflicts_with = "tables")]
    reference: bool,
    /// Print the tables and channels of a dataset as Markdown
    #[arg(long)]
    tables: bool,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let registry = cosfly_stages::registry();
        let text = if self.tables {
            cosfly_schema::reference()
        } else if self.reference {
            cosfly_recipe::reference(&registry)
        } else {
            let schema = cosfly_recipe::schema(&registry);
            serde_json::to_string_pretty(&schema).expect("a schema is plain JSON") + "\n"
        };
        console.print(&text)?;
        Ok(exit::SUCCESS)
    }
}
