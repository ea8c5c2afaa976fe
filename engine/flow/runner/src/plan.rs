//! A recipe against a store: every task with its plan digest, and what of it is finished.

use crate::document::{Definition, PlannedInput, PortDocument, plan_document, port_document};
use crate::reasons::{self, Reason};
use crate::sources::{HashedSource, SourceReader};
use cosfly_diagnose::Result;
use cosfly_fingerprint::{Digest, canonical_json};
use cosfly_recipe::{Arrival, Recipe, RecipeStage};
use cosfly_stage::{Artifact, Fan};
use cosfly_store::{Finished, PastRun, PastStage, Store};
use rayon::prelude::*;
use serde_json::json;
use std::path::Path;
use std::sync::Arc;

/// Fewer items than this are not worth another thread.
const PER_THREAD: usize = 256;

/// What a run of a recipe consists of.
pub struct Plan<'r> {
    /// The recipe.
    pub recipe: &'r Recipe,
    /// Its name in the store's history.
    pub recipe_id: String,
    /// In the recipe's order.
    pub stages: Vec<PlannedStage>,
    /// Whether history and index are of this very plan, so that a run with nothing to do writes nothing.
    pub(crate) index_is_current: bool,
}

/// One stage of a plan. Everything per item is in the order of [`RecipeStage::items`].
pub struct PlannedStage {
    /// Name, with part suffix.
    pub name: String,
    /// Kind.
    pub kind: String,
    /// Plan digest of each item.
    pub plans: Vec<Digest>,
    /// What each item came to, when it is finished and all its blobs are there.
    pub finished: Vec<Option<Finished>>,
    /// Bytes that the items left to do are expected to take.
    pub predicted_bytes: u64,
    /// Why items will run, with their numbers; empty when all are finished.
    pub reasons: Vec<(Reason, u64)>,
    pub(crate) definition: Definition,
    pub(crate) sources: Vec<HashedSource>,
    pub(crate) ports: Vec<PortDocument>,
}

impl PlannedStage {
    /// How many items it has.
    pub fn items(&self) -> u64 {
        self.plans.len() as u64
    }

    /// What all its items share: kind, version, parameters with their defaults, digests of files.
    pub fn definition_document(&self) -> serde_json::Value {
        serde_json::from_str(&self.definition.json).unwrap_or_default()
    }

    /// How many of them are finished.
    pub fn cached(&self) -> u64 {
        self.finished.iter().flatten().count() as u64
    }

    /// How many are left to do.
    pub fn to_run(&self) -> u64 {
        self.items() - self.cached()
    }
}

/// The name of a recipe in the store's history: two recipes of one name at different places do not share theirs.
pub fn recipe_id(recipe: &Recipe) -> String {
    let path = std::path::absolute(&recipe.path).unwrap_or_else(|_| recipe.path.clone());
    let name: String = recipe.name.chars().filter(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-')).collect();
    format!("{name}-{}", Digest::of(path.as_os_str().as_encoded_bytes()).short())
}

/// Holds a recipe against a store. All stages are wanted.
///
/// # Errors
/// What the machine refused while sources were hashed and the store was listed.
pub fn plan<'r>(recipe: &'r Recipe, store: &Store) -> Result<Plan<'r>> {
    let mut plan = digest_tasks(recipe)?;
    find_finished(&mut plan, store);
    reasons::give_reasons(&mut plan, store);
    Ok(plan)
}

/// The plan digests of all tasks, nothing held against a store.
pub(crate) fn digest_tasks(recipe: &Recipe) -> Result<Plan<'_>> {
    let mut sources = SourceReader::default();
    let mut stages: Vec<PlannedStage> = Vec::with_capacity(recipe.stages.len());
    for stage in &recipe.stages {
        let planned = digest_stage(recipe, stage, &stages, &mut sources)?;
        stages.push(planned);
    }
    Ok(Plan { recipe, recipe_id: recipe_id(recipe), stages, index_is_current: false })
}

fn digest_stage(
    recipe: &Recipe,
    stage: &RecipeStage,
    earlier: &[PlannedStage],
    reader: &mut SourceReader,
) -> Result<PlannedStage> {
    let read = |source: &cosfly_recipe::SourceFile| reader.read(&source.parameter, &source.path);
    let sources: Vec<HashedSource> = stage.sources.iter().map(read).collect::<Result<_>>()?;
    let definition = Definition::new(&stage.name, recipe.seed, &*stage.stage, &sources);
    let mut ports: Vec<PortDocument> = stage
        .connections
        .iter()
        .enumerate()
        .map(|(n, c)| {
            port_document(c.port.name, c.port.fan, n, c.arrivals.iter().map(|a| planned_input(recipe, earlier, a)))
        })
        .collect();
    ports.sort_by_key(PortDocument::port);
    let plan_of = |(index, item): (usize, &Arc<str>)| {
        let arrival = |connection: usize| stage.connections[connection].arrivals.get(index);
        let each = |connection: usize| arrival(connection).map(|arrival| planned_input(recipe, earlier, arrival));
        Digest::of(plan_document(&definition.digest, item, &ports, each).as_bytes())
    };
    let plans: Vec<Digest> = stage.items.par_iter().enumerate().with_min_len(PER_THREAD).map(plan_of).collect();
    Ok(PlannedStage {
        name: stage.name.clone(),
        kind: stage.kind.clone(),
        finished: vec![None; plans.len()],
        plans,
        predicted_bytes: 0,
        reasons: Vec::new(),
        definition,
        sources,
        ports,
    })
}

