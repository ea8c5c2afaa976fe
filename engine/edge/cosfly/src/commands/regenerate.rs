//! `cosfly verify --regenerate`: flights made anew and compared with what was published.

use super::{Refusals, store_dir};
use crate::arguments::VerifyArguments;
use crate::interrupt;
use crate::text::count;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_fingerprint::Digest;
use cosfly_recipe::Recipe;
use cosfly_store::VERSION_FILE;
use cosfly_versions::{regenerate, shelf};
use std::fmt::Write;

/// What was made anew and whether it is the same, in words; the number of flights that are not.
pub fn regenerated(arguments: &VerifyArguments, number: usize) -> Result<(String, usize), Refusals> {
    let recipe = recipe_of(arguments)?;
    let scratch = tempfile::tempdir()
        .map_err(|error| vec![Diagnostic::io("make a folder for a store to make flights anew in", &error)])?;
    let store = scratch.path().join("store");
    let found = regenerate(&arguments.dir, number, &recipe, &cosfly_stages::registry(), &store, &interrupt::flag())
        .map_err(|refusal| vec![refusal])?;
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

/// The recipe that was given, or that of the named version whose files these are.
fn recipe_of(arguments: &VerifyArguments) -> Result<Recipe, Refusals> {
    let registry = cosfly_stages::registry();
    if let Some(path) = &arguments.recipe {
        return cosfly_recipe::load(path, &arguments.overrides, &registry);
    }
    let marker = std::fs::read_to_string(arguments.dir.join(VERSION_FILE)).unwrap_or_default();
    let content: Option<Digest> = marker.lines().next().and_then(|line| line.parse().ok());
    let version = content.map(|content| shelf::of_content(&store_dir(&arguments.store), &content)).transpose();
    match version.map_err(|refusal| vec![refusal])?.flatten() {
        Some(version) => {
            let recipe = &version.recipe;
            cosfly_recipe::read(&recipe.path, &recipe.text, &recipe.overrides, &registry)
        }
        None => {
            let message = format!("no named version has the files of `{}`", arguments.dir.display());
            Err(vec![
                Diagnostic::new("regenerate-no-recipe", Fault::Recipe, message)
                    .hint("give the recipe that made it: `--recipe RECIPE`, with the same `--set`"),
            ])
        }
    }
}
