//! One task, the same for a run on this machine and for `cosfly task run` on another.

use crate::document::Definition;
use crate::sources::HashedSource;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_frames::Seed;
use cosfly_stage::{InputGroup, Inputs, Produced, Stage, TaskContext, TaskOutcome};
use cosfly_store::{BLOB_LOST, Finished, Store, TaskLock};
use std::any::Any;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A task, ready to run.
pub(crate) struct Task<'a> {
    pub(crate) plan: Digest,
    pub(crate) stage: &'a dyn Stage,
    /// Name in the recipe, with part suffix.
    pub(crate) name: &'a str,
    pub(crate) item: &'a str,
    pub(crate) recipe_seed: u64,
    pub(crate) definition: &'a Definition,
    pub(crate) sources: &'a [HashedSource],
    pub(crate) ports: BTreeMap<String, InputGroup>,
    pub(crate) cancelled: Arc<AtomicBool>,
}

/// How far a task came.
pub(crate) enum Ended {
    /// Another process finished it meanwhile.
    AlreadyDone(Finished),
    /// Another process is at it.
    Contended,
    /// A blob that it reads is missing or damaged.
    InputsLost,
    /// Its action is settled; the done record is still to be published.
    Settled(Settlement),
}

/// A task whose blobs and action record are in place.
pub(crate) struct Settlement {
    pub(crate) finished: Finished,
    pub(crate) outcome: TaskOutcome,
    /// Another execution of the same action gave other bytes.
    pub(crate) divergence: Option<Box<Diagnostic>>,
    /// Held until the done record is published.
    pub(crate) lock: Option<TaskLock>,
}

/// Does what is left to do of a task. Whatever is finished already, by anyone, is not done again.
pub(crate) fn execute(store: &Store, task: &Task<'_>) -> Result<Ended> {
    let already_done = || store.finished(&task.plan).filter(|finished| store.holds(&finished.record));
    if let Some(finished) = already_done() {
        return Ok(Ended::AlreadyDone(finished));
    }
    let Some(lock) = store.try_lock_task(&task.plan)? else { return Ok(Ended::Contended) };
    // Whoever held the lock a moment ago may have finished it.
    if let Some(finished) = already_done() {
        return Ok(Ended::AlreadyDone(finished));
    }
    if !inputs_are_there(store, task) {
        return Ok(Ended::InputsLost);
    }
    let seed = Seed::of_item(task.recipe_seed, task.name, task.item).0;
    let action = task.definition.action_key(task.name, task.item, &seed, &task.ports);
    if let Some(record) = store.action(&action).filter(|record| store.holds(record)) {
        let finished = Finished { action, record: Arc::new(record) };
        return Ok(Ended::Settled(Settlement {
            finished,
            outcome: TaskOutcome::Reused,
            divergence: None,
            lock: Some(lock),
        }));
    }
    let mut sink = store.sink();
    let produced = match run_stage(store, task, seed, &mut sink) {
        Ok(produced) => produced,
        Err(diagnostic) if diagnostic.code == BLOB_LOST || !inputs_are_there(store, task) => {
            return Ok(Ended::InputsLost);
        }
        Err(diagnostic) => return Err(diagnostic),
    };
    task.sources.iter().try_for_each(HashedSource::check_unchanged)?;
    let settled = sink.settle(&action, produced)?;
    let finished = Finished { action, record: settled.record };
    let divergence = settled.divergence.map(|diagnostic| in_task(diagnostic, task));
    Ok(Ended::Settled(Settlement { finished, outcome: TaskOutcome::Ran, divergence, lock: Some(lock) }))
}

fn inputs_are_there(store: &Store, task: &Task<'_>) -> bool {
    let artifacts = task.ports.values().flat_map(|group| &group.artifacts);
    artifacts.flat_map(|artifact| artifact.blobs.values()).all(|blob| store.holds_blob(blob))
}

fn run_stage(
    store: &Store,
    task: &Task<'_>,
    seed: [u8; 32],
    sink: &mut cosfly_store::TaskSink<'_>,
) -> Result<Produced> {
    let inputs = Inputs { ports: task.ports.clone(), blobs: store };
    let context = TaskContext {
        stage: task.name.to_owned(),
        item: task.item.to_owned(),
        seed,
        sources: task.sources.iter().map(|source| source.path.clone()).collect(),
        cancelled: Arc::clone(&task.cancelled),
    };
    // The stage is not used after a panic that broke it half way: stages have no state, and the sink is dropped.
    catch_unwind(AssertUnwindSafe(|| task.stage.run(&inputs, sink, &context))).unwrap_or_else(|panic| {
        Err(in_task(Diagnostic::new("bug-panic", Fault::Bug, "a stage panicked").because(panic_text(&*panic)), task)
            .hint("this is an error in cosfly or in a plugin; please report it with the recipe"))
    })
}

fn in_task(mut diagnostic: Box<Diagnostic>, task: &Task<'_>) -> Box<Diagnostic> {
    diagnostic.message = format!("`{}/{}`: {}", task.name, task.item, diagnostic.message);
    diagnostic
}

fn panic_text(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("it said nothing")
}
