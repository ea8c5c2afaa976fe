//! One task: the same code for a run on this machine and for `cosfly task run` on another.

use crate::document::Definition;
use crate::sources::HashedSource;
use cosfly_diagnose::{Diagnostic, Fault, Result};
use cosfly_fingerprint::Digest;
use cosfly_random::Seed;
use cosfly_stage::{Inputs, ItemId, Ports, Produced, Stage, TaskContext, Work};
use cosfly_store::{ActionRecord, Finished, Store, TaskLock};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A task, ready to run.
pub(crate) struct Task<'a> {
    pub(crate) plan: Digest,
    pub(crate) stage: &'a dyn Stage,
    /// Item that it makes.
    pub(crate) id: ItemId,
    pub(crate) recipe_seed: u64,
    pub(crate) definition: &'a Definition,
    pub(crate) sources: &'a [HashedSource],
    pub(crate) ports: Ports,
    /// Whether its intermediate blobs are needed as well, so that a result without them does not do.
    pub(crate) whole: bool,
    pub(crate) cancelled: Arc<AtomicBool>,
}

impl Task<'_> {
    /// Whether the store holds all blobs of a result that are needed.
    fn is_held(&self, store: &Store, record: &ActionRecord) -> bool {
        let intermediate = self.stage.properties().intermediate;
        store.holds_lasting(record, if self.whole { &[] } else { intermediate })
    }
}

/// State of a task after [`execute`].
pub(crate) enum Ended {
    /// Already finished by another process.
    AlreadyDone(Finished),
    /// Another process is working on it.
    Contended,
    /// A blob that it reads is missing or damaged.
    InputsLost,
    /// Its action is settled; the done record is still to be published.
    Settled(Settlement),
}

/// A task whose blobs and action record are in place.
pub(crate) struct Settlement {
    pub(crate) finished: Finished,
    pub(crate) work: Work,
    /// Set where another execution of the same action gave other bytes.
    pub(crate) divergence: Option<Box<Diagnostic>>,
    /// Lock that is held until the done record is published.
    pub(crate) lock: Option<TaskLock>,
}

/// Does the unfinished part of a task. Work that any process finished is not repeated.
pub(crate) fn execute(store: &Store, task: &Task<'_>) -> Result<Ended> {
    let already_done = || store.finished(&task.plan).filter(|finished| task.is_held(store, &finished.record));
    if let Some(finished) = already_done() {
        return Ok(Ended::AlreadyDone(finished));
    }
    let Some(lock) = store.try_lock_task(&task.plan)? else { return Ok(Ended::Contended) };
    // The last holder of the lock may have finished it.
    if let Some(finished) = already_done() {
        return Ok(Ended::AlreadyDone(finished));
    }
    let seed = Seed::of_item(task.recipe_seed, task.id.stage.as_str(), &task.id.item.to_string()).0;
    let action = task.definition.action_key(&task.id, &seed, &task.ports);
    if let Some(record) = store.action(&action).filter(|record| task.is_held(store, record)) {
        let finished = Finished { action, record: Arc::new(record) };
        return Ok(Ended::Settled(Settlement { finished, work: Work::Reused, divergence: None, lock: Some(lock) }));
    }
    if !inputs_are_there(store, task) {
        return Ok(Ended::InputsLost);
    }
    let mut sink = store.sink();
    let produced = match run_stage(store, task, seed, &mut sink) {
        Ok(produced) => produced,
        Err(diagnostic) if diagnostic.fault == Fault::Lost || !inputs_are_there(store, task) => {
            return Ok(Ended::InputsLost);
        }
        Err(diagnostic) => return Err(diagnostic),
    };
    task.sources.iter().try_for_each(HashedSource::check_unchanged)?;
    let settled = match sink.settle(&action, produced) {
        Err(diagnostic) if diagnostic.fault == Fault::Lost => return Ok(Ended::InputsLost),
        settled => settled?,
    };
    let finished = Finished { action, record: settled.record };
    let divergence = settled.divergence.map(|diagnostic| in_task(diagnostic, task));
    Ok(Ended::Settled(Settlement { finished, work: Work::Ran, divergence, lock: Some(lock) }))
}

fn inputs_are_there(store: &Store, task: &Task<'_>) -> bool {
    let artifacts = task.ports.values().flat_map(|artifacts| artifacts.iter());
    store.holds_all(artifacts.flat_map(|artifact| artifact.blobs.values()))
}

fn run_stage(
    store: &Store,
    task: &Task<'_>,
    seed: [u8; 32],
    sink: &mut cosfly_store::TaskSink<'_>,
) -> Result<Produced> {
    let inputs = Inputs { ports: task.ports.clone(), blobs: store, answers: store };
    let context = TaskContext {
        id: task.id.clone(),
        seed,
        sources: task.sources.iter().map(|source| source.path.clone()).collect(),
        cancelled: Arc::clone(&task.cancelled),
    };
    // No broken state survives a panic: stages have none, and the sink is dropped.
    catch_unwind(AssertUnwindSafe(|| task.stage.run(&inputs, sink, &context))).unwrap_or_else(|panic| {
        Err(in_task(Diagnostic::new("bug-panic", Fault::Bug, "a stage panicked").because(panic_text(&*panic)), task)
            .hint("this is an internal error of cosfly or of a plugin: please report it with the recipe"))
    })
}

fn in_task(mut diagnostic: Box<Diagnostic>, task: &Task<'_>) -> Box<Diagnostic> {
    diagnostic.message = format!("`{}`: {}", task.id, diagnostic.message);
    diagnostic
}

fn panic_text(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("without a message")
}
