//! Six processes that do the same at the same moment: each command that writes leaves one whole result, and none is refused for what
//! another one of them made.

use crate::street::Street;
use crate::support::{Printed, cosfly, tree_digests};
use std::path::Path;
use std::sync::Barrier;

/// Processes at a time.
const PROCESSES: usize = 6;

/// Runs a command six times at once; `arguments` gets the number of the process.
fn at_once(folder: &Path, arguments: impl Fn(usize) -> Vec<String> + Sync) -> Vec<Printed> {
    let barrier = Barrier::new(PROCESSES);
    std::thread::scope(|scope| {
        let start = |number| {
            let (arguments, barrier) = (&arguments, &barrier);
            scope.spawn(move || {
                let call = cosfly(&arguments(number)).within(folder);
                barrier.wait();
                call.run()
            })
        };
        let started: Vec<_> = (0..PROCESSES).map(start).collect();
        started.into_iter().map(|process| process.join().expect("no panic")).collect()
    })
}

fn words(text: &str) -> Vec<String> {
    text.split_whitespace().map(str::to_owned).collect()
}

/// Runs a command six times at once, all of which succeed.
fn all_succeed(folder: &Path, arguments: &str) {
    for printed in at_once(folder, |_| words(arguments)) {
        assert_eq!(printed.code, Some(0), "{arguments}: {}", printed.stderr);
    }
}

/// Runs a command that makes a new folder six times at once: one makes it, the others say that it is there.
fn one_is_first(folder: &Path, arguments: &str, code: &str) {
    let printed = at_once(folder, |_| words(arguments));
    assert_eq!(printed.iter().filter(|it| it.code == Some(0)).count(), 1, "{arguments}");
    for other in printed.iter().filter(|it| it.code != Some(0)) {
        assert_eq!(other.code, Some(3), "{arguments}: {}", other.stderr);
        assert!(other.stderr.contains(&format!("error[{code}]")), "{arguments}: {}", other.stderr);
    }
}

/// Names in a folder that begin with a dot, but for the store.
fn left_over(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("readable").file_name());
    let names = entries.map(|name| name.to_string_lossy().into_owned());
    names.filter(|name| name.starts_with('.') && name != ".cosfly").collect()
}

#[test]
fn runs_into_one_folder_and_a_new_store_take_turns() {
    for _ in 0..2 {
        let street = Street::new();
        all_succeed(street.path(), "run recipe.toml --quiet --jobs 1 --set stages.walkers.count=1");
        let first = tree_digests(&street.dataset());
        cosfly(&[
            "run",
            "recipe.toml",
            "--quiet",
            "--set",
            "stages.walkers.count=1",
            "--out",
            "alone",
            "--store",
            "other",
        ])
        .within(street.path())
        .run_ok();
        assert_eq!(tree_digests(&street.path().join("alone")), first);
        assert_eq!(left_over(&street.path().join("out")), [""; 0]);
    }
}

#[test]
fn runs_into_one_folder_from_different_stores_all_end_whole() {
    let street = Street::new();
    let run = "run recipe.toml --quiet --jobs 1 --set stages.walkers.count=1";
    for printed in at_once(street.path(), |number| words(&format!("{run} --store store{number}"))) {
        assert_eq!(printed.code, Some(0), "{}", printed.stderr);
    }
    cosfly(&words(&format!("{run} --store store0 --out alone"))).within(street.path()).run_ok();
    assert_eq!(tree_digests(&street.dataset()), tree_digests(&street.path().join("alone")));
    assert_eq!(left_over(&street.path().join("out")), [""; 0]);
}

