//! Items that run again after a change, and items that do not.

use super::*;
use cosfly_runner::{RejectionOrigin, RunOutcome, TaskEnd};
use cosfly_stage::Work;

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
    assert_eq!(store.past_runs(&cosfly_runner::recipe_id(&recipe)).count(), 1);
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
fn warnings_are_kept_with_cached_items() {
    let (_folder, store) = fresh_store();
    let mut toys = town_toys(1, &Log::default());
    toys[1].parameters = json!({ "warning": "steep" });
    for _ in 0..2 {
        let summary = run_quietly(&recipe(&toys), &store);
        let (item, finished) = summary.finished_items(at(&toys, "walkers")).next().unwrap();
        assert_eq!(
            (item.to_string().as_str(), &finished.record.produced.warnings[..]),
            ("i00000", &["steep".into()][..])
        );
    }
}

#[test]
fn a_rejection_is_told_with_the_item_that_it_began_at_also_when_cached() {
    let (_folder, store) = fresh_store();
    let mut toys = town_toys(2, &Log::default());
    for (stage, reason) in [(1, "unreachable"), (2, "unreachable"), (3, "its expert was rejected"), (4, "empty")] {
        toys[stage].parameters = json!({ "rejected": reason });
    }
    let recipe = recipe(&toys);
    let from = |stage, item| RejectionOrigin::Inherited(recipe.id(stage, item));
    for work in [Work::Ran, Work::Cached] {
        let summary = run_quietly(&recipe, &store);
        let told: Vec<_> = summary.rejections().map(|(id, it)| (id.to_string(), it.reason, it.origin)).collect();
        let expected = [
            ("walkers/i00000", "unreachable", RejectionOrigin::Own),
            ("walkers/i00001", "unreachable", RejectionOrigin::Own),
            ("expert/i00000", "unreachable", from(1, 0)),
            ("expert/i00001", "unreachable", from(1, 1)),
            ("noisy/i00000", "its expert was rejected", from(1, 0)),
            ("noisy/i00001", "its expert was rejected", from(1, 1)),
            ("dataset/i00000", "empty", RejectionOrigin::Own),
        ];
        assert_eq!(told, expected.map(|(id, reason, origin)| (id.to_owned(), reason.to_owned(), origin)));
        assert_eq!(summary.ends().next().unwrap(), (recipe.id(0, 0), TaskEnd::Done(work)));
    }
}

#[test]
fn a_recipe_without_items_is_complete() {
    let (_folder, store) = fresh_store();
    let summary = run_quietly(&recipe(&town_toys(0, &Log::default())), &store);
    // Nothing reads the town.
    assert_eq!((summary.outcome, counts(&summary)), (RunOutcome::Complete, [1, 0, 0, 0, 0, 0]));
    assert_eq!(summary.stages[0].not_needed, 1);
}
