//! `cosfly verify --regenerate`: flights made again and compared with the published ones.

use crate::command::Refusals;
use crate::console::Console;
use crate::text::count;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_recipe::Recipe;
use cosfly_store::VERSION_FILE;
use cosfly_versions::{regenerate, shelf};
use std::fmt::Write;
use std::path::Path;

/// Makes `number` flights of the dataset in `dir` again from `recipe`, in an empty store. Returns a text about them and the
/// number of flights that differ.
///
/// # Errors
/// Those of the dataset, the recipe and its stages, and the machine.
pub fn regenerated(dir: &Path, number: usize, recipe: &Recipe, console: &dyn Console) -> Result<(String, usize)> {
    let scratch = tempfile::tempdir()
        .map_err(|error| Diagnostic::io("make a folder for the store of regenerated flights", &error))?;
    let store = scratch.path().join("store");
    let _deadline = console.deadline(Some(scratch.path()));
    let found = regenerate(dir, number, recipe, &cosfly_stages::registry(), &store, &console.cancelled())?;
    let mut text = String::new();
    for flight in &found {
        if let Some(problem) = &flight.problem {
            let _ = writeln!(text, "{}, `{}`: {problem} [verify-regenerate]", flight.mcap_path, flight.trajectory_id);
        }
    }
    let wrong = found.iter().filter(|flight| flight.problem.is_some()).count();
    let _ = writeln!(
        text,
        "made {} anew from recipe `{}`: {} the same, byte by byte",
        count(found.len() as u64, "flight"),
        recipe.name,
        found.len() - wrong
    );
    Ok((text, wrong))
}

/// The recipe of the named version in `store` that has the files of the dataset in `dir`.
///
/// # Errors
/// `regenerate-no-recipe` where there is none, and the errors of the recipe.
pub fn recipe_of_version(dir: &Path, store: &Path) -> Result<Recipe, Refusals> {
    let marker = std::fs::read_to_string(dir.join(VERSION_FILE)).unwrap_or_default();
    let content: Option<Digest> = marker.lines().next().and_then(|line| line.parse().ok());
    let version = content.map(|content| shelf::of_content(store, &content)).transpose()?.flatten();
    let recipe = version.map(|version| version.recipe).ok_or_else(|| {
        let message = format!("no named version has the files of `{}`", dir.display());
        Diagnostic::new("regenerate-no-recipe", Fault::Recipe, message)
            .hint("give the recipe that made it: `--recipe RECIPE`, with the same `--set`")
    })?;
    Ok(cosfly_recipe::read(&recipe.path, &recipe.text, &recipe.overrides, &cosfly_stages::registry())?)
}
