//! Creates a version of a finished dataset in a store.

use crate::version::{RecipeText, SCHEMA, Task, Version, VersionFlight};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_read::PublishedDataset;
use cosfly_recipe::{ItemNames, Recipe, RecipeStage};
use cosfly_runner::{Plan, plan};
use cosfly_stage::{Blobs, ItemId, ItemName, StageName, StageRole};
use cosfly_store::{Store, materialise};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

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
    let logs = Logs::of(recipe, stage);
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

type Published = (BTreeMap<String, VersionFlight>, BTreeMap<String, String>, Digest);

/// Flights and rejections, read from a copy of the dataset's tables alone.
fn flights(store: &Store, files: &Blobs, logs: &Logs) -> Result<Published> {
    let refused = |error: std::io::Error| Diagnostic::io("make a folder for the table of flights", &error);
    let scratch = tempfile::tempdir().map_err(refused)?;
    let folder = scratch.path().join("tables");
    let is_read = |path: &str| path.starts_with("data/trajectories/") || path.starts_with("data/rejected/");
    let tables = files.iter().filter(|(path, _)| is_read(path)).map(|(path, blob)| (path.clone(), *blob)).collect();
    materialise(store, &tables, &folder)?;
    let published = PublishedDataset::open(&folder)?;
    let flight = |flight: &cosfly_read::PublishedFlight| {
        let log = files.get(&flight.mcap_path).map_or(Digest([0; 32]), |blob| blob.digest);
        let task = ItemId { stage: logs.stage.clone(), item: logs.item(&flight.trajectory_id) };
        (flight.trajectory_id.clone(), VersionFlight { split: flight.split.clone(), log, task })
    };
    let flights = published.flights().iter().map(flight).collect();
    Ok((flights, published.rejections()?, cosfly_store::content_of(files)))
}

/// Items of the stage that writes the logs, by the ids that they are published under.
struct Logs {
    stage: StageName,
    position: Option<usize>,
    items: BTreeMap<String, usize>,
    names: ItemNames,
}

impl Logs {
    /// Record of the recipe's dataset stage number `dataset`.
    fn of(recipe: &Recipe, dataset: usize) -> Self {
        let stage = logs_of(&recipe.stages[dataset]);
        let position = recipe.position(stage.as_str());
        let names = position.map_or_else(ItemNames::default, |at| Arc::clone(&recipe.stages[at].items));
        let items = names.iter().enumerate().map(|(place, item)| (item.to_string(), place)).collect();
        Self { stage, position, items, names }
    }

    /// Name of the item that is published as `id`.
    fn item(&self, id: &str) -> ItemName {
        self.items.get(id).map_or_else(|| ItemName::own(id), |place| self.names[*place].clone())
    }
}

/// All tasks behind the items that are published as `ids`.
fn tasks<'a>(plan: &Plan<'_>, logs: &Logs, ids: impl Iterator<Item = &'a String>) -> BTreeMap<ItemId, Task> {
    let Some(last) = logs.position else { return BTreeMap::new() };
    let mut open: Vec<(usize, usize)> = ids.filter_map(|id| Some((last, *logs.items.get(id)?))).collect();
    let mut seen: BTreeSet<(usize, usize)> = open.iter().copied().collect();
    let id = |(stage, item): (usize, usize)| plan.recipe.id(stage, item);
    let mut tasks = BTreeMap::new();
    while let Some((stage, item)) = open.pop() {
        let read = reads(plan.recipe, stage, item);
        open.extend(read.iter().filter(|task| seen.insert(**task)));
        let reads = read.iter().map(|task| id(*task)).collect();
        tasks.insert(id((stage, item)), Task { key: plan.stages[stage].plans[item], reads });
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
