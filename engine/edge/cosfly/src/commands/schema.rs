//! `cosfly schema`: the generated schema and reference pages.

use super::Outcome;
use crate::arguments::SchemaArguments;
use crate::exit;

/// Prints the recipe's JSON Schema, or a page of the book.
pub fn schema(arguments: &SchemaArguments) -> Outcome {
    let registry = cosfly_stages::registry();
    let text = if arguments.tables {
        cosfly_schema::reference()
    } else if arguments.reference {
        cosfly_recipe::reference(&registry)
    } else {
        let schema = cosfly_recipe::schema(&registry);
        serde_json::to_string_pretty(&schema).expect("a schema is plain JSON") + "\n"
    };
    crate::print(&text)?;
    Ok(exit::SUCCESS)
}
