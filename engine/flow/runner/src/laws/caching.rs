//! What runs again after a change, and what does not.

use super::*;
use crate::summary::RunOutcome;

#[test]
fn a_second_run_computes_nothing_and_knows_the_same() {
    let (_folder, store) = fresh_store();
    let log = Log::default();
    let recipe = recipe(&town_toys(5, &log));
    let first = run_quietly(&recipe, &store);
    assert_eq!(first.outcome, RunOutcome::Complete);
    assert_eq!(counts(&first), [17, 0, 0, 0, 0, 0]);
    assert_eq!(log.take().len(), 17);
    let second = run_quietly(&recipe, &store);
    assert_eq!(counts(&second), [0, 0, 17, 0, 0, 0]);
    assert_eq!(records(&first), records(&second));
    assert!(log.take().is_empty());
    assert_eq!(store.past_runs(&crate::recipe_id(&recipe)).count(), 1);
}

#[test]
fn records_do_not_depend_on_the_number_of_threads() {
    let of = |jobs| {
        let (_folder, store) = fresh_store();
        let summary = run(&recipe(&town_toys(40, &Log::default())), &store, &options(jobs), &|_| {}).unwrap();
        records(&summary)
    };
    let one = of(1);
    assert_eq!(one, of(2));
    assert_eq!(one, of(7));
}

#[test]
fn a_parameter_reruns_what_reads_it_and_changed_back_nothing() {
    let (_folder, store) = fresh_store();
    let log = Log::default();
    let mut toys = town_toys(3, &log);
    let original = run_quietly(&recipe(&toys), &store);
    log.take();
    let before = std::mem::replace(&mut toys[3].parameters, json!({ "speed": { "min_mps": 0.6 } }));
    run_quietly(&recipe(&toys), &store);
    assert_eq!(log.take(), ["dataset/i00000", "noisy/i00000", "noisy/i00001", "noisy/i00002"]);
    toys[3].parameters = before;
    let back = run_quietly(&recipe(&toys), &store);
    assert!(log.take().is_empty());
    assert_eq!(records(&back), records(&original));
}

#[test]
fn more_items_compute_only_those_and_what_gathers_them() {
    let (_folder, store) = fresh_store();
    let log = Log::default();
    run_quietly(&recipe(&town_toys(2, &log)), &store);
    log.take();
    run_quietly(&recipe(&town_toys(3, &log)), &store);
    assert_eq!(log.take(), ["dataset/i00000", "expert/i00002", "noisy/i00002", "walkers/i00002"]);
    run_quietly(&recipe(&town_toys(2, &log)), &store);
    assert!(log.take().is_empty());
}

#[test]
fn equal_contents_stop_a_change_from_spreading() {
    let (_folder, store) = fresh_store();
    let log = Log::default();
    let mut toys = town_toys(3, &log);
    toys[1].parameters = json!({ "constant": true, "speed": 1 });
    run_quietly(&recipe(&toys), &store);
    log.take();
    toys[1].parameters = json!({ "constant": true, "speed": 2 });
    let summary = run_quietly(&recipe(&toys), &store);
    assert_eq!(log.take(), ["walkers/i00000", "walkers/i00001", "walkers/i00002"]);
    assert_eq!(counts(&summary), [3, 7, 1, 0, 0, 0]);
}

#[test]
fn warnings_and_rejections_are_told_again_when_cached() {
    let (_folder, store) = fresh_store();
    let mut toys = town_toys(1, &Log::default());
    toys[1].parameters = json!({ "warning": "steep", "rejected": "unreachable" });
    for _ in 0..2 {
        let summary = run_quietly(&recipe(&toys), &store);
        assert_eq!(summary.warnings().collect::<Vec<_>>(), [("walkers", "i00000", "steep")]);
        assert_eq!(summary.rejected().collect::<Vec<_>>(), [("walkers", "i00000", "unreachable")]);
    }
}

#[test]
fn a_recipe_without_items_is_complete() {
    let (_folder, store) = fresh_store();
    let summary = run_quietly(&recipe(&town_toys(0, &Log::default())), &store);
    assert_eq!((summary.outcome, counts(&summary)), (RunOutcome::Complete, [2, 0, 0, 0, 0, 0]));
}
