//! Reads TOML recipes into checked graphs of stages.
//!
//! * [`load`], [`read`]: the entry points; a [`Recipe`], or all errors in it.
//! * `toml_text` -> `document`: the text as a tree with places; `overrides` applies `--set` to it,
//!   `for_each` writes out the stages of lists.
//! * `outline` -> `kinds` -> `wiring` -> `order` -> `sources` -> `items`: the checks, in this order.
//! * `parameters`: the parameters of a stage against the JSON Schema of its kind.
//! * [`table`]: tables in TOML that are no recipes.
//! * [`schema`], [`reference`], [`graph`]: schema for editors, reference page, drawing of the graph.

mod document;
mod drawing;
mod for_each;
mod groups;
mod items;
mod kinds;
mod load;
mod model;
mod needs;
mod order;
mod outline;
mod overrides;
mod parameters;
mod plain;
mod reference;
mod schema;
mod sources;
mod toml_text;
mod wiring;

pub use drawing::{DrawingFormat, graph};
pub use load::{load, read};
pub use model::{Arrival, Connection, ItemNames, Recipe, RecipeStage, SourceFile};
pub use plain::table;
pub use reference::reference;
pub use schema::schema;
