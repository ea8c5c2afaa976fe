//! Ctrl-C and termination signals set one flag; a second one ends the process at once, and so does a [`Deadline`].

use crate::output;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

/// Time for tasks that look at the flag to end, and for finished ones to be published.
const GRACE: Duration = Duration::from_millis(1500);
/// Most attempts to remove a folder that other threads still write to.
const ATTEMPTS: usize = 20;
/// Pause between two looks at the flag, and between two attempts.
const LOOK: Duration = Duration::from_millis(50);

static FLAG: OnceLock<Arc<AtomicBool>> = OnceLock::new();

/// The flag, with the signal handler in place.
pub fn flag() -> Arc<AtomicBool> {
    Arc::clone(FLAG.get_or_init(|| {
        let flag = Arc::new(AtomicBool::new(false));
        let seen = Arc::clone(&flag);
        // Without a handler the signal just ends the process, which the store survives as well.
        let _ = ctrlc::set_handler(move || {
            if seen.swap(true, Ordering::SeqCst) {
                std::process::exit(i32::from(crate::exit::STOPPED));
            }
        });
        flag
    }))
}

/// Ends the process soon after the flag was set: one long task, such as a plan, does not look at it. The store survives that; only
/// unfinished items are lost. Dropped, it does nothing any more.
#[derive(Debug)]
pub struct Deadline {
    _over: Sender<()>,
}

impl Deadline {
    /// Begins to look at the flag. The folder `scratch` is removed before the process ends.
    pub fn begin(scratch: Option<&Path>) -> Self {
        let (over, is_over) = channel();
        let flag = flag();
        let scratch = scratch.map(Path::to_owned);
        std::thread::spawn(move || {
            let mut stopped_at = None;
            while is_over.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                if flag.load(Ordering::SeqCst) && stopped_at.get_or_insert_with(Instant::now).elapsed() >= GRACE {
                    scratch.iter().for_each(|folder| remove_scratch(folder));
                    output::tell("stopped: items that were not finished are made again");
                    std::process::exit(i32::from(crate::exit::STOPPED));
                }
            }
        });
        Self { _over: over }
    }
}

/// Removes a folder that other threads may still write to.
pub fn remove_scratch(folder: &Path) {
    for _ in 0..ATTEMPTS {
        let _ = std::fs::remove_dir_all(folder);
        if !folder.exists() {
            return;
        }
        std::thread::sleep(LOOK);
    }
}