#[test]
fn what_is_made_of_a_dataset_is_whole() {
    let street = Street::new();
    let place = |name: &str| street.path().join(name);
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    cosfly(&["export", "out/street", "--format", "coco", "--out", "alone"]).within(street.path()).run_ok();
    cosfly(&["preview", "out/street", "--out", "pictures"]).within(street.path()).run_ok();
    for round in 0..3 {
        one_is_first(street.path(), &format!("export out/street --format coco --out export{round}"), "export-exists");
        assert_eq!(tree_digests(&place(&format!("export{round}"))), tree_digests(&place("alone")));
        all_succeed(street.path(), &format!("preview out/street --out preview{round}"));
        assert_eq!(tree_digests(&place(&format!("preview{round}"))), tree_digests(&place("pictures")));
        all_succeed(street.path(), &format!("eval out/street --out eval{round}"));
        assert_eq!(tree_digests(&place(&format!("eval{round}"))).len(), 3);
        all_succeed(street.path(), &format!("map inspect street.xodr --plan plan{round}.png"));
        all_succeed(street.path(), &format!("carla-job out/street --out job{round}.jsonl"));
        at_once(street.path(), |_| words(&format!("doctor out/street --out doctor{round}.json")));
        let findings = std::fs::read(place(&format!("doctor{round}.json"))).expect("findings");
        serde_json::from_slice::<serde_json::Value>(&findings).expect("JSON");
        all_succeed(street.path(), &format!("dataset tag v{round} recipe.toml"));
        all_succeed(street.path(), &format!("dataset checkout v{round} --out checkout{round}"));
        assert_eq!(tree_digests(&place(&format!("checkout{round}"))), tree_digests(&street.dataset()));
    }
    assert_eq!(left_over(street.path()), [""; 0]);
}

#[test]
fn shares_of_an_evaluation_and_rounds_of_labels_start_at_once() {
    let street = Street::new();
    let place = |name: &str| street.path().join(name);
    let fly = "fly recipe.toml --policy hold --quiet --jobs 1 --clips 1";
    cosfly(&words(&format!("{fly} --out alone"))).within(street.path()).run_ok();
    for round in 0..5 {
        let shares = at_once(street.path(), |number| {
            words(&format!("{fly} --out shares{round} --shard {}/{PROCESSES}", number + 1))
        });
        for share in shares {
            assert_eq!(share.code, Some(0), "{}", share.stderr);
        }
        assert_eq!(tree_digests(&place(&format!("shares{round}"))), tree_digests(&place("alone")));
        all_succeed(street.path(), &format!("{fly} --out same{round}"));
        assert_eq!(tree_digests(&place(&format!("same{round}"))), tree_digests(&place("alone")));
    }
    let dagger = "dagger recipe.toml --policy hold --jobs 1 --expert-share 0.5";
    cosfly(&words(&format!("{dagger} --round a --out labels"))).within(street.path()).run_ok();
    for round in 0..2 {
        all_succeed(street.path(), &format!("{dagger} --round a --out first{round}"));
        assert_eq!(tree_digests(&place(&format!("first{round}"))), tree_digests(&place("labels")));
        all_succeed(street.path(), &format!("{dagger} --round b --onto labels --out second{round}"));
    }
    assert_eq!(tree_digests(&place("second0")), tree_digests(&place("second1")));
    std::fs::create_dir(place("board")).expect("a folder");
    cosfly(&words("fly bundle alone/hold --out board/hold.jsonl.zst")).within(street.path()).run_ok();
    let leaderboard = "leaderboard board --suite recipe.toml --jobs 1";
    cosfly(&words(&format!("{leaderboard} --store other --out page.html"))).within(street.path()).run_ok();
    for round in 0..2 {
        all_succeed(street.path(), &format!("{leaderboard} --out page{round}.html"));
        let page = |name: &str| std::fs::read(place(name)).expect("a page");
        assert!(page(&format!("page{round}.html")) == page("page.html"));
    }
    assert_eq!(left_over(street.path()), [""; 0]);
}

#[test]
fn new_folders_are_whole_and_one_process_is_first() {
    let folder = tempfile::tempdir().expect("scratch");
    for round in 0..3 {
        one_is_first(folder.path(), &format!("init flights{round} --template small"), "init-exists");
        assert!(folder.path().join(format!("flights{round}/recipe.toml")).is_file());
        #[cfg(feature = "plugins")]
        {
            one_is_first(folder.path(), &format!("plugin new --kind stage keep{round}"), "plugin-exists");
            assert!(folder.path().join(format!("keep{round}/sdk/src/town.rs")).is_file());
        }
    }
    assert_eq!(left_over(folder.path()), [""; 0]);
}
