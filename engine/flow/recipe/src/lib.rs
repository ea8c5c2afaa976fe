//! From TOML text to a checked DAG of stages.

mod model;

pub use model::{Arrival, Connection, ItemIds, Recipe, RecipeStage, SourceFile};
