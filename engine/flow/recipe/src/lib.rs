//! From TOML text to a checked DAG of stages.
//!
//! * [`load`], [`read`]: the way in; a [`Recipe`] or all that is wrong with it.
//! * `toml_text` -> `document`: the text as a tree that remembers places; `overrides` puts `--set` into it.
//! * `outline` -> `kinds` -> `wiring` -> `order` -> `sources` -> `items`: the checks, in this order.
//! * `parameters`: a stage's parameters against the JSON Schema of its kind.
//! * [`schema`], [`reference`], [`graph`]: what editors, the book and people look at.

mod document;
mod drawing;
mod items;
mod kinds;
mod load;
mod model;
mod order;
mod outline;
mod overrides;
mod parameters;
mod reference;
mod schema;
mod sources;
mod toml_text;
mod wiring;

pub use drawing::{Format, graph};
pub use load::{load, read};
pub use model::{Arrival, Connection, ItemIds, Recipe, RecipeStage, SourceFile};
pub use reference::reference;
pub use schema::schema;
