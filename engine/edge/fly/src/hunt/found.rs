//! The suite of the failures that were found, and a recipe of training data around them.

use super::pool::Pool;
use super::search::by_part;
use super::toml_text::{text, toml};
use crate::suite::follows;
use cosfly_recipe::{Connection, Recipe, RecipeStage};
use cosfly_stage::PortSource;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Component, Path, PathBuf};

/// Most draws whose worlds the training data have.
const MOST_WORLDS: usize = 4;

/// Path of a file as seen from a folder; both absolute.
pub fn beside(folder: &Path, file: &Path) -> PathBuf {
    let (folder, file): (Vec<Component<'_>>, Vec<Component<'_>>) =
        (folder.components().collect(), file.components().collect());
    let shared = folder.iter().zip(&file).take_while(|(a, b)| a == b).count();
    let up = folder[shared..].iter().map(|_| Component::ParentDir);
    up.chain(file[shared..].iter().copied()).collect()
}

/// The benchmark of the failures: one tier, `all`. `changes` are those of the command line, `recipe` its path as seen from the folder.
pub fn suite(pool: &Pool, name: &str, failures: &[usize], changes: &[String], recipe: &Path) -> String {
    let mut written = format!(
        "# Episodes in which a policy failed and the expert did not, written by `cosfly hunt`. Fly them with `cosfly fly FILE --tier all`.\n\
         name = {}\nepisodes = [\n",
        text(&safe(name))
    );
    let mut names: Vec<&str> = failures.iter().map(|at| pool.suite.tasks[*at].episode.name.as_str()).collect();
    names.sort_unstable();
    names.iter().for_each(|name| _ = writeln!(written, "  {},", text(name)));
    written.push_str("]\n");
    for part in by_part(pool, failures).into_keys() {
        let changes: Vec<String> = changes.iter().chain(&pool.draws[part].changes).map(|change| text(change)).collect();
        let (recipe, changes) = (text(&recipe.to_string_lossy()), changes.join(", "));
        let _ = write!(written, "\n[[suites]]\nrecipe = {recipe}\nset = [{changes}]\n");
    }
    written.push_str("\n[tiers]\nall = 1000000\n");
    written
}

/// Numbers of the parts of the pool with the most failures, those that the training data are made around.
pub fn worst(pool: &Pool, failures: &[usize]) -> Vec<usize> {
    let mut parts: Vec<(usize, usize)> = by_part(pool, failures).into_iter().collect();
    parts.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
    let mut worlds = BTreeSet::new();
    let of_other_world = parts.into_iter().map(|(part, _)| part).filter(|part| worlds.insert(pool.draws[*part].world));
    of_other_world.take(MOST_WORLDS).collect()
}

/// A recipe of training data with the values of these recipes: their experts' flights behind new walks, and perturbed twins. `folder` is the
/// absolute path of the folder that it will lie in.
pub fn training(recipes: &[Recipe], name: &str, seed: u64, folder: &Path) -> String {
    let mut written = format!(
        "# Training data around failures, written by `cosfly hunt`: the values of the worlds in which most were found, with walks of another seed.\n\
         name = {}\nseed = {seed}\n",
        text(&safe(name))
    );
    let (mut towns, mut films) = (BTreeSet::new(), vec![]);
    for (recipe, number) in recipes.iter().zip(1..) {
        let called = |stage: usize| text(&format!("{}_{number}", recipe.stages[stage].name.recipe_name()));
        for at in needed(recipe) {
            let stage = &recipe.stages[at];
            write_stage(&mut written, recipe, &called, at, folder);
            let town = stage.connection("town").and_then(|town| town.upstreams.first().copied()).map(called);
            let Some(town) = town.filter(|_| follows(stage)) else { continue };
            let (flights, place) = (called(at), films.len() + 1);
            let _ = write!(
                written,
                "\n[stages.twins{place}]\nuse = \"perturb\"\ninputs.town = {town}\ninputs.trajectories = {flights}\n\
                 \n[stages.frames{place}]\nuse = \"render\"\ninputs.town = {town}\n\
                 inputs.trajectories = [{flights}, \"twins{place}\"]\nwidth = 320\nheight = 240\n",
            );
            towns.insert(town);
            films.push(format!("\"frames{place}\""));
        }
    }
    let (towns, films) = (towns.into_iter().collect::<Vec<_>>().join(", "), films.join(", "));
    let _ = write!(
        written,
        "\n[stages.dataset]\nuse = \"dataset\"\ninputs.town = [{towns}]\ninputs.frames = [{films}]\nname = {}\n",
        text(&safe(name))
    );
    written
}

