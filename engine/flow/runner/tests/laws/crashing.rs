//! Publishing that is interrupted between any two steps.

use super::*;
use cosfly_runner::RunOutcome;
use cosfly_store::{FaultPoints, PublishStep};
use std::io;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Refuses every step from the given one on, as a disk that is full, or a process that is dead.
struct RefuseFrom {
    first: usize,
    seen: AtomicUsize,
}

impl FaultPoints for RefuseFrom {
    fn before(&self, _step: PublishStep) -> io::Result<()> {
        if self.seen.fetch_add(1, Ordering::Relaxed) < self.first {
            return Ok(());
        }
        Err(io::ErrorKind::StorageFull.into())
    }
}

fn files_below(folder: &Path) -> usize {
    let Ok(entries) = std::fs::read_dir(folder) else { return 0 };
    entries.flatten().map(|entry| if entry.path().is_dir() { files_below(&entry.path()) } else { 1 }).sum()
}

#[test]
fn interrupted_between_any_two_steps_nothing_partial_is_believed_and_nothing_finished_is_lost() {
    let reference = {
        let (_folder, store) = fresh_store();
        records(&run_quietly(&recipe(&town_toys(1, &Log::default())), &store))
    };
    let mut interrupted = 0;
    for first in 0.. {
        let folder = tempfile::tempdir().unwrap();
        let log = Log::default();
        let recipe = recipe(&town_toys(1, &log));
        let faults = Arc::new(RefuseFrom { first, seen: AtomicUsize::new(0) });
        let store = Store::open_with_faults(folder.path(), faults).unwrap();
        let events = Mutex::new(Vec::new());
        let summary = run(&recipe, &store, &options(1), &|event| events.lock().unwrap().push(event));
        let finished = reported_finished(&events.into_inner().unwrap());
        match summary {
            Ok(summary) if summary.outcome == RunOutcome::Complete => break,
            Ok(summary) => {
                let told = summary.failures.iter().map(|failure| &failure.diagnostic).chain(&summary.diagnostics);
                assert!(told.clone().count() > 0 && told.clone().all(|told| told.code == "disk-full"), "step {first}");
            }
            Err(refusal) => assert_eq!(refusal.code, "disk-full", "step {first}"),
        }
        drop(store);
        assert_eq!(files_below(&folder.path().join("tmp")), 0, "step {first}");
        interrupted += 1;
        log.take();

        let store = Store::open(folder.path()).unwrap();
        let summary = run_quietly(&recipe, &store);
        assert_eq!(records(&summary), reference, "step {first}");
        let again = log.take();
        assert!(!finished.iter().any(|task| again.contains(task)), "step {first}: {finished:?} {again:?}");
    }
    assert!(interrupted > 30, "{interrupted}");
}

#[test]
fn a_full_disk_is_told_once_and_stops_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let faults = Arc::new(RefuseFrom { first: 40, seen: AtomicUsize::new(0) });
    let store = Store::open_with_faults(folder.path(), faults).unwrap();
    let summary = run_quietly(&recipe(&town_toys(500, &Log::default())), &store);
    assert_eq!(summary.outcome, RunOutcome::Failed);
    assert!(summary.failures.len() + summary.diagnostics.len() <= 6);
    assert!(counts(&summary)[5] > 1000, "{:?}", counts(&summary));
}
