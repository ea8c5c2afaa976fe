//! Tasks by their plan digests alone: `cosfly task run`, for another process or machine over the same store.

use crate::change::definition_changes;
use crate::document::{DEFINITION_SCHEMA, Definition, StoredPlan};
use crate::inputs::seen_by;
use crate::leaf::{Ended, Settlement, Task, execute};
use crate::options::RunOptions;
use crate::sources::{HashedSource, SourceReader};
use crate::workers::thread_pool;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::{Digest, canonical_json};
use cosfly_stage::{Artifact, ItemId, Ports, Registry, Stage, StageName, Work};
use cosfly_store::{Finished, Store};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// Pause before a task that another process is working on is tried again.
const LOOK_AGAIN: Duration = Duration::from_millis(50);
/// Settled tasks that are made durable together; each holds a lock, that is an open file.
const GROUP: usize = 256;
/// Time after which settled tasks are made durable, so that a killed process loses little.
const GROUP_TIME: Duration = Duration::from_secs(5);

/// Runs the tasks `plans` one after another; their documents are in `store` (see [`crate::Plan::publish_documents`]) and
/// their inputs are finished, or among the tasks before them. Finished tasks are not run again. Gives the end of each
/// task; a failure is also recorded in the store.
///
/// # Errors
/// `machine-threads`. Ends of tasks: `task-unknown`, `task-input-missing`, `task-other-version`, `nondeterministic-stage`
/// (the task is finished with the earlier bytes), or a refusal of the stage or the machine.
pub fn run_tasks(
    store: &Store,
    registry: &Registry,
    plans: &[Digest],
    options: &RunOptions,
) -> Result<Vec<Result<Work>>> {
    let mut tasks = Tasks {
        store,
        registry,
        options,
        pool: thread_pool(options.jobs)?,
        definitions: BTreeMap::new(),
        settled: Vec::new(),
        since: Instant::now(),
        ends: vec![Ok(Work::Cached); plans.len()],
    };
    for (index, plan) in plans.iter().enumerate() {
        tasks.run(index, plan);
    }
    tasks.publish();
    let mut has_failed = false;
    for (plan, end) in plans.iter().zip(&tasks.ends) {
        let Err(failure) = end else { continue };
        // What reads a failed task is not tried: it has no failure of its own.
        let follows = has_failed && failure.code == "task-input-missing";
        has_failed = true;
        if failure.fault != Fault::Stopped && !follows {
            // The caller gets the failure anyway.
            let _ = store.put_failure(plan, failure);
        }
    }
    Ok(tasks.ends)
}

/// A stage as documents of the store describe it.
struct StoredStage {
    name: StageName,
    recipe_seed: u64,
    stage: Box<dyn Stage>,
    sources: Vec<HashedSource>,
    definition: Definition,
}

/// A task whose done record is to be published.
struct Settled {
    index: usize,
    plan: Digest,
    document: String,
    settlement: Settlement,
}

struct Tasks<'s> {
    store: &'s Store,
    registry: &'s Registry,
    options: &'s RunOptions,
    pool: rayon::ThreadPool,
    definitions: BTreeMap<Digest, Arc<StoredStage>>,
    settled: Vec<Settled>,
    /// Time of the last publication.
    since: Instant,
    ends: Vec<Result<Work>>,
}

impl Tasks<'_> {
    fn run(&mut self, index: usize, plan: &Digest) {
        self.store.forget_failure(plan);
        let settled = self.attempt(index, plan);
        // Nothing is missing where the remote refused to tell.
        match settled.map_err(|failure| self.store.check_remote().err().unwrap_or(failure)) {
            Ok(settled) => self.settled.extend(settled),
            Err(failure) => self.ends[index] = Err(failure),
        }
        if self.settled.len() >= GROUP || self.since.elapsed() >= GROUP_TIME {
            self.publish();
        }
    }

    /// Publishes the done records of settled tasks, after their blobs and actions are on the disk.
    fn publish(&mut self) {
        let group = std::mem::take(&mut self.settled);
        self.since = Instant::now();
        if group.is_empty() {
            return;
        }
        let done = |it: &Settled| self.store.publish_done(&it.plan, &it.document, &it.settlement.finished.action);
        let published =
            self.store.sync().and_then(|()| group.iter().try_for_each(done)).and_then(|()| self.store.sync());
        for Settled { index, settlement, .. } in group {
            self.ends[index] = match &published {
                Ok(()) => settlement.divergence.map_or(Ok(settlement.work), Err),
                Err(refusal) => Err(refusal.clone()),
            };
        }
    }

    /// Does a task; `None` where it is finished already.
    fn attempt(&mut self, index: usize, plan: &Digest) -> Result<Option<Settled>> {
        let store = self.store;
        let stored = StoredPlan::read(plan, |digest| store.document(digest)).ok_or_else(|| unknown(plan))?;
        let document = canonical_json(&store.document(plan).ok_or_else(|| unknown(plan))?);
        let of = self.definition(plan, &stored.definition)?;
        let missing = || input_missing(&of.name, &stored.item);
        // What it reads may be among the tasks before it, and not be published yet.
        let settled = &self.settled;
        let finished = |plan: &Digest| {
            let before = settled.iter().rev().find(|it| it.plan == *plan);
            before.map(|it| it.settlement.finished.clone()).or_else(|| store.finished(plan))
        };
        let ports = read_inputs(&finished, &*of.stage, &stored)?;
        let task = Task {
            plan: *plan,
            stage: &*of.stage,
            id: ItemId { stage: of.name.clone(), item: stored.item.clone() },
            recipe_seed: of.recipe_seed,
            definition: &of.definition,
            sources: &of.sources,
            ports,
            // Something may need what was removed: that is why the task was asked for.
            whole: true,
            cancelled: Arc::clone(&self.options.cancelled),
        };
        loop {
            if self.options.cancelled.load(Ordering::Relaxed) {
                return Err(Diagnostic::stopped(&task.id));
            }
            match self.pool.install(|| execute(store, &task))? {
                Ended::AlreadyDone(_) => return Ok(None),
                Ended::InputsLost => return Err(missing()),
                Ended::Settled(settlement) => return Ok(Some(Settled { index, plan: *plan, document, settlement })),
                Ended::Contended => std::thread::sleep(LOOK_AGAIN),
            }
        }
    }

    /// The stage with the definition `digest`, built once.
    fn definition(&mut self, plan: &Digest, digest: &Digest) -> Result<Arc<StoredStage>> {
        if let Some(known) = self.definitions.get(digest) {
            return Ok(Arc::clone(known));
        }
        let unknown = || unknown(plan);
        let json = self.store.document(digest).filter(|it| it["schema"] == DEFINITION_SCHEMA).ok_or_else(unknown)?;
        let build = self.store.build(digest).ok_or_else(unknown)?;
        let name = StageName::read(json["stage"].as_str().ok_or_else(unknown)?);
        let recipe_seed = json["seed"].as_u64().ok_or_else(unknown)?;
        let stage = build_stage(self.registry, &build)?;
        let sources = read_sources(&build)?;
        let definition = Definition::new(&name, recipe_seed, &*stage, &sources);
        if definition.digest != *digest {
            return Err(other_version(&name, &json, &definition));
        }
        let stored = Arc::new(StoredStage { name, recipe_seed, stage, sources, definition });
        self.definitions.insert(*digest, Arc::clone(&stored));
        Ok(stored)
    }
}

