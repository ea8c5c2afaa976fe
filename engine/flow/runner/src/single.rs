//! One task by its plan digest alone: `cosfly task run`, for another process or machine over the same store.

use crate::change::definition_changes;
use crate::document::{DEFINITION_SCHEMA, Definition, StoredPlan};
use crate::inputs::seen_by;
use crate::leaf::{Ended, Task, execute};
use crate::names::NameReader;
use crate::sources::{HashedSource, SourceReader};
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::{Digest, canonical_json};
use cosfly_stage::{Artifact, ItemId, ItemName, Ports, Registry, Stage, StageName, Work};
use cosfly_store::Store;
use serde_json::Value;
use std::fmt::Display;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Pause before a task that another process is working on is tried again.
const LOOK_AGAIN: Duration = Duration::from_millis(50);

/// Runs the task `plan`, whose documents are in `store` (see [`crate::Plan::publish_documents`]) and whose inputs are
/// finished. Nothing is done where it is finished already.
///
/// # Errors
/// `task-unknown`, `task-input-missing`, `task-other-version`, `nondeterministic-stage` (the task is finished with the
/// earlier bytes), or a refusal of the stage or the machine.
pub fn run_task(store: &Store, registry: &Registry, plan: &Digest, cancelled: Arc<AtomicBool>) -> Result<Work> {
    let unknown = || {
        Diagnostic::new("task-unknown", Fault::Input, format!("the store has no plan `{plan}`"))
            .hint("plan digests come from a run or a plan of a recipe on the same store")
    };
    let stored = StoredPlan::read(plan, |digest| store.document(digest)).ok_or_else(unknown)?;
    let document = canonical_json(&store.document(plan).ok_or_else(unknown)?);
    let definition = store.document(&stored.definition).filter(|it| it["schema"] == DEFINITION_SCHEMA);
    let definition = definition.ok_or_else(unknown)?;
    let build = store.build(&stored.definition).ok_or_else(unknown)?;
    let name = StageName::read(definition["stage"].as_str().ok_or_else(unknown)?);
    let recipe_seed = definition["seed"].as_u64().ok_or_else(unknown)?;
    let stage = build_stage(registry, &build)?;
    let sources = read_sources(&build)?;
    let rebuilt = Definition::new(&name, recipe_seed, &*stage, &sources);
    if rebuilt.digest != stored.definition {
        return Err(other_version(&name, &definition, &rebuilt));
    }
    let mut names = NameReader::new(store);
    let missing = || input_missing(&name, &stored.item);
    let item = names.of_task(plan).ok_or_else(missing)?;
    let ports = read_inputs(store, &*stage, &stored, &item, &mut names)?.ok_or_else(missing)?;
    let task = Task {
        plan: *plan,
        stage: &*stage,
        id: ItemId { stage: name, item },
        recipe_seed,
        definition: &rebuilt,
        sources: &sources,
        ports,
        whole: false,
        cancelled,
    };
    finish(store, &task, &document)
}

fn finish(store: &Store, task: &Task<'_>, document: &str) -> Result<Work> {
    let settlement = loop {
        match execute(store, task)? {
            Ended::AlreadyDone(_) => return Ok(Work::Cached),
            Ended::InputsLost => return Err(input_missing(&task.id.stage, &task.id.item)),
            Ended::Settled(settlement) => break settlement,
            Ended::Contended if task.cancelled.load(Ordering::Relaxed) => {
                return Err(Diagnostic::stopped(&task.id));
            }
            Ended::Contended => std::thread::sleep(LOOK_AGAIN),
        }
    };
    store.sync()?;
    store.publish_done(&task.plan, document, &settlement.finished.action)?;
    store.sync()?;
    settlement.divergence.map_or(Ok(settlement.work), Err)
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

/// Inputs by port; `None` where a document behind the name of an input is missing or damaged.
fn read_inputs(
    store: &Store,
    stage: &dyn Stage,
    stored: &StoredPlan,
    reader: &ItemName,
    names: &mut NameReader<'_>,
) -> Result<Option<Ports>> {
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
            let upstream = StageName::read(&input.stage);
            let finished = store.finished(&input.plan).ok_or_else(|| input_missing(&upstream, &input.item))?;
            let (Some(item), Some(name)) = (names.of_task(&input.plan), names.at_port(input)) else { return Ok(None) };
            let blobs = seen_by(reader, port.sees, Arc::clone(&finished.record.outputs));
            artifacts.push(Artifact { id: ItemId { stage: upstream, item }, name, blobs });
        }
        ports.insert(port.name, artifacts.into());
    }
    Ok(Some(ports))
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
