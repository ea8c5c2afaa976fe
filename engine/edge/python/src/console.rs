//! Surroundings of a command within Python: output is collected, progress is polled, Ctrl-C stops the work.

use cosfly::console::{Console, Deadline, Progress, RunProgress, remove_scratch};
use cosfly_diagnose::{Diagnostic, Result, Stop, render};
use cosfly_stage::{RunEvent, StageName};
use std::collections::BTreeMap;
use std::io::{BufRead, Cursor};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Failures of one stage and code that are told in full.
const TOLD_ALIKE: u64 = 3;

/// Payload of a panic that ends a command without a flag of its own after Ctrl-C.
pub struct Stopped;

/// State of a command so far.
#[derive(Default)]
pub struct State {
    /// Printed result.
    pub printed: String,
    /// Messages about the work.
    pub messages: Vec<String>,
    /// Finished and all parts by the name of the work.
    pub progress: BTreeMap<String, [u64; 2]>,
    failures: BTreeMap<(StageName, &'static str), u64>,
    /// Folder for what the command needs while it works.
    scratch: Option<PathBuf>,
}

/// Surroundings of one call.
pub struct Embedded {
    input: Vec<u8>,
    cancelled: Arc<AtomicBool>,
    state: Mutex<State>,
}

impl Embedded {
    /// Surroundings with a standard input.
    pub fn new(input: Vec<u8>) -> Self {
        Self { input, cancelled: Arc::default(), state: Mutex::default() }
    }

    /// Asks the command to stop.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::SeqCst);
    }

    /// Leaves the command alone, whose thread goes on: its scratch folder is removed.
    pub fn abandon(&self) {
        let scratch = self.state().scratch.take();
        scratch.iter().for_each(|folder| remove_scratch(folder));
    }

    /// Output, messages and progress.
    pub fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn failed(&self, event_id: &cosfly_stage::ItemId, diagnostic: &Diagnostic) {
        let mut state = self.state();
        let alike = state.failures.entry((event_id.stage.clone(), diagnostic.code)).or_insert(0);
        *alike += 1;
        if *alike <= TOLD_ALIKE {
            state.messages.push(format!("{}\n  (in `{event_id}`)", render(diagnostic, false)));
        }
    }
}

impl Console for Embedded {
    fn print(&self, text: &str) -> Result<bool> {
        self.state().printed.push_str(text);
        Ok(true)
    }

    fn tell(&self, message: &str) {
        self.state().messages.push(message.to_owned());
    }

    fn input(&self) -> Box<dyn BufRead + '_> {
        Box::new(Cursor::new(&self.input))
    }

    fn cancelled(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.cancelled)
    }

    fn stop(&self) -> Stop {
        Stop::of(Arc::clone(&self.cancelled))
    }

    fn deadline(&self, scratch: Option<&Path>) -> Option<Deadline> {
        self.state().scratch = scratch.map(Path::to_owned);
        None
    }

    fn colour(&self) -> bool {
        false
    }

    fn progress(&self, verb: &str, _noun: &str) -> Progress<'_> {
        let name = verb.to_owned();
        Box::new(move |done, all| {
            if self.cancelled.load(Ordering::Relaxed) {
                std::panic::resume_unwind(Box::new(Stopped));
            }
            self.state().progress.insert(name.clone(), [done, all]);
        })
    }

    fn run_progress(&self, _quiet: bool) -> RunProgress<'_> {
        Box::new(move |event| match event {
            RunEvent::Planned { stages } => {
                let parts = stages.into_iter().map(|(stage, total, cached)| (stage.to_string(), [cached, total]));
                self.state().progress.extend(parts);
            }
            RunEvent::Finished { id, produced, .. } => {
                let mut state = self.state();
                state.messages.extend(produced.warnings.iter().map(|warning| format!("warning: {id}: {warning}")));
                if let Some([done, _]) = state.progress.get_mut(id.stage.as_str()) {
                    *done += 1;
                }
            }
            RunEvent::Failed { id, diagnostic } => {
                self.failed(&id, &diagnostic);
                if let Some([done, _]) = self.state().progress.get_mut(id.stage.as_str()) {
                    *done += 1;
                }
            }
            RunEvent::Stopping => self.tell("stopping: finished items are kept"),
        })
    }
}
