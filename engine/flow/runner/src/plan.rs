//! The plan of a recipe: every task with its key, the finished ones, and the documents that describe them.

use crate::document::{Definition, PlannedInput, PortDocument, gather_document, plan_document};
use crate::reason::Reason;
use crate::sources::HashedSource;
use cosfly_diagnose::Result;
use cosfly_fingerprint::{Digest, DigestOfPieces, canonical_json};
use cosfly_recipe::{Arrival, Connection, Recipe, RecipeStage};
use cosfly_stage::{Sees, StageName};
use cosfly_store::{Finished, FolderTimes, PastRun, PastStage, Store};
use serde_json::json;
use std::path::Path;

/// Plan digests that are hashed at once.
const PIECE: usize = 4096;

/// All tasks of a recipe, held against a store.
pub struct Plan<'r> {
    /// The recipe.
    pub recipe: &'r Recipe,
    /// Name of the recipe in the store's history.
    pub recipe_id: String,
    /// Stages in the recipe's order.
    pub stages: Vec<PlannedStage>,
    /// True where history and index are of this very plan, so that a run with nothing to do writes nothing.
    pub(crate) index_is_current: bool,
    /// Folders of the store that had lost nothing when the recipe was planned.
    pub(crate) folders: FolderTimes,
}

/// One stage of a plan. Everything per item is in the order of [`RecipeStage::items`].
pub struct PlannedStage {
    /// Name of the stage.
    pub name: StageName,
    /// Kind of the stage.
    pub kind: String,
    /// Plan digest of each item.
    pub plans: Vec<Digest>,
    /// Result of each item that is finished and has all its blobs but intermediate ones, which may be gone.
    pub finished: Vec<Option<Finished>>,
    /// Whether each item is needed: it is asked for, or something that will run reads it.
    pub needed: Vec<bool>,
    /// Number of finished items without some intermediate blob that an item to run may read; they are made again where it
    /// does.
    pub spent: u64,
    /// Expected bytes of the items that are left to do.
    pub predicted_bytes: u64,
    /// Expected number of files in the store of the items that are left to do: blobs, and three records of each item.
    pub predicted_files: u64,
    /// Expected time of the items that are left to do, on one core each, seconds; `None` where none was ever measured.
    pub predicted_s: Option<f64>,
    /// Reasons why items will run, with the number of items; empty where all are finished.
    pub reasons: Vec<(Reason, u64)>,
    /// Whether each item that was finished when the recipe was planned had all its blobs; `None` for the others.
    pub(crate) was_whole: Vec<Option<bool>>,
    pub(crate) definition: Definition,
    pub(crate) sources: Vec<HashedSource>,
    pub(crate) ports: Vec<PortDocument>,
}

