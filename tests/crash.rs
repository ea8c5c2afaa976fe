//! Reproducible bytes: any number of jobs, repeated runs, after kill -9 at random moments, while the dataset is published and
//! delivered as well; finished items are not made again.

use crate::street::Street;
use crate::support::{cosfly, tree_digests};
use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

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

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_run_within_seconds_in_the_middle_of_an_item_and_the_next_run_goes_on() {
    let street = Street::new();
    // A walk of hours: it takes minutes to simulate and to plan behind.
    let endless = [
        "run",
        "recipe.toml",
        "--out",
        "out",
        "--set",
        "stages.walkers.count=1",
        "--set",
        "stages.walkers.frames=40000",
    ];
    stops_soon(cosfly(&endless).within(street.path()));
    run(&street, "out", &[]);
}

/// Sends Ctrl-C to a call that would take minutes, and expects its end.
#[cfg(unix)]
fn stops_soon(call: crate::support::Call) {
    let mut running = call.spawn();
    std::thread::sleep(Duration::from_secs(4));
    assert!(running.try_wait().expect("a state").is_none(), "it is at work");
    let asked = Instant::now();
    let sent = std::process::Command::new("kill").args(["-INT", &running.id().to_string()]).status().expect("a signal");
    assert!(sent.success());
    let ended = running.wait().expect("an end");
    assert_eq!(ended.code(), Some(130));
    // Two seconds are promised; a busy machine gets more.
    assert!(asked.elapsed() < Duration::from_secs(10), "{:?}", asked.elapsed());
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_the_regeneration_of_a_flight_and_leaves_nothing_behind() {
    let street = Street::new();
    run(&street, "out", &[]);
    let scratch = street.path().join("scratch");
    std::fs::create_dir(&scratch).expect("writable");
    // Anew, the walk takes hours.
    let endless = [
        &["verify", "out", "--regenerate", "1", "--recipe", "."][..], // the folder of the recipe
        &["--set", "stages.walkers.count=1", "--set", "stages.walkers.frames=40000"],
    ];
    let scratch_text = scratch.to_str().expect("UTF-8");
    stops_soon(cosfly(&endless.concat()).within(street.path()).with("TMPDIR", scratch_text));
    assert_eq!(std::fs::read_dir(&scratch).expect("readable").count(), 0, "the store of the flight is gone");
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

/// Kills of the whole check.
const KILLS: usize = 50;
/// Kills after which the store and the output folder begin anew.
const KILLS_OF_A_STORE: usize = 10;
/// The first of them fall anywhere; the others wait for the output folder to be built and fall into its delivery.
const ANYWHERE: usize = 6;

/// Least time over which the moments of kills are spread.
const SHORTEST_SPAN: Duration = Duration::from_millis(10);

/// Two datasets of one recipe: they differ in their titles, so that a finished run has something to publish and deliver again.
const TITLES: [&str; 2] = ["one", "two"];

/// Files of the two datasets of an undisturbed run, and the longest run.
fn undisturbed(street: &Street) -> ([Files; 2], Duration) {
    let mut longest = Duration::ZERO;
    let files = TITLES.map(|title| {
        let began = Instant::now();
        run(street, title, &["--store", "store-undisturbed", "--set", &title_of(title)]);
        longest = longest.max(began.elapsed());
        tree_digests(&street.path().join(title))
    });
    (files, longest)
}

type Files = Vec<(String, String)>;

fn title_of(title: &str) -> String {
    format!("stages.dataset.title=\"{title}\"")
}

/// Whether the output folder is being made: beside its place for the first time, and of its spare in the store later.
fn is_under_way(street: &Street, beside: &Path) -> bool {
    let unfinished = |spare: std::fs::DirEntry| !spare.path().join(".cosfly-version").exists();
    let spares = std::fs::read_dir(street.path().join("store/spare"));
    beside.exists() || spares.is_ok_and(|mut spares| spares.any(|spare| spare.is_ok_and(unfinished)))
}

/// Starts a run and kills it after `pause`, or, with `beside`, as soon as the output folder is being made. `false` where it had
/// ended.
fn kill_one(street: &Street, title: &str, pause: Duration, beside: Option<&Path>) -> bool {
    let arguments =
        ["run", "recipe.toml", "--out", "out/street", "--store", "store", "--jobs", "2", "--set", &title_of(title)];
    let mut child = cosfly(&arguments).within(street.path()).spawn();
    match beside {
        None => std::thread::sleep(pause),
        Some(folder) => while !is_under_way(street, folder) && child.try_wait().expect("a child").is_none() {},
    }
    let was_running = child.try_wait().expect("a child").is_none();
    let _ = child.kill();
    let _ = child.wait();
    was_running
}

/// The delivered folder is one of the datasets, to the byte; a folder on its way there is whole, or does not look whole.
/// `true` where the kill fell into the delivery.
fn check_output(street: &Street, datasets: &[Files; 2], beside: &Path) -> bool {
    let dataset = street.dataset();
    if dataset.exists() {
        let found = tree_digests(&dataset);
        assert!(datasets.contains(&found), "the delivered folder is neither dataset: {found:#?}");
    }
    if beside.exists() {
        // The file with the folder's version is written last: without it, all files of the dataset are there.
        let of_dataset = |mut files: Files| {
            files.retain(|(name, _)| name != ".cosfly-version");
            files
        };
        let found = of_dataset(tree_digests(beside));
        if datasets.iter().all(|files| of_dataset(files.clone()) != found) {
            let verified = cosfly(&["verify", &beside.to_string_lossy()]).within(street.path()).run();
            assert_ne!(verified.code, Some(0), "a half-written folder looks whole:\n{}\n{found:#?}", verified.stdout);
        }
    }
    is_under_way(street, beside)
}

#[test]
fn fifty_kills_lose_no_finished_item_and_change_no_byte() {
    let street = Street::new();
    let (datasets, longest) = undisturbed(&street);
    let beside = street.path().join("out/.street.cosfly-tmp");
    let (mut kills, mut tries, mut in_delivery) = (0, 0, 0);
    while kills < KILLS {
        let store = street.path().join("store");
        let mut seen: BTreeMap<String, std::time::SystemTime> = BTreeMap::new();
        let (first, mut title, mut span) = (kills, TITLES[0], longest);
        while kills < KILLS.min(first + KILLS_OF_A_STORE) {
            tries += 1;
            assert!(tries < 10 * KILLS, "only {kills} of {tries} runs were killed");
            // Moments spread over a whole run by a fixed sequence; the speed of the machine varies the rest.
            let pause = span.mul_f64(f64::from((tries as u32 * 37) % 101) / 101.0);
            let waits = (kills - first >= ANYWHERE).then_some(beside.as_path());
            // What an earlier kill left half way says nothing about this run.
            let waits = waits.filter(|beside| !is_under_way(&street, beside));
            let was_running = kill_one(&street, title, pause, waits);
            kills += usize::from(was_running);
            if !was_running {
                // Finished items make the next run shorter.
                span = (span / 2).max(SHORTEST_SPAN);
                title = TITLES[usize::from(title == TITLES[0])];
            }
            in_delivery += usize::from(check_output(&street, &datasets, &beside));
            for (item, made) in finished(&store) {
                let before = *seen.entry(item.clone()).or_insert(made);
                assert_eq!(before, made, "finished item {item} was made again");
            }
        }
        for (title, files) in TITLES.iter().zip(&datasets) {
            run(&street, "out/street", &["--store", "store", "--set", &title_of(title)]);
            assert_eq!(*files, tree_digests(&street.dataset()));
        }
        let after = finished(&store);
        for (item, made) in &seen {
            assert_eq!(after.get(item), Some(made), "finished item {item} was lost or made again");
        }
        for folder in ["store", "out"] {
            std::fs::remove_dir_all(street.path().join(folder)).expect("removable");
        }
    }
    assert!(in_delivery > 0, "none of the kills fell into the delivery");
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
