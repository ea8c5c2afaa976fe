//! The expert of a recipe as an object: a thread of its own keeps the plan, the towns and the flights between batches.

use crate::calls::{POLL, on_own_threads};
use crate::console::Embedded;
use crate::errors::{exception_of, internal};
use cosfly::Refusal;
use cosfly::expert::{options, with_expert};
use pyo3::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};

/// A batch: states as lines of JSON, the number of parts side by side, and where the answers go.
struct Batch {
    lines: Vec<String>,
    jobs: usize,
    is_cancelled: Arc<AtomicBool>,
    answers: Sender<Vec<String>>,
}

/// The expert of a finished recipe.
#[pyclass(frozen, module = "cosfly._cosfly")]
pub struct ExpertService(Sender<Batch>);

#[pymethods]
impl ExpertService {
    /// `options` are JSON: the fields of `ExpertOptions`.
    #[new]
    fn new(py: Python<'_>, options: &str) -> PyResult<Self> {
        let options = self::options(options).map_err(|refusal| exception_of(py, refusal))?;
        let (send, batches) = channel::<Batch>();
        let (ready, opened) = channel::<Result<(), Refusal>>();
        std::thread::spawn(move || {
            let served = on_own_threads(|| {
                with_expert(options, &Embedded::new(vec![]), |experts| {
                    let _ = ready.send(Ok(()));
                    for batch in batches {
                        let answers = experts.answers(&batch.lines, batch.jobs, &batch.is_cancelled);
                        let _ = batch.answers.send(answers);
                    }
                })
            });
            let _ = ready.send(served);
        });
        let opened = waited(py, opened, &AtomicBool::new(false))?;
        opened.map_err(|refusal| exception_of(py, refusal))?;
        Ok(Self(send))
    }

    /// Answers to states, both lines of JSON.
    fn answers(&self, py: Python<'_>, lines: Vec<String>, jobs: usize) -> PyResult<Vec<String>> {
        let (send, answers) = channel();
        let is_cancelled = Arc::new(AtomicBool::new(false));
        let batch = Batch { lines, jobs, is_cancelled: Arc::clone(&is_cancelled), answers: send };
        self.0.send(batch).map_err(|_| internal(py))?;
        waited(py, answers, &is_cancelled)
    }
}

/// Value that a thread sends; a signal sets `is_cancelled` and ends the wait.
fn waited<T: Send>(py: Python<'_>, mut from: Receiver<T>, is_cancelled: &AtomicBool) -> PyResult<T> {
    loop {
        let waited = &mut from;
        match py.detach(move || waited.recv_timeout(POLL)) {
            Ok(found) => return Ok(found),
            Err(RecvTimeoutError::Disconnected) => return Err(internal(py)),
            Err(RecvTimeoutError::Timeout) => {
                py.check_signals().inspect_err(|_| is_cancelled.store(true, Ordering::Relaxed))?
            }
        }
    }
}
