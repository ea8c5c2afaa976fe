//! `cosfly dataset tag`: a name for what the store holds of a recipe's dataset.

use super::version_line::line;
use crate::arguments::{RecipeArguments, StoreArguments};
use crate::command::{Command, Outcome};
use crate::console::Console;
use crate::exit;
use clap::Parser;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_recipe::Recipe;
use cosfly_stage::ItemId;
use cosfly_store::{Store, pin};
use cosfly_versions::{Version, difference, record, shelf};
use std::fmt::Write;
use std::path::Path;

/// Give a name to what the store holds of a recipe's dataset, and keep it from `cosfly gc`
#[derive(Debug, Parser)]
#[command(
    name = "tag",
    after_help = "\
Example:
  cosfly dataset tag v1.0.0 recipes/carla_town.toml

A version is a manifest in the store's folder `versions`: hash and size of every file, the exact recipe with its `--set`,
the version of cosfly, the hashes of plugins and of all files that the recipe reads, and the keys of the tasks behind
every flight. Patch: the same records, packed in another way. Minor: old records unchanged. Major: records changed,
went, or moved to another split."
)]
pub struct Arguments {
    /// Name of the version, such as v1.0.0
    #[arg(value_name = "NAME")]
    name: String,
    #[command(flatten)]
    recipe: RecipeArguments,
    #[command(flatten)]
    store: StoreArguments,
}

impl Command for Arguments {
    fn run(&self, console: &dyn Console) -> Outcome {
        let recipe = self.recipe.load(console)?;
        console.print(&tagged(self, &recipe, &self.store.with_versions()?)?)?;
        Ok(exit::SUCCESS)
    }
}

fn tagged(arguments: &Arguments, recipe: &Recipe, root: &Path) -> Result<String> {
    let version = {
        let store = arguments.store.open()?;
        let version = record(&arguments.name, recipe, &arguments.recipe.overrides, &store, env!("CARGO_PKG_VERSION"))?;
        check_newest(recipe, &store, &version)?;
        version
    };
    let notes = notes_against_earlier(root, &version)?;
    pin(root, &cosfly_runner::recipe_id(recipe), &format!("version-{}", version.name))?;
    shelf::put(root, &version)?;
    if arguments.store.bucket().is_some() {
        let names = [format!("pins/version-{}", version.name), format!("versions/{}.json", version.name)];
        arguments.store.open()?.upload_files(&names)?;
    }
    Ok(line(&version) + &notes)
}

/// Notes on earlier versions of the dataset whose numbers do not tell what changed since. One version at a time is in memory.
fn notes_against_earlier(root: &Path, version: &Version) -> Result<String> {
    let mut text = String::new();
    for old in shelf::all(root)? {
        let old = old?;
        if old.dataset != version.dataset || old.content == version.content {
            continue;
        }
        let bump = difference(&old, version).bump();
        if !bump.is_kept(&old.dataset_version, &version.dataset_version) {
            let _ = writeln!(
                text,
                "note: against `{}` this is a {} change, but {} follows {}: set `version` of the dataset stage",
                old.name,
                bump.name(),
                version.dataset_version,
                old.dataset_version
            );
        }
    }
    Ok(text)
}

/// Garbage collection keeps a version by the run that made it, which must be the newest one.
fn check_newest(recipe: &Recipe, store: &Store, version: &Version) -> Result<()> {
    let newest = store.past_runs(&cosfly_runner::recipe_id(recipe)).next();
    let holds = |task: &ItemId, key: Digest| {
        (*newest.as_ref()?.stage(task.stage.as_str())?.items.get(&task.item.to_string())? == key).then_some(())
    };
    let is_newest = version
        .flights
        .values()
        .all(|flight| version.tasks.get(&flight.task).is_some_and(|task| holds(&flight.task, task.key).is_some()));
    if is_newest {
        return Ok(());
    }
    let message = format!("the newest run of recipe `{}` made something else", recipe.name);
    Err(Diagnostic::new("version-not-newest", Fault::Recipe, message)
        .hint("run it again as it is to be tagged: everything is in the store, nothing is computed"))
}
