//! Town and walks of a recipe, for measurements: the stages before the planner, run in a scratch store.

use super::outcome::Refusals;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_experts::{RecipeExpert, artifacts};
use cosfly_geometry::BoxBvh;
use cosfly_lab::planner::scene::Ground;
use cosfly_planner::MucoConfig;
use cosfly_recipe::{Recipe, RecipeStage};
use cosfly_runner::{RunOptions, RunSummary};
use cosfly_stage::{BlobSource, Blobs, Registry, StageRole};
use cosfly_store::Store;
use cosfly_town::GroundIndex;
use std::path::Path;
use std::sync::Arc;

/// Town, walks, and planner parameters of the first stage of a recipe that plans flights behind walkers, with the values of `set`; `paths` and `seed`
/// replace the number of walks and the recipe's seed where given.
pub fn town_of_recipe(
    path: &Path,
    set: &[String],
    paths: Option<usize>,
    seed: Option<u64>,
) -> Result<(Ground, MucoConfig), Refusals> {
    let registry = cosfly_stages::registry();
    let mut overrides = set.to_vec();
    overrides.extend(seed.map(|seed| format!("seed={seed}")));
    let mut recipe = cosfly_recipe::load(path, &overrides, &registry)?;
    let position = planner_of(&recipe)?;
    if let (Some(count), Some(walkers)) = (paths, walkers_of(&recipe, &registry, position)) {
        overrides.push(format!("stages.{walkers}.count={count}"));
        recipe = cosfly_recipe::load(path, &overrides, &registry)?;
    }
    let planner = recipe.stages[position].clone();
    // Inputs come before the stage that reads them; later stages are not needed.
    recipe.stages.truncate(position);
    let scratch = std::env::current_dir()
        .and_then(tempfile::tempdir_in)
        .map_err(|error| vec![Diagnostic::io("make a scratch folder here", &error)])?;
    let store = Store::open(&scratch.path().join("store")).map_err(one)?;
    let jobs = std::thread::available_parallelism().map_or(1, usize::from);
    let options = RunOptions { jobs, cancelled: Arc::default(), ..RunOptions::default() };
    let mut summary = cosfly_runner::run(&recipe, &store, &options, &|_| {}).map_err(one)?;
    let failures: Refusals = summary.failures.drain(..).map(|failure| failure.diagnostic).collect();
    if !failures.is_empty() {
        return Err(failures);
    }
    let ground = ground(&recipe, &planner, &summary, &store).map_err(one)?;
    let expert = RecipeExpert::read(planner.stage.properties().parameters.clone())
        .map_err(|refused| one(Diagnostic::new("bench-parameters", Fault::Recipe, refused.message)))?;
    Ok((ground, expert.expert.config))
}

/// Index of the first stage that plans flights behind walkers.
fn planner_of(recipe: &Recipe) -> Result<usize, Refusals> {
    let follows = |stage: &RecipeStage| stage.has_role(StageRole::Plans) && stage.connection("walks").is_some();
    recipe.stages.iter().position(follows).ok_or_else(|| {
        let message = format!("`{}` has no stage that plans flights behind walkers", recipe.name);
        one(Diagnostic::new("bench-no-planner", Fault::Recipe, message))
    })
}

/// Name of the recipe stage that makes the planner's walks, where it has a `count`.
fn walkers_of<'r>(recipe: &'r Recipe, registry: &Registry, planner: usize) -> Option<&'r str> {
    let upstream = &recipe.stages[*recipe.stages[planner].connection("walks")?.upstreams.first()?];
    let is_counted = registry.get(&upstream.kind)?.schema()["properties"]["count"].is_object();
    is_counted.then_some(upstream.name.recipe_name())
}

fn one(diagnostic: Box<Diagnostic>) -> Refusals {
    vec![diagnostic]
}

fn ground(
    recipe: &Recipe,
    planner: &RecipeStage,
    summary: &RunSummary,
    store: &Store,
) -> cosfly_diagnose::Result<Ground> {
    let town = match arrived(planner, summary, "town")?.first() {
        Some(blobs) => artifacts::TOWN.decode(&store.read(&blobs[artifacts::TOWN.blob])?)?,
        None => return Err(unfinished("town")),
    };
    let mut tracks = Vec::new();
    for blobs in arrived(planner, summary, "walks")? {
        tracks.push(artifacts::WALK.decode(&store.read(&blobs[artifacts::WALK.blob])?)?.track);
    }
    let index = GroundIndex::new(&town);
    Ok(Ground {
        name: recipe.name.clone(),
        exact_boxes: town.obstacles.len(),
        exact: Box::new(BoxBvh::build(town.obstacles.iter().map(|obstacle| obstacle.shape).collect())),
        planning_boxes: town.planning_boxes,
        height: Box::new(move |x, y| index.ground_height_m(x, y).unwrap_or(0.0)),
        tracks,
    })
}

/// Finished blobs at a port of the planner, in its item order.
fn arrived(planner: &RecipeStage, summary: &RunSummary, port: &str) -> cosfly_diagnose::Result<Vec<Arc<Blobs>>> {
    let arrivals = planner.connection(port).map_or(&[][..], |connection| &connection.arrivals);
    let finished = arrivals.iter().map(|arrival| summary.result(arrival.stage, arrival.item));
    finished.map(|it| Ok(Arc::clone(&it.ok_or_else(|| unfinished(port))?.record.outputs))).collect()
}

fn unfinished(port: &str) -> Box<Diagnostic> {
    Diagnostic::new("bench-unfinished", Fault::Input, format!("the recipe's `{port}` was not finished"))
}
