//! Calls of the command line from Python.

use crate::console::{Embedded, Stopped};
use crate::errors::{exception_of, internal};
use cosfly::Refusal;
use cosfly_diagnose::{Diagnostic, Fault};
use pyo3::prelude::*;
use std::ffi::OsString;
use std::panic::AssertUnwindSafe;
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// Time between two looks at signals and progress.
pub const POLL: Duration = Duration::from_millis(50);
/// Time for work that looks at the flag to end after Ctrl-C, and for finished items to be published.
const GRACE: Duration = Duration::from_millis(1500);

/// The process `cosfly` with the given arguments; returns its exit code.
#[pyfunction]
pub fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| cosfly::main(arguments))
}

/// Runs a command and returns its exit code, its output and its messages. `progress` is called with a dictionary from the
/// name of the work to the number of finished and of all parts.
///
/// After Ctrl-C the call ends within two seconds. One long task, such as a plan, does not look at the flag: its thread goes
/// on alone to the end of the task, publishes nothing more, and ends.
#[pyfunction]
#[pyo3(signature = (arguments, input = Vec::new(), progress = None))]
pub fn call(
    py: Python<'_>,
    arguments: Vec<OsString>,
    input: Vec<u8>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(u8, String, Vec<String>)> {
    let console = Arc::new(Embedded::new(input));
    let (send, mut receive) = channel();
    let own = Arc::clone(&console);
    std::thread::spawn(move || {
        let work = AssertUnwindSafe(|| on_own_threads(|| cosfly::call(arguments, &*own)));
        let _ = send.send(std::panic::catch_unwind(work));
    });
    let mut shown = Default::default();
    let mut interruption: Option<(PyErr, Instant)> = None;
    let ended = loop {
        let waited = &mut receive;
        let ended = py.detach(move || waited.recv_timeout(POLL));
        let polled = py.check_signals().and_then(|()| match &progress {
            Some(progress) if interruption.is_none() => {
                let now = console.state().progress.clone();
                if now == shown {
                    return Ok(());
                }
                shown = now.clone();
                progress.call1(py, (now,)).map(drop)
            }
            _ => Ok(()),
        });
        if let Err(error) = polled {
            console.cancel();
            interruption.get_or_insert((error, Instant::now()));
        }
        match (ended, interruption) {
            (Err(RecvTimeoutError::Timeout), None) => interruption = None,
            (Err(RecvTimeoutError::Timeout), Some((error, since))) if since.elapsed() < GRACE => {
                interruption = Some((error, since));
            }
            (Err(RecvTimeoutError::Timeout), Some((error, _))) => {
                console.abandon();
                return Err(error);
            }
            (_, Some((error, _))) => return Err(error),
            (Ok(ended), None) => break ended,
            (Err(RecvTimeoutError::Disconnected), None) => return Err(internal(py)),
        }
    };
    match ended {
        Ok(Ok(code)) => {
            let mut state = console.state();
            Ok((code, std::mem::take(&mut state.printed), std::mem::take(&mut state.messages)))
        }
        Ok(Err(refusal)) => Err(exception_of(py, refusal)),
        Err(payload) if payload.is::<Stopped>() => Err(pyo3::exceptions::PyKeyboardInterrupt::new_err(())),
        Err(_) => Err(internal(py)),
    }
}

/// Bytes of the stack of a thread, as the engine's runs have.
const STACK_BYTES: usize = 8 << 20;

/// Does `work` on threads of its own, one per core: those of the process would not survive a fork.
pub fn on_own_threads<R: Send>(work: impl FnOnce() -> Result<R, Refusal> + Send) -> Result<R, Refusal> {
    let pool = rayon::ThreadPoolBuilder::new().stack_size(STACK_BYTES).build().map_err(|error| {
        let refusal = Diagnostic::new("machine-threads", Fault::Machine, "could not start threads").because(error);
        Refusal::Work(vec![refusal])
    })?;
    pool.install(work)
}
