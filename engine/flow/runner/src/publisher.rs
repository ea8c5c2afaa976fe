//! One thread that makes finished tasks durable in groups: one sync of the disk for many of them.

use crate::leaf::Settlement;
use crate::schedule::TaskIndex;
use cosfly_diagnose::{Diagnostic, Result};
use cosfly_fingerprint::Digest;
use cosfly_store::Store;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Settled tasks that may wait for the disk; workers wait when there are more. Each holds a lock, that is an open file.
const MOST_WAITING: usize = 256;

/// A task on its way to being finished.
pub(crate) struct Publication {
    pub(crate) task: TaskIndex,
    pub(crate) settlement: Settlement,
    pub(crate) took: Duration,
}

/// The queue between workers and the publishing thread.
#[derive(Default)]
pub(crate) struct Publisher {
    queue: Mutex<Queue>,
    changed: Condvar,
}

#[derive(Default)]
struct Queue {
    waiting: Vec<Publication>,
    closed: bool,
}

impl Publisher {
    /// Queues a settled task; waits when the disk is far behind.
    pub(crate) fn submit(&self, publication: Publication) {
        let mut queue = self.lock();
        while queue.waiting.len() >= MOST_WAITING && !queue.closed {
            queue = self.changed.wait(queue).unwrap_or_else(PoisonError::into_inner);
        }
        queue.waiting.push(publication);
        self.changed.notify_all();
    }

    /// Ends the queue: no more tasks will come.
    pub(crate) fn close(&self) {
        self.lock().closed = true;
        self.changed.notify_all();
    }

    /// Publishes until the queue ends. `document` gives the plan digest and document of a task; `durable` gets every
    /// task once its done record is on the disk. A refusal of the disk goes to `refused`, and the tasks of that group
    /// stay unpublished.
    pub(crate) fn serve(
        &self,
        store: &Store,
        document: impl Fn(TaskIndex) -> (Digest, String),
        mut durable: impl FnMut(Publication),
        mut refused: impl FnMut(Box<Diagnostic>),
    ) {
        // Done records that were written after the last sync.
        let mut written: Vec<Publication> = Vec::new();
        loop {
            let group = self.take(written.is_empty());
            if group.is_empty() && written.is_empty() {
                return;
            }
            // Makes the blobs and actions of `group`, and the done records of `written`, durable.
            let published = store.sync().and_then(|()| {
                written.drain(..).for_each(&mut durable);
                group.into_iter().try_for_each(|mut publication| {
                    publish(store, &document, &publication)?;
                    publication.settlement.lock = None;
                    written.push(publication);
                    Ok(())
                })
            });
            if let Err(diagnostic) = published {
                refused(diagnostic);
                // Their locks are freed, and the next run does them again.
                written.clear();
            }
        }
    }

    /// Waiting tasks; when `idle`, waits for some. Empty means that there are none at the moment, or, when `idle`, that
    /// the queue ended.
    fn take(&self, idle: bool) -> Vec<Publication> {
        let mut queue = self.lock();
        while idle && queue.waiting.is_empty() && !queue.closed {
            queue = self.changed.wait(queue).unwrap_or_else(PoisonError::into_inner);
        }
        self.changed.notify_all();
        std::mem::take(&mut queue.waiting)
    }

    fn lock(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn publish(store: &Store, document: &impl Fn(TaskIndex) -> (Digest, String), publication: &Publication) -> Result<()> {
    let (plan, document) = document(publication.task);
    store.publish_done(&plan, &document, &publication.settlement.finished.action)
}