fn unknown(plan: &Digest) -> Box<Diagnostic> {
    Diagnostic::new("task-unknown", Fault::Input, format!("the store has no plan `{plan}`"))
        .hint("plan digests come from a run or a plan of a recipe on the same store")
}

fn build_stage(registry: &Registry, build: &Value) -> Result<Box<dyn Stage>> {
    let kind = build["kind"].as_str().unwrap_or_default();
    let refused = |message: String| Diagnostic::new("task-other-version", Fault::Input, message);
    let found = registry.get(kind).ok_or_else(|| refused(format!("this cosfly has no stage kind `{kind}`")))?;
    let parts = found
        .build(build["parameters"].clone())
        .map_err(|error| refused(format!("`{kind}` refuses `{}`: {}", error.path.join("."), error.message)))?;
    let suffix = build["part"].as_str().unwrap_or_default();
    let part = parts.into_iter().find(|part| part.suffix == suffix);
    Ok(part.ok_or_else(|| refused(format!("`{kind}` has no part `{suffix}`")))?.stage)
}

fn read_sources(build: &Value) -> Result<Vec<HashedSource>> {
    let mut reader = SourceReader::default();
    let sources = build["sources"].as_array().map_or(&[][..], Vec::as_slice);
    let text = |value: &Value, key: &str| value[key].as_str().unwrap_or_default().to_owned();
    sources.iter().map(|source| reader.read(&text(source, "parameter"), Path::new(&text(source, "path")))).collect()
}

/// Inputs by port.
fn read_inputs(
    finished: &impl Fn(&Digest) -> Option<Finished>,
    stage: &dyn Stage,
    stored: &StoredPlan,
) -> Result<Ports> {
    let declared = &stage.properties().inputs;
    if let Some(unknown) = stored.inputs.keys().find(|name| declared.iter().all(|port| port.name != *name)) {
        let message = format!("`{}` has no input `{unknown}` in this version of cosfly", stage.properties().kind);
        return Err(Diagnostic::new("task-other-version", Fault::Input, message));
    }
    let mut ports = Ports::new();
    for port in declared {
        let Some(inputs) = stored.inputs.get(port.name) else { continue };
        let mut artifacts = Vec::with_capacity(inputs.len());
        for input in inputs {
            let id = ItemId { stage: input.stage.clone(), item: input.item.clone() };
            let finished = finished(&input.plan).ok_or_else(|| input_missing(&id.stage, &id.item))?;
            let blobs = seen_by(&stored.item, port.sees, Arc::clone(&finished.record.outputs));
            artifacts.push(Artifact { id, name: input.name.clone(), blobs });
        }
        ports.insert(port.name, artifacts.into());
    }
    Ok(ports)
}

fn input_missing(stage: &StageName, item: &dyn Display) -> Box<Diagnostic> {
    Diagnostic::new(
        "task-input-missing",
        Fault::Input,
        format!("`{stage}/{item}`: an input is not finished, or its blobs are missing or damaged"),
    )
    .hint("run what it depends on first")
}

fn other_version(name: &StageName, planned: &Value, rebuilt: &Definition) -> Box<Diagnostic> {
    let changes = definition_changes(planned, &rebuilt.json);
    let diagnostic = Diagnostic::new(
        "task-other-version",
        Fault::Input,
        format!("stage `{name}` has changed since the task was planned"),
    );
    let diagnostic = changes.iter().fold(diagnostic, |diagnostic, change| diagnostic.because(change));
    diagnostic.hint("use the same cosfly and the same source files everywhere, or plan again")
}
