//! A finished dataset of a store as a version.

use crate::version::{Flight, RecipeText, SCHEMA, Task, Version};
use cosfly_dataset::read::PublishedDataset;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_recipe::Recipe;
use cosfly_runner::{Plan, plan};
use cosfly_stage::BlobRef;
use cosfly_store::{Store, materialise};
use std::collections::{BTreeMap, BTreeSet};

/// The last stage of a recipe that makes a dataset, by its place.
///
/// # Errors
/// `version-no-dataset`.
pub fn dataset_stage(recipe: &Recipe) -> Result<usize> {
    let is_dataset = |stage: &cosfly_recipe::RecipeStage| stage.kind == "dataset" && stage.name == stage.recipe_name;
    recipe.stages.iter().rposition(is_dataset).ok_or_else(|| {
        let message = format!("recipe `{}` has no stage that uses `dataset`", recipe.name);
        Diagnostic::new("version-no-dataset", Fault::Recipe, message)
    })
}

/// The dataset of `recipe`, read with `overrides`, as it lies finished in `store`; `cosfly` is the tool's version.
///
/// # Errors
/// `version-unfinished`, or what is wrong with the store.
pub fn record(name: &str, recipe: &Recipe, overrides: &[String], store: &Store, cosfly: &str) -> Result<Version> {
    let stage = dataset_stage(recipe)?;
    let plan = plan(recipe, store)?;
    let Some(finished) = plan.stages[stage].finished.first().and_then(Option::as_ref) else {
        let message = format!("the dataset of recipe `{}` is not finished as the recipe is now", recipe.name);
        return Err(Diagnostic::new("version-unfinished", Fault::Recipe, message)
            .hint("run the recipe first, with the same `--set`"));
    };
    let files = finished.record.outputs.clone();
    let logs = format!("{}.logs", recipe.stages[stage].name);
    let (flights, rejected, content) = flights(store, &files, &logs)?;
    let mut version = Version {
        schema: SCHEMA.to_owned(),
        name: name.to_owned(),
        dataset: String::new(),
        dataset_version: String::new(),
        cosfly: cosfly.to_owned(),
        recipe: RecipeText {
            path: std::path::absolute(&recipe.path).unwrap_or_else(|_| recipe.path.clone()),
            text: recipe.text.to_string(),
            overrides: overrides.to_vec(),
            settings: recipe.stages.iter().map(|it| (it.recipe_name.clone(), it.parameters.clone())).collect(),
        },
        sources: BTreeMap::new(),
        content,
        files,
        definitions: BTreeMap::new(),
        tasks: BTreeMap::new(),
        flights,
        rejected,
    };
    for planned in &plan.stages {
        let definition = planned.definition_document();
        for (parameter, digest) in definition["sources"].as_object().into_iter().flatten() {
            if let Some(digest) = digest.as_str().and_then(|digest| digest.parse().ok()) {
                version.sources.insert(format!("{}.{parameter}", planned.name), digest);
            }
        }
        version.definitions.insert(planned.name.clone(), definition);
    }
    let parameters = &version.definitions[&recipe.stages[stage].name]["parameters"];
    let text = |key: &str| parameters[key].as_str().unwrap_or_default().to_owned();
    (version.dataset, version.dataset_version) = (text("name"), text("version"));
    version.tasks = tasks(&plan, &logs, version.flights.keys().chain(version.rejected.keys()));
    Ok(version)
}

type Published = (BTreeMap<String, Flight>, BTreeMap<String, String>, Digest);

/// What the table of flights says, read from a copy of that table alone.
fn flights(store: &Store, files: &BTreeMap<String, BlobRef>, logs: &str) -> Result<Published> {
    let refused = |error: std::io::Error| Diagnostic::io("make a folder for the table of flights", &error);
    let scratch = tempfile::tempdir().map_err(refused)?;
    let folder = scratch.path().join("tables");
    let is_read = |path: &str| path.starts_with("data/trajectories/") || path.starts_with("data/rejected/");
    let tables = files.iter().filter(|(path, _)| is_read(path)).map(|(path, blob)| (path.clone(), *blob)).collect();
    materialise(store, &tables, &folder)?;
    let published = PublishedDataset::open(&folder)?;
    let flight = |flight: &cosfly_dataset::read::PublishedFlight| {
        let log = files.get(&flight.mcap_path).map_or(Digest([0; 32]), |blob| blob.digest);
        let task = format!("{logs}/{}", flight.trajectory_id);
        (flight.trajectory_id.clone(), Flight { split: flight.split.clone(), log, task })
    };
    let flights = published.flights().iter().map(flight).collect();
    Ok((flights, published.rejections()?, cosfly_store::content_of(files)))
}

/// All tasks behind the named items of the stage of logs.
fn tasks<'a>(plan: &Plan<'_>, logs: &str, items: impl Iterator<Item = &'a String>) -> BTreeMap<String, Task> {
    let wanted: BTreeSet<&str> = items.map(String::as_str).collect();
    let Some(last) = plan.recipe.position(logs) else { return BTreeMap::new() };
    let places = plan.recipe.stages[last].items.iter().enumerate();
    let first = places.filter(|(_, item)| wanted.contains(&***item)).map(|(item, _)| (last, item));
    let mut open: Vec<(usize, usize)> = first.collect();
    let mut seen: BTreeSet<(usize, usize)> = open.iter().copied().collect();
    let name = |(stage, item): (usize, usize)| {
        format!("{}/{}", plan.recipe.stages[stage].name, plan.recipe.stages[stage].items[item])
    };
    let mut tasks = BTreeMap::new();
    while let Some((stage, item)) = open.pop() {
        let read = reads(plan.recipe, stage, item);
        open.extend(read.iter().filter(|task| seen.insert(**task)));
        let reads = read.iter().map(|task| name(*task)).collect();
        tasks.insert(name((stage, item)), Task { key: plan.stages[stage].plans[item], reads });
    }
    tasks
}

/// What a task reads: places of stages and items.
pub fn reads(recipe: &Recipe, stage: usize, item: usize) -> Vec<(usize, usize)> {
    let arrivals = recipe.stages[stage].connections.iter().flat_map(|connection| connection.arrivals_for(item));
    arrivals.map(|arrival| (arrival.stage, arrival.item)).collect()
}
