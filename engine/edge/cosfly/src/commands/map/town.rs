//! Towns of map files for commands, read with parameters of the stage `map`.

use super::own_recipe::{Written, read_own};
use crate::command::Refusals;
use cosfly_experts::map_files::{ReadMap, read_map};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The town for a command; the parameters, such as `fill.trees=true`, are checked as those of a recipe.
pub fn read(command: &str, file: &Path, parameters: &[String]) -> Result<ReadMap, Refusals> {
    // TOML and JSON write strings alike.
    let file = Value::from(file.to_string_lossy().as_ref());
    let recipe = format!("name = \"map\"\n\n[stages.map]\nuse = \"map\"\nsource = {file}\n");
    let changes: Vec<String> = parameters.iter().map(|change| format!("stages.map.{change}")).collect();
    let written: Vec<Written<'_>> = parameters.iter().map(|change| ("--set", change.as_str())).collect();
    let recipe = read_own(command, &recipe, &changes, &written)?;
    let stage = &recipe.stages[0];
    let files: Vec<PathBuf> = stage.sources.iter().map(|source| source.path.clone()).collect();
    Ok(read_map(stage.parameters.clone(), &files)?)
}
