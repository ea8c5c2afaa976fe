//! Several runners on one store, runs that are stopped, and tasks that fail beside others that do not.

use super::*;
use cosfly_diagnose::{Diagnostic, Fault};
use cosfly_runner::RunOutcome;
use cosfly_stage::ItemName;
use std::sync::atomic::Ordering;
use std::time::Duration;

#[test]
fn two_runners_on_one_store_both_succeed_and_share_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let log = Log::default();
    let mut toys = town_toys(30, &log);
    for toy in &mut toys {
        let count = log.hook();
        toy.hook = Arc::new(move |context| {
            std::thread::sleep(Duration::from_millis(1));
            count(context)
        });
    }
    let recipe = recipe(&toys);
    let summaries: Vec<RunSummary> = std::thread::scope(|scope| {
        let runs: Vec<_> = (0..3)
            .map(|_| {
                scope.spawn(|| {
                    let store = Store::open(folder.path()).unwrap();
                    run(&recipe, &store, &options(2), &|_| {}).unwrap()
                })
            })
            .collect();
        runs.into_iter().map(|run| run.join().unwrap()).collect()
    });
    assert!(summaries.iter().all(|summary| summary.outcome == RunOutcome::Complete));
    assert_eq!(records(&summaries[0]), records(&summaries[1]));
    let ran = log.take();
    let mut once = ran.clone();
    once.dedup();
    assert_eq!((ran.len(), &ran), (92, &once), "nothing is computed twice");
    assert_eq!(summaries.iter().map(|summary| counts(summary)[0]).sum::<u64>(), 92);
}

#[test]
fn a_stopped_run_keeps_what_is_finished() {
    let (_folder, store) = fresh_store();
    let log = Log::default();
    let options = options(2);
    let mut toys = town_toys(30, &log);
    let (count, cancelled) = (log.hook(), Arc::clone(&options.cancelled));
    toys[2].hook = Arc::new(move |context| {
        if context.id.item >= ItemName::numbered("i", 5) {
            cancelled.store(true, Ordering::Relaxed);
            context.check_cancelled()?;
        }
        count(context)
    });
    let (summary, events) = run_with_events(&recipe(&toys), &store, &options);
    assert_eq!(summary.outcome, RunOutcome::Cancelled);
    assert!(summary.failures.is_empty() && summary.diagnostics.is_empty());
    assert_eq!(events.iter().filter(|event| matches!(event, RunEvent::Stopping)).count(), 1);
    let finished = reported_finished(&events);
    assert_eq!(finished, log.take(), "what ran was published");
    assert!(finished.len() >= 36 && finished.len() < 92);
    let summary = run_quietly(&recipe(&town_toys(30, &log)), &store);
    assert_eq!(summary.outcome, RunOutcome::Complete);
    assert_eq!(log.take().len() + finished.len(), 92);
}

#[test]
fn a_failure_skips_what_reads_it_and_nothing_else() {
    let (_folder, store) = fresh_store();
    let log = Log::default();
    let mut toys = town_toys(4, &log);
    let good_hook = std::mem::replace(
        &mut toys[2].hook,
        Arc::new(|context| {
            if context.id.item == ItemName::numbered("i", 1) {
                return Err(Diagnostic::new("toy-refusal", Fault::Input, "no"));
            }
            assert_ne!(context.id.item, ItemName::numbered("i", 2), "a panic on purpose");
            Ok(())
        }),
    );
    let (summary, events) = run_with_events(&recipe(&toys), &store, &options(2));
    assert_eq!(summary.outcome, RunOutcome::Failed);
    // town, walkers, two experts and two noisy ones ran; two noisy ones and the dataset were skipped.
    assert_eq!(counts(&summary), [9, 0, 0, 2, 3, 0]);
    let mut codes: Vec<_> = summary.failures.iter().map(|failure| failure.diagnostic.code).collect();
    codes.sort();
    assert_eq!(codes, ["bug-panic", "toy-refusal"]);
    let panic = summary.failures.iter().find(|failure| failure.id.item == ItemName::numbered("i", 2)).unwrap();
    assert!(panic.diagnostic.message.contains("`expert/i00002`"));
    assert!(panic.diagnostic.causes[0].contains("a panic on purpose"));
    assert_eq!(events.iter().filter(|event| matches!(event, RunEvent::Failed { .. })).count(), 2);
    let refused = cosfly_runner::plan(&recipe(&toys), &store).unwrap().stages[2].plans[1];
    assert_eq!(store.failure(&refused).unwrap().code, "toy-refusal", "the store tells it, too");
    log.take();
    toys[2].hook = good_hook;
    assert_eq!(run_quietly(&recipe(&toys), &store).outcome, RunOutcome::Complete);
    let ran = ["dataset/i00000", "expert/i00001", "expert/i00002", "noisy/i00001", "noisy/i00002"];
    assert_eq!(log.take(), ran);
}

#[test]
fn a_source_that_changes_during_the_run_is_told_and_nothing_of_it_is_kept() {
    let (_folder, store) = fresh_store();
    let (mut toys, source) = (town_toys(1, &Log::default()), store.root().join("../source"));
    std::fs::write(&source, "one").unwrap();
    toys[0].sources = vec![source.clone()];
    let quiet = Arc::clone(&toys[0].hook);
    let edited = source.clone();
    toys[0].hook = Arc::new(move |_| {
        std::fs::write(&edited, "two, longer").unwrap();
        Ok(())
    });
    let summary = run_quietly(&recipe(&toys), &store);
    assert_eq!(summary.failures[0].diagnostic.code, "source-changed");
    assert_eq!(counts(&summary), [0, 0, 0, 1, 4, 0]);
    toys[0].hook = quiet;
    std::fs::write(&source, "one").unwrap();
    assert_eq!(counts(&run_quietly(&recipe(&toys), &store)), [5, 0, 0, 0, 0, 0]);
}

#[test]
fn bytes_that_differ_between_two_executions_of_one_task_are_told() {
    let (_folder, store) = fresh_store();
    let (mut toys, undeclared) = (town_toys(1, &Log::default()), store.root().join("../undeclared"));
    std::fs::write(&undeclared, "one").unwrap();
    toys[0].parameters = json!({ "undeclared": undeclared });
    let first = records(&run_quietly(&recipe(&toys), &store));
    std::fs::write(&undeclared, "two").unwrap();
    // Another reader needs the town again.
    toys[1].version = 2;
    let hex = first["town/i00000"].outputs["out"].digest.to_string();
    std::fs::remove_file(store.root().join("cas").join(&hex[..2]).join(&hex)).unwrap();
    let summary = run_quietly(&recipe(&toys), &store);
    assert_eq!(summary.outcome, RunOutcome::Failed);
    let told: Vec<_> = summary.diagnostics.iter().map(|diagnostic| diagnostic.code).collect();
    assert_eq!(told, ["nondeterministic-stage"]);
    assert!(summary.diagnostics[0].message.contains("`town/i00000`"));
    assert_eq!(std::fs::read_dir(store.root().join("divergence")).unwrap().count(), 1);
}
