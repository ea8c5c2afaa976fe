//! Only what is needed is made; intermediate blobs go once everything that reads them is finished.

use super::*;
use cosfly_runner::{RunOutcome, plan};
use cosfly_stage::Sees;
use cosfly_store::{GarbageOptions, collect_garbage};
use cosfly_toys::PACK;
use std::path::Path;
use std::time::{Duration, SystemTime};

/// Films with packs, logs that read the packs, captions that the logs read, an album of logs and of films without packs.
fn film_toys(log: &Log) -> Vec<Toy> {
    let mut toys = vec![
        Toy::new("walks", 3, &[]),
        Toy::new("films", 0, &[(0, Fan::Each)]),
        Toy::new("captions", 0, &[(0, Fan::Each)]),
        Toy::new("logs", 0, &[(1, Fan::Each), (2, Fan::Each)]),
        Toy::new("album", 1, &[(1, Fan::Gather), (3, Fan::Gather)]),
    ];
    toys[1].packs = true;
    toys[4].sees = Sees::Only(&["out"]);
    toys.iter_mut().for_each(|toy| toy.hook = log.hook());
    toys
}

fn film_recipe(toys: &[Toy], remove: bool) -> Recipe {
    Recipe { remove_intermediates: remove, ..recipe(toys) }
}

/// Packs in the store.
fn packs(store: &Store, summary: &RunSummary) -> usize {
    summary.finished_items(1).filter(|(_, film)| store.holds_blob(&film.record.outputs[PACK])).count()
}

fn collected(root: &Path) -> u64 {
    let now = SystemTime::now();
    let options = GarbageOptions {
        keep_runs: 3,
        keep_age: Duration::from_secs(86_400),
        now,
        pack_from: GarbageOptions::PACK_FROM,
        dry_run: false,
    };
    collect_garbage(root, &options).unwrap().blobs
}

#[test]
fn a_removed_pack_is_made_again_only_for_a_reader_that_runs() {
    let (folder, mut store) = fresh_store();
    for remove in [true, false] {
        let log = Log::default();
        let mut toys = film_toys(&log);
        toys[0].version = if remove { 10 } else { 20 };
        toys[1].parameters = json!({ "remove": remove });
        let first = run_quietly(&film_recipe(&toys, remove), &store);
        assert_eq!(first.outcome, RunOutcome::Complete);
        assert_eq!(packs(&store, &first), if remove { 0 } else { 3 });
        if !remove {
            drop(store);
            assert_eq!(collected(&folder.path().join("store")), 3);
            store = Store::open(&folder.path().join("store")).unwrap();
            assert_eq!(packs(&store, &first), 0);
        }
        log.take();
        // Nothing is left to do, twice: with the old index and with a new one.
        for _ in 0..2 {
            let again = run_quietly(&film_recipe(&toys, remove), &store);
            assert_eq!((again.outcome, log.take().len()), (RunOutcome::Complete, 0));
        }
        // A new album reads no pack.
        toys[4].parameters = json!({ "title": remove });
        run_quietly(&film_recipe(&toys, remove), &store);
        assert_eq!(log.take(), ["album/i00000"]);
        // Walks that turn out as they were make no film again.
        toys[0].version += 1;
        toys[0].parameters = json!({ "constant": true });
        run_quietly(&film_recipe(&toys, remove), &store);
        log.take();
        toys[0].version += 1;
        run_quietly(&film_recipe(&toys, remove), &store);
        assert_eq!(log.take(), ["walks/i00000", "walks/i00001", "walks/i00002"]);
        // Other captions need the packs again.
        toys[2].parameters = json!({ "words": remove });
        let planned = film_recipe(&toys, remove);
        assert_eq!(plan(&planned, &store).unwrap().stages[1].spent, if remove { 3 } else { 0 });
        let reworded = run_quietly(&planned, &store);
        assert_eq!(reworded.outcome, RunOutcome::Complete);
        let ran = log.take();
        assert_eq!(ran.iter().filter(|it| it.starts_with("films")).count(), if remove { 3 } else { 0 }, "{ran:?}");
        assert_eq!(packs(&store, &reworded), if remove { 0 } else { 3 });
    }
}

