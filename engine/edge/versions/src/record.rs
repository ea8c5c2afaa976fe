//! Creates a version of a finished dataset in a store.

use crate::task_name::TaskName;
use crate::version::{Flight, RecipeText, SCHEMA, Task, Version};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_read::PublishedDataset;
use cosfly_recipe::{Recipe, RecipeStage};
use cosfly_runner::{Plan, plan};
use cosfly_stage::{Blobs, StageName, StageRole};
use cosfly_store::{Store, materialise};
use std::collections::{BTreeMap, BTreeSet};

/// Index of the last stage of a recipe that makes a dataset.
///
/// # Errors
/// `version-no-dataset`.
pub fn dataset_stage(recipe: &Recipe) -> Result<usize> {
    recipe.stages.iter().rposition(|stage| stage.has_role(StageRole::Publishes)).ok_or_else(|| {
        let message = format!("recipe `{}` has no stage that publishes a dataset", recipe.name);
        Diagnostic::new("version-no-dataset", Fault::Recipe, message)
    })
}

/// Creates the version of the finished dataset of `recipe`, read with `overrides`, in `store`; `cosfly` is the tool's
/// version.
///
/// # Errors
/// `version-unfinished`, or an error of the store.
pub fn record(name: &str, recipe: &Recipe, overrides: &[String], store: &Store, cosfly: &str) -> Result<Version> {
    let stage = dataset_stage(recipe)?;
    let plan = plan(recipe, store)?;
    let Some(finished) = plan.stages[stage].finished.first().and_then(Option::as_ref) else {
        let message = format!("the dataset of recipe `{}` is not finished as the recipe is now", recipe.name);
        return Err(Diagnostic::new("version-unfinished", Fault::Recipe, message)
            .hint("run the recipe first, with the same `--set`"));
    };
    let files = (*finished.record.outputs).clone();
    let logs = logs_of(&recipe.stages[stage]);
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
            settings: recipe
                .stages
                .iter()
                .map(|it| (it.name.recipe_name().to_owned(), it.parameters.clone()))
                .collect(),
        },
        sources: BTreeMap::new(),
        content,
        files,
        published_by: recipe.stages[stage].name.recipe_name().to_owned(),
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
        version.definitions.insert(planned.name.to_string(), definition);
    }
    let parameters = &version.definitions[recipe.stages[stage].name.as_str()]["parameters"];
    let text = |key: &str| parameters[key].as_str().unwrap_or_default().to_owned();
    (version.dataset, version.dataset_version) = (text("name"), text("version"));
    version.tasks = tasks(&plan, &logs, version.flights.keys().chain(version.rejected.keys()));
    Ok(version)
}

type Published = (BTreeMap<String, Flight>, BTreeMap<String, String>, Digest);

/// Flights and rejections, read from a copy of the dataset's tables alone.
fn flights(store: &Store, files: &Blobs, logs: &StageName) -> Result<Published> {
    let refused = |error: std::io::Error| Diagnostic::io("make a folder for the table of flights", &error);
    let scratch = tempfile::tempdir().map_err(refused)?;
    let folder = scratch.path().join("tables");
    let is_read = |path: &str| path.starts_with("data/trajectories/") || path.starts_with("data/rejected/");
    let tables = files.iter().filter(|(path, _)| is_read(path)).map(|(path, blob)| (path.clone(), *blob)).collect();
    materialise(store, &tables, &folder)?;
    let published = PublishedDataset::open(&folder)?;
    let flight = |flight: &cosfly_read::PublishedFlight| {
        let log = files.get(&flight.mcap_path).map_or(Digest([0; 32]), |blob| blob.digest);
        let task = TaskName { stage: logs.clone(), item: flight.trajectory_id.clone() };
        (flight.trajectory_id.clone(), Flight { split: flight.split.clone(), log, task })
    };
    let flights = published.flights().iter().map(flight).collect();
    Ok((flights, published.rejections()?, cosfly_store::content_of(files)))
}

/// All tasks behind the named items of the stage that writes logs.
fn tasks<'a>(plan: &Plan<'_>, logs: &StageName, items: impl Iterator<Item = &'a String>) -> BTreeMap<TaskName, Task> {
    let wanted: BTreeSet<&str> = items.map(String::as_str).collect();
    let Some(last) = plan.recipe.position(logs.as_str()) else { return BTreeMap::new() };
    let places = plan.recipe.stages[last].items.iter().enumerate();
    let first = places.filter(|(_, item)| wanted.contains(&*item.to_string())).map(|(item, _)| (last, item));
    let mut open: Vec<(usize, usize)> = first.collect();
    let mut seen: BTreeSet<(usize, usize)> = open.iter().copied().collect();
    let name = |(stage, item): (usize, usize)| TaskName::from(&plan.recipe.id(stage, item));
    let mut tasks = BTreeMap::new();
    while let Some((stage, item)) = open.pop() {
        let read = reads(plan.recipe, stage, item);
        open.extend(read.iter().filter(|task| seen.insert(**task)));
        let reads = read.iter().map(|task| name(*task)).collect();
        tasks.insert(name((stage, item)), Task { key: plan.stages[stage].plans[item], reads });
    }
    tasks
}

/// Part of the dataset stage `dataset` that writes the logs.
pub fn logs_of(dataset: &RecipeStage) -> StageName {
    StageName::new(dataset.name.recipe_name(), "logs")
}

/// Tasks that a task reads, as indices of stages and items.
pub fn reads(recipe: &Recipe, stage: usize, item: usize) -> Vec<(usize, usize)> {
    recipe.stages[stage].reads(item).map(|arrival| (arrival.stage, arrival.item)).collect()
}
