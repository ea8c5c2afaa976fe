//! One file per command.

pub mod carla_job;
pub mod collect;
pub mod dataset_lint;
pub mod dataset_versions;
pub mod doctor;
pub mod drone_state;
pub mod eval;
pub mod expert_of_recipe;
pub mod export;
pub mod graph;
pub mod plan;
pub mod plan_from;
#[cfg(feature = "plugins")]
pub mod plugin_bench;
#[cfg(feature = "plugins")]
pub mod plugin_check;
#[cfg(feature = "plugins")]
pub mod plugin_new;
pub mod preview;
pub mod regenerate;
pub mod run;
pub mod schema;
pub mod task;
pub mod town;
pub mod verify;
pub mod why;

use crate::arguments::{RecipeArguments, StoreArguments};
use cosfly_diagnose::Diagnostic;
use cosfly_recipe::Recipe;
use std::path::PathBuf;

/// Everything that can be wrong with a command, at least one.
pub type Refusals = Vec<Box<Diagnostic>>;

/// Where a command stops: nothing to report, or an exit code of its own.
pub type Outcome = Result<u8, Refusals>;

/// The checked recipe with its `--set` changes.
fn recipe(arguments: &RecipeArguments) -> Result<Recipe, Refusals> {
    cosfly_recipe::load(&arguments.recipe, &arguments.overrides, &cosfly_stages::registry())
}

/// The store's folder.
fn store_dir(arguments: &StoreArguments) -> PathBuf {
    arguments.store.clone().unwrap_or_else(|| PathBuf::from(".cosfly"))
}