#[test]
fn packs_are_read_before_many_more_are_made() {
    let (_folder, store) = fresh_store();
    let log = Log::default();
    let mut toys = film_toys(&log);
    toys[0] = Toy { hook: log.hook(), ..Toy::new("walks", 1200, &[]) };
    let summary = run_quietly(&film_recipe(&toys, true), &store);
    assert_eq!((summary.outcome, packs(&store, &summary)), (RunOutcome::Complete, 0));
    let order = std::mem::take(&mut *log.0.lock().unwrap());
    let (mut packed, mut most) = (0i64, 0);
    for task in &order {
        packed += i64::from(task.starts_with("films/")) - i64::from(task.starts_with("logs/"));
        most = most.max(packed);
    }
    // Films are ahead of their logs while they are on their way to the disk: twice 256 at most, and those of two workers.
    assert!(most < 520, "{most} of 1200 films had no log");
}

#[test]
fn an_interrupted_run_keeps_the_packs_that_are_still_needed() {
    let (folder, store) = fresh_store();
    let log = Log::default();
    let mut toys = film_toys(&log);
    let quiet = Arc::clone(&toys[3].hook);
    toys[3].hook = Arc::new(|context| match context.id.item.to_string().as_str() {
        "i00001" => Err(cosfly_diagnose::Diagnostic::new("no-log", cosfly_diagnose::Fault::Input, "no log")),
        _ => Ok(()),
    });
    let failed = run_quietly(&film_recipe(&toys, true), &store);
    assert_eq!((failed.outcome, packs(&store, &failed)), (RunOutcome::Failed, 1));
    drop(store);
    assert_eq!(collected(&folder.path().join("store")), 0);
    let store = Store::open(&folder.path().join("store")).unwrap();
    log.take();
    toys[3].hook = quiet;
    let whole = run_quietly(&film_recipe(&toys, true), &store);
    assert_eq!((whole.outcome, packs(&store, &whole)), (RunOutcome::Complete, 0));
    assert_eq!(log.take(), ["album/i00000", "logs/i00001"]);
}

#[test]
fn what_nothing_needs_is_not_made_and_what_is_asked_for_stays() {
    let (_folder, store) = fresh_store();
    let log = Log::default();
    let toys = film_toys(&log);
    let asked = RunOptions { asked: Some(1), ..options(2) };
    let films = run(&film_recipe(&toys, true), &store, &asked, &|_| {}).unwrap();
    assert_eq!((films.outcome, packs(&store, &films)), (RunOutcome::Complete, 3));
    assert_eq!(films.stages.iter().map(|stage| stage.not_needed).collect::<Vec<_>>(), [0, 0, 3, 3, 1]);
    assert_eq!(log.take().len(), 6);
    let all = run_quietly(&film_recipe(&toys, true), &store);
    // Blobs of stages that nothing needs any more may go.
    let lost: Vec<_> = [0, 2].into_iter().flat_map(|stage| all.finished_items(stage)).collect();
    lost.iter().for_each(|(_, it)| store.remove_blob(&it.record.outputs["out"]).unwrap());
    log.take();
    let again = run_quietly(&film_recipe(&toys, true), &store);
    assert_eq!((again.outcome, log.take().len()), (RunOutcome::Complete, 0));
    assert_eq!(again.stages[0].not_needed, 3);
    // A lost film has all of its chain made again.
    store.remove_blob(&all.finished_items(1).next().unwrap().1.record.outputs["out"]).unwrap();
    let mut retitled = film_toys(&log);
    retitled[4].parameters = json!({ "title": 1 });
    let healed = run_quietly(&film_recipe(&retitled, true), &store);
    assert_eq!(healed.outcome, RunOutcome::Complete);
    assert_eq!(log.take(), ["album/i00000", "films/i00000", "walks/i00000"]);
}
