//! Reproducible bytes: any number of jobs, repeated runs, after kill -9 at random moments; finished items are not made
//! again.

use crate::street::Street;
use crate::support::{cosfly, tree_digests};
use std::collections::BTreeMap;
use std::time::Duration;

fn run(street: &Street, out: &str, more: &[&str]) -> crate::support::Printed {
    let mut arguments = vec!["run", "recipe.toml", "--out", out];
    arguments.extend_from_slice(more);
    cosfly(&arguments).within(street.path()).run_ok()
}

#[test]
fn jobs_and_repetition_change_no_byte() {
    let street = Street::new();
    run(&street, "one", &["--jobs", "1", "--store", "store-one"]);
    run(&street, "two", &["--jobs", "2", "--store", "store-two"]);
    run(&street, "again", &["--jobs", "2", "--store", "store-two"]);
    let one = tree_digests(&street.path().join("one"));
    assert!(one.len() > 10, "a whole dataset");
    assert_eq!(one, tree_digests(&street.path().join("two")));
    assert_eq!(one, tree_digests(&street.path().join("again")));
}

/// Finished items of a store with their times of publication.
fn finished(store: &std::path::Path) -> BTreeMap<String, std::time::SystemTime> {
    let mut found = BTreeMap::new();
    let Ok(shards) = std::fs::read_dir(store.join("done")) else { return found };
    for shard in shards.map(|shard| shard.expect("entry").path()) {
        for record in std::fs::read_dir(shard).expect("readable").map(|record| record.expect("entry")) {
            let made = record.metadata().expect("there").modified().expect("a time");
            found.insert(record.file_name().to_string_lossy().into_owned(), made);
        }
    }
    found
}

#[test]
fn twenty_kills_lose_no_finished_item_and_change_no_byte() {
    let street = Street::new();
    run(&street, "undisturbed", &["--store", "store-undisturbed"]);
    let store = street.path().join("store");
    let mut seen: BTreeMap<String, std::time::SystemTime> = BTreeMap::new();
    // Moments spread over the whole run by a fixed sequence; the speed of the machine varies the rest.
    for kill in 0..20u64 {
        let arguments = ["run", "recipe.toml", "--out", "out/street", "--store", "store", "--jobs", "2"];
        let mut child = cosfly(&arguments).within(street.path()).spawn();
        std::thread::sleep(Duration::from_millis(15 + (kill * 37) % 190));
        let _ = child.kill();
        let _ = child.wait();
        for (item, made) in finished(&store) {
            let before = *seen.entry(item.clone()).or_insert(made);
            assert_eq!(before, made, "finished item {item} was made again");
        }
    }
    run(&street, "out/street", &["--store", "store"]);
    let after = finished(&store);
    for (item, made) in &seen {
        assert_eq!(after.get(item), Some(made), "finished item {item} was lost or made again");
    }
    assert_eq!(tree_digests(&street.path().join("undisturbed")), tree_digests(&street.dataset()));
}

#[test]
fn two_processes_on_one_store_both_succeed() {
    let street = Street::new();
    let start = |out: &str| {
        cosfly(&["run", "recipe.toml", "--out", out, "--store", "store", "--jobs", "2"]).within(street.path()).spawn()
    };
    let (mut first, mut second) = (start("first"), start("second"));
    assert!(first.wait().expect("ends").success());
    assert!(second.wait().expect("ends").success());
    assert_eq!(tree_digests(&street.path().join("first")), tree_digests(&street.path().join("second")));
}

#[test]
fn a_termination_signal_stops_cleanly_and_the_next_run_goes_on() {
    let street = Street::new();
    let child = cosfly(&["run", "recipe.toml", "--store", "store", "--jobs", "1", "--set", "stages.walkers.count=40"])
        .within(street.path())
        .spawn();
    std::thread::sleep(Duration::from_millis(400));
    let mut child = child;
    let signalled =
        std::process::Command::new("kill").args(["-TERM", &child.id().to_string()]).status().expect("kill runs");
    assert!(signalled.success());
    assert_eq!(child.wait().expect("ends").code(), Some(130));
    let before = finished(&street.path().join("store"));
    run(&street, "out/street", &["--store", "store"]);
    let after = finished(&street.path().join("store"));
    assert!(before.iter().all(|(item, made)| after.get(item) == Some(made)));
}