fn planned_input<'a>(recipe: &'a Recipe, stages: &[PlannedStage], arrival: &'a Arrival) -> PlannedInput<'a> {
    let upstream = &recipe.stages[arrival.stage];
    PlannedInput {
        id: &arrival.id,
        stage: &upstream.name,
        item: &upstream.items[arrival.item],
        plan: stages[arrival.stage].plans[arrival.item],
    }
}

fn find_finished(plan: &mut Plan<'_>, store: &Store) {
    let known = store.known_tasks(&plan.recipe_id);
    for stage in &mut plan.stages {
        stage.finished = stage.plans.par_iter().with_min_len(PER_THREAD).map(|digest| known.finished(digest)).collect();
    }
    predict(plan);
    plan.index_is_current = known.is_current(&plan.run_digest());
}

/// Sizes of what is left to do: as large as the stage's finished items, else as the stage itself expects.
fn predict(plan: &mut Plan<'_>) {
    let mut expected: Vec<u64> = Vec::with_capacity(plan.stages.len());
    for (stage, described) in plan.stages.iter_mut().zip(&plan.recipe.stages) {
        let known: Vec<u64> = stage.finished.iter().flatten().map(|finished| finished.record.bytes()).collect();
        let stated = described.stage.properties().bytes_per_item;
        let arriving = || {
            let each = described.connections.iter().filter(|connection| connection.port.fan == Fan::Each);
            each.filter_map(|connection| connection.upstreams.iter().map(|upstream| expected[*upstream]).max()).sum()
        };
        let each = match (known.len() as u64, stated) {
            (0, 0) => arriving(),
            (0, stated) => stated,
            (items, _) => known.iter().fold(0, |sum: u64, bytes| sum.saturating_add(*bytes)) / items,
        };
        stage.predicted_bytes = stage.to_run().saturating_mul(each);
        expected.push(each);
    }
}

impl Plan<'_> {
    /// How many tasks are left to do.
    pub fn to_run(&self) -> u64 {
        self.stages.iter().map(PlannedStage::to_run).sum()
    }

    /// A digest over all plan digests.
    pub(crate) fn run_digest(&self) -> Digest {
        let plans = self.stages.iter().flat_map(|stage| stage.plans.iter().flat_map(|plan| plan.0));
        Digest::of(&plans.collect::<Vec<u8>>())
    }

    /// The artifact of an item, as its own stage names it.
    pub fn artifact(&self, stage: &str, item: &str) -> Option<Artifact> {
        let position = self.recipe.position(stage)?;
        let index = self.recipe.stages[position].items.iter().position(|id| &**id == item)?;
        let record = &self.stages[position].finished[index].as_ref()?.record;
        Some(Artifact { stage: stage.to_owned(), item: item.to_owned(), blobs: record.outputs.clone() })
    }

    /// The plan document of an item.
    pub(crate) fn document(&self, stage: usize, item: usize) -> String {
        let described = &self.recipe.stages[stage];
        let planned = &self.stages[stage];
        let each = |connection: usize| {
            let arrival = described.connections[connection].arrivals.get(item)?;
            Some(planned_input(self.recipe, &self.stages, arrival))
        };
        plan_document(&planned.definition.digest, &described.items[item], &planned.ports, each)
    }

    /// Publishes what all items of a stage share: its definition, its gathers and how to build it.
    pub(crate) fn publish_stage(&self, store: &Store, stage: usize) -> Result<()> {
        let planned = &self.stages[stage];
        store.put_document(&planned.definition.digest, &planned.definition.json)?;
        for port in &planned.ports {
            if let PortDocument::Shared { gather: Some((digest, json)), .. } = port {
                store.put_document(digest, json)?;
            }
        }
        store.put_build(&planned.definition.digest, &build_document(&self.recipe.stages[stage], &planned.sources))
    }

    /// Publishes the documents of everything that is left to do, so that [`crate::run_task`] can do it anywhere.
    pub fn publish_documents(&self, store: &Store) -> Result<()> {
        for (stage, planned) in self.stages.iter().enumerate() {
            if planned.to_run() > 0 {
                self.publish_stage(store, stage)?;
            }
            for item in (0..planned.plans.len()).filter(|item| planned.finished[*item].is_none()) {
                store.put_document(&planned.plans[item], &self.document(stage, item))?;
            }
        }
        store.sync()
    }

    /// What of this plan is finished, for the history.
    pub(crate) fn as_past_run(&self) -> PastRun {
        let stage = |(planned, described): (&PlannedStage, &RecipeStage)| PastStage {
            name: planned.name.clone(),
            definition: planned.definition.digest,
            items: described
                .items
                .iter()
                .zip(planned.plans.iter().zip(&planned.finished))
                .filter(|(_, (_, finished))| finished.is_some())
                .map(|(item, (plan, _))| (item.to_string(), *plan))
                .collect(),
        };
        PastRun { stages: self.stages.iter().zip(&self.recipe.stages).map(stage).collect() }
    }
}

fn build_document(stage: &RecipeStage, sources: &[HashedSource]) -> String {
    let part = stage.name.strip_prefix(&stage.recipe_name).map_or("", |suffix| suffix.trim_start_matches('.'));
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let sources: Vec<_> = sources
        .iter()
        .map(|source| json!({ "parameter": source.parameter, "path": absolute(&source.path).to_string_lossy() }))
        .collect();
    canonical_json(&json!({
        "schema": "cosfly.build/1",
        "kind": stage.kind,
        "part": part,
        "parameters": stage.parameters,
        "sources": sources,
    }))
}