/// Writes a stage with the number of its recipe at its name and at those of its inputs.
fn write_stage(written: &mut String, recipe: &Recipe, called: &dyn Fn(usize) -> String, at: usize, folder: &Path) {
    let stage = &recipe.stages[at];
    let parts = || recipe.stages.iter().filter(|it| it.name.recipe_name() == stage.name.recipe_name());
    let connections = parts().flat_map(|part| &part.connections).filter(|it| it.port.source == PortSource::Recipe);
    // Parts share inputs.
    let inputs: BTreeMap<&str, &Connection> = connections.map(|it| (it.port.name, it)).collect();
    let _ = write!(written, "\n[stages.{}]\nuse = {}\n", called(at), text(&stage.kind));
    for (port, connection) in inputs {
        let upstreams: Vec<String> = connection.upstreams.iter().map(|upstream| called(*upstream)).collect();
        let _ = match &upstreams[..] {
            [one] => writeln!(written, "inputs.{port} = {one}"),
            all => writeln!(written, "inputs.{port} = [{}]", all.join(", ")),
        };
    }
    for (key, value) in parameters(stage, parts(), folder).as_object().into_iter().flatten() {
        let _ = writeln!(written, "{} = {}", text(key), toml(value));
    }
}

/// Stages that flights behind walkers are made of, in the order of the recipe.
fn needed(recipe: &Recipe) -> BTreeSet<usize> {
    let mut needed = BTreeSet::new();
    let mut open: Vec<usize> = (0..recipe.stages.len()).filter(|at| follows(&recipe.stages[*at])).collect();
    while let Some(at) = open.pop() {
        let connections = recipe.stages[at].connections.iter();
        open.extend(connections.flat_map(|it| it.upstreams.iter().copied()));
        // A part of a stage is written with its stage.
        let own = recipe.stages.iter().position(|stage| stage.name.as_str() == recipe.stages[at].name.recipe_name());
        needed.extend(own);
    }
    needed
}

/// Parameters of a stage, with the files of its parts as seen from a folder.
fn parameters<'r>(stage: &RecipeStage, parts: impl Iterator<Item = &'r RecipeStage>, folder: &Path) -> Value {
    let mut parameters = stage.parameters.clone();
    for source in parts.flat_map(|part| &part.sources) {
        let pointer = format!("/{}", source.parameter.replace('.', "/"));
        let path = std::path::absolute(&source.path).unwrap_or_else(|_| source.path.clone());
        let path = path.canonicalize().unwrap_or(path);
        if let Some(value) = parameters.pointer_mut(&pointer) {
            *value = beside(folder, &path).to_string_lossy().into();
        }
    }
    parameters
}

/// A name for a benchmark: letters, digits and `_`.
fn safe(name: &str) -> String {
    name.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter.to_ascii_lowercase() } else { '_' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_as_seen_from_the_folder() {
        let seen = |folder: &str, file: &str| beside(Path::new(folder), Path::new(file));
        assert_eq!(seen("/a/b/out", "/a/b/recipes/x.toml"), Path::new("../recipes/x.toml"));
        assert_eq!(seen("/a", "/a/x.toml"), Path::new("x.toml"));
        assert_eq!(seen("/a/b", "/c/x.toml"), Path::new("../../c/x.toml"));
        assert_eq!(safe("night-rain hunt"), "night_rain_hunt");
    }
}
