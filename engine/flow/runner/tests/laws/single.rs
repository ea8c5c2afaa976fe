//! One task by its plan digest, as another process would run it.

use super::*;
use cosfly_diagnose::Result;
use cosfly_runner::{plan, run_tasks};
use cosfly_stage::{Registry, Takes, Work};
use cosfly_toys::ToyKind;

fn run_one(store: &Store, version: u32, digest: &cosfly_fingerprint::Digest) -> Result<Work> {
    let registry = Registry::new(vec![Box::new(ToyKind { version })]);
    run_tasks(store, &registry, &[*digest], &options(1)).unwrap().remove(0)
}

/// A town with films of every expert in two weathers, and what is made of the films: items of all forms of names.
fn filmed_toys(log: &Log) -> Vec<Toy> {
    let mut toys = town_toys(3, log);
    let mut films = Toy::new("films", 0, &[(2, Fan::Each), (0, Fan::Broadcast)]);
    (films.takes, films.variants) = (Takes::Named, vec!["Noon", "Night"]);
    let extras = Toy::new("extras", 0, &[(5, Fan::Each)]);
    let mut album = Toy::new("album", 1, &[(5, Fan::Gather), (6, Fan::Gather)]);
    album.takes = Takes::Named;
    toys.extend([films, extras, album]);
    toys.iter_mut().for_each(|toy| toy.hook = log.hook());
    toys
}

#[test]
fn tasks_run_one_by_one_give_what_a_run_gives() {
    let reference = {
        let (_folder, store) = fresh_store();
        records(&run_quietly(&recipe(&filmed_toys(&Log::default())), &store))
    };
    let (_folder, store) = fresh_store();
    let log = Log::default();
    let recipe = recipe(&filmed_toys(&log));
    let plan = plan(&recipe, &store).unwrap();
    plan.publish_documents(&store).unwrap();
    let last = plan.stages[4].plans[0];
    assert_eq!(run_one(&store, 1, &last).unwrap_err().code, "task-input-missing");
    assert_eq!(run_one(&store, 2, &last).unwrap_err().code, "task-other-version");
    let unknown = cosfly_fingerprint::Digest::of(b"unknown");
    assert_eq!(run_one(&store, 1, &unknown).unwrap_err().code, "task-unknown");
    for stage in &plan.stages {
        for digest in &stage.plans {
            assert_eq!(run_one(&store, 1, digest).unwrap(), Work::Ran);
            assert_eq!(run_one(&store, 1, digest).unwrap(), Work::Cached);
        }
    }
    assert_eq!(store.failure(&last), None, "the failure of the first attempt is forgotten");
    let summary = run_quietly(&recipe, &store);
    assert_eq!(counts(&summary), [0, 0, 24, 0, 0, 0]);
    assert_eq!(records(&summary), reference, "names have the same form when they are read from documents");
    assert!(log.take().is_empty(), "the recipe's own stages had nothing left to do");
}

#[test]
fn a_list_of_tasks_gives_the_end_of_each_and_may_read_itself() {
    let (_folder, store) = fresh_store();
    let log = Log::default();
    let recipe = recipe(&filmed_toys(&log));
    let plan = plan(&recipe, &store).unwrap();
    plan.publish_documents(&store).unwrap();
    let all: Vec<_> = plan.stages.iter().flat_map(|stage| stage.plans.iter().copied()).collect();
    let unknown = cosfly_fingerprint::Digest::of(b"unknown");
    let listed: Vec<_> = std::iter::once(unknown).chain(all.iter().copied()).collect();
    let registry = Registry::new(vec![Box::new(ToyKind { version: 1 })]);
    let ends = run_tasks(&store, &registry, &listed, &options(2)).unwrap();
    assert_eq!(ends[0].as_ref().unwrap_err().code, "task-unknown");
    assert_eq!(store.failure(&unknown).unwrap().code, "task-unknown");
    assert!(ends[1..].iter().all(|end| *end == Ok(Work::Ran)));
    assert_eq!(counts(&run_quietly(&recipe, &store)), [0, 0, 24, 0, 0, 0]);
}

#[test]
fn what_reads_a_failed_task_of_the_list_has_no_failure_of_its_own() {
    let (_folder, store) = fresh_store();
    let mut toys = town_toys(2, &Log::default());
    toys[1].parameters["undeclared"] = "/no/such/file".into();
    let recipe = recipe(&toys);
    let plan = plan(&recipe, &store).unwrap();
    plan.publish_documents(&store).unwrap();
    let listed: Vec<_> = plan.stages[..3].iter().flat_map(|stage| stage.plans.iter().copied()).collect();
    let registry = Registry::new(vec![Box::new(ToyKind { version: 1 })]);
    let ends = run_tasks(&store, &registry, &listed, &options(1)).unwrap();
    assert_eq!(ends.iter().filter(|end| end.is_ok()).count(), 1, "the town");
    let (failed, reads_it) = (plan.stages[1].plans[0], plan.stages[2].plans[0]);
    assert_eq!(store.failure(&failed).unwrap().code, "machine-io");
    assert!(store.failure(&reads_it).is_none());
}

#[test]
fn what_failed_elsewhere_is_not_tried_again() {
    let (_folder, store) = fresh_store();
    let log = Log::default();
    let recipe = recipe(&town_toys(3, &log));
    let failed = plan(&recipe, &store).unwrap().stages[1].plans[2];
    let refusal = cosfly_diagnose::Diagnostic::new("elsewhere", cosfly_diagnose::Fault::Input, "no");
    let options = RunOptions { failed_elsewhere: BTreeMap::from([(failed, refusal)]), ..options(2) };
    let (summary, _) = run_with_events(&recipe, &store, &options);
    assert_eq!(counts(&summary), [7, 0, 0, 1, 3, 0]);
    assert_eq!(summary.failures[0].diagnostic.code, "elsewhere");
    assert!(!log.take().contains(&"walkers/i00002".to_owned()));
}
