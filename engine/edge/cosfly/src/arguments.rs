//! Arguments that several commands have: the recipe, the store, values in a range.

use crate::command::Refusals;
use crate::console::Console;
use clap::Args;
use clap::builder::TypedValueParser;
use cosfly_diagnose::Diagnostic;
use cosfly_recipe::Recipe;
use std::path::{Path, PathBuf};

/// A recipe with changes to it.
#[derive(Args, Clone, Debug)]
pub struct RecipeArguments {
    /// The recipe (TOML), or a folder with a recipe.toml; - for standard input, with files relative to the current folder
    #[arg(value_name = "RECIPE")]
    pub recipe: PathBuf,
    /// Change a value of the recipe, such as stages.expert.weights.visibility=5 (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub overrides: Vec<String>,
}

impl RecipeArguments {
    /// The checked recipe with its changes.
    ///
    /// # Errors
    /// All errors of the recipe.
    pub fn load(&self, console: &dyn Console) -> Result<Recipe, Refusals> {
        let registry = cosfly_stages::registry();
        if self.recipe != Path::new("-") {
            let path = if self.recipe.is_dir() { self.recipe.join("recipe.toml") } else { self.recipe.clone() };
            return Ok(cosfly_recipe::load(&path, &self.overrides, &registry)?);
        }
        let mut text = String::new();
        let read = console.input().read_to_string(&mut text);
        read.map_err(|error| Diagnostic::io("read standard input", &error))?;
        Ok(cosfly_recipe::read(Path::new("standard input"), &text, &self.overrides, &registry)?)
    }
}

/// Place of the store.
#[derive(Args, Clone, Debug)]
pub struct StoreArguments {
    /// Folder of the store [default: $COSFLY_STORE, else .cosfly in the current folder]
    #[arg(long, value_name = "DIR", env = "COSFLY_STORE", hide_env = true)]
    pub store: Option<PathBuf>,
}

impl StoreArguments {
    /// The store's folder.
    pub fn folder(&self) -> PathBuf {
        self.store.clone().unwrap_or_else(|| PathBuf::from(".cosfly"))
    }
}

/// Whole numbers from 1 to a million.
pub fn count() -> impl TypedValueParser<Value = usize> {
    clap::value_parser!(u64).range(1..=1_000_000).map(|count| count as usize)
}

/// Machines that run the tasks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Place {
    /// This machine
    Local,
    /// Workers of a HyperQueue server
    Hq,
    /// None: print the commands as JSON lines
    Emit,
}

/// Tasks on other machines.
#[derive(Args, Clone, Debug)]
pub struct ClusterArguments {
    /// Machines that run the tasks; the store must be at the same place on all of them
    #[arg(long, value_name = "PLACE", value_enum, default_value_t = Place::Local)]
    pub on: Place,
    /// Resources of the tasks of a stage (* for all), such as frames:cpus=4,memory=8GB,time=2h,gpus=1,batch=1 (repeatable)
    #[arg(long, value_name = "STAGE:RESOURCES")]
    pub request: Vec<String>,
    /// Command that starts cosfly on other machines, such as "apptainer exec cosfly.sif cosfly" [default: this program's path]
    #[arg(long, value_name = "COMMAND")]
    pub leaf: Option<String>,
}