/// Name of a recipe in the store's history: two recipes of one name at different places do not share theirs.
pub fn recipe_id(recipe: &Recipe) -> String {
    let path = std::path::absolute(&recipe.path).unwrap_or_else(|_| recipe.path.clone());
    let name: String = recipe.name.chars().filter(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-')).collect();
    format!("{name}-{}", Digest::of(path.as_os_str().as_encoded_bytes()).short())
}

impl PlannedStage {
    /// Kind and part, such as `dataset.logs`.
    pub(crate) fn kind_and_part(&self) -> String {
        StageName::new(&self.kind, self.name.part()).to_string()
    }

    /// Number of items.
    pub fn items(&self) -> u64 {
        self.plans.len() as u64
    }

    /// Number of finished items.
    pub fn cached(&self) -> u64 {
        self.finished.iter().flatten().count() as u64
    }

    /// Number of items that are left to do.
    pub fn to_run(&self) -> u64 {
        (0..self.plans.len()).filter(|item| self.will_run(*item)).count() as u64
    }

    /// Number of unfinished items that nothing needs: everything that is made of them is finished.
    pub fn not_needed(&self) -> u64 {
        self.items() - self.cached() - self.to_run()
    }

    /// Whether an item is left to do.
    pub fn will_run(&self, item: usize) -> bool {
        self.needed[item] && self.finished[item].is_none()
    }

    /// Document that all items share: kind, version, parameters with their defaults, digests of files.
    pub fn definition_document(&self) -> serde_json::Value {
        serde_json::from_str(&self.definition.json).unwrap_or_default()
    }
}

impl Plan<'_> {
    /// Number of tasks that are left to do.
    pub fn to_run(&self) -> u64 {
        self.stages.iter().map(PlannedStage::to_run).sum()
    }

    /// Digest over all plan digests.
    pub(crate) fn run_digest(&self) -> Digest {
        let mut plans = DigestOfPieces::default();
        let each = self.stages.iter().flat_map(|stage| stage.plans.chunks(PIECE));
        each.for_each(|piece| plans.add(&piece.iter().map(|plan| plan.0).collect::<Vec<_>>().concat()));
        plans.digest()
    }

    /// Plan document of an item.
    pub(crate) fn document(&self, stage: usize, item: usize) -> String {
        let described = &self.recipe.stages[stage];
        let planned = &self.stages[stage];
        let each = |connection: usize| {
            let arrivals = described.connections[connection].arrivals_for(item).iter();
            arrivals.map(|arrival| planned_input(self.recipe, &self.stages, arrival))
        };
        plan_document(&planned.definition.digest, &described.items[item], &planned.ports, each)
    }

    /// Publishes the documents that all items of a stage share: its definition, its gathers, and how to build it.
    pub(crate) fn publish_stage(&self, store: &Store, stage: usize) -> Result<()> {
        let (described, planned) = (&self.recipe.stages[stage], &self.stages[stage]);
        store.put_document(&planned.definition.digest, &planned.definition.json)?;
        for port in &planned.ports {
            if let PortDocument::Shared { gather: Some((digest, connection)), .. } = port {
                let arrivals = described.connections[*connection].arrivals.iter();
                let inputs = arrivals.map(|arrival| planned_input(self.recipe, &self.stages, arrival));
                store.put_document(digest, &gather_document(inputs))?;
            }
        }
        store.put_build(&planned.definition.digest, &build_document(described, &planned.sources))
    }

    /// Publishes the documents of everything that is left to do, so that [`crate::run_tasks`] can do it anywhere.
    pub fn publish_documents(&self, store: &Store) -> Result<()> {
        for (stage, planned) in self.stages.iter().enumerate() {
            if planned.to_run() > 0 {
                self.publish_stage(store, stage)?;
            }
            for item in (0..planned.plans.len()).filter(|item| planned.will_run(*item)) {
                store.put_document(&planned.plans[item], &self.document(stage, item))?;
            }
        }
        store.sync()
    }

    /// Intermediate blobs of a stage that every reader is done with; none where nothing reads them.
    fn spent_blobs(&self, stage: usize) -> Vec<String> {
        let is_spent = |name: &&&'static str| {
            let readers = self.recipe.stages.iter().zip(&self.stages).filter(|(described, _)| {
                described.connections.iter().any(|it| it.upstreams.contains(&stage) && sees(it, name))
            });
            let finished: Vec<bool> = readers.map(|(_, planned)| planned.cached() == planned.items()).collect();
            !finished.is_empty() && finished.into_iter().all(|it| it)
        };
        let names = self.recipe.stages[stage].stage.properties().intermediate.iter();
        names.filter(is_spent).map(|name| (*name).to_owned()).collect()
    }

    /// Finished tasks of this plan, for the history.
    pub(crate) fn as_past_run(&self) -> PastRun {
        let stage = |(index, (planned, described)): (usize, (&PlannedStage, &RecipeStage))| PastStage {
            name: planned.name.to_string(),
            definition: planned.definition.digest,
            spent: self.spent_blobs(index),
            items: described
                .items
                .iter()
                .zip(planned.plans.iter().zip(&planned.finished))
                .filter(|(_, (_, finished))| finished.is_some())
                .map(|(item, (plan, _))| (item.to_string(), *plan))
                .collect(),
        };
        PastRun { stages: self.stages.iter().zip(&self.recipe.stages).enumerate().map(stage).collect() }
    }
}

/// Whether some item of a stage sees the intermediate blob `name` through `connection`. No intermediate blob is called
/// like an item.
pub(crate) fn sees(connection: &Connection, name: &str) -> bool {
    match connection.port.sees {
        Sees::All => true,
        Sees::Only(names) => names.contains(&name),
        Sees::Own => false,
    }
}

/// An item at a port, as plan documents name it.
pub(crate) fn planned_input<'a>(recipe: &'a Recipe, stages: &[PlannedStage], arrival: &'a Arrival) -> PlannedInput<'a> {
    let upstream = &recipe.stages[arrival.stage];
    PlannedInput {
        name: &arrival.name,
        stage: &upstream.name,
        item: &upstream.items[arrival.item],
        plan: stages[arrival.stage].plans[arrival.item],
    }
}

fn build_document(stage: &RecipeStage, sources: &[HashedSource]) -> String {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let sources: Vec<_> = sources
        .iter()
        .map(|source| json!({ "parameter": source.parameter, "path": absolute(&source.path).to_string_lossy() }))
        .collect();
    canonical_json(&json!({
        "schema": "cosfly.build/1",
        "kind": stage.kind,
        "part": stage.name.part(),
        "parameters": stage.parameters,
        "sources": sources,
    }))
}
