//! Recipes of files, with all kinds of stages that ship.

use cosfly_diagnose::Diagnostic;
use cosfly_recipe::Recipe;
use std::path::Path;

/// The recipe of a file, or of a folder with a `recipe.toml`, with changes, `PATH=VALUE` each.
///
/// # Errors
/// All errors of the recipe.
pub fn load(path: &Path, changes: &[String]) -> Result<Recipe, Vec<Box<Diagnostic>>> {
    let path = if path.is_dir() { path.join("recipe.toml") } else { path.to_owned() };
    cosfly_recipe::load(&path, changes, &cosfly_stages::registry())
}
