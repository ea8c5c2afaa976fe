//! Files of a store that are lost or damaged: their content is made again.

use super::*;
use cosfly_runner::RunOutcome;
use cosfly_runner::deliver;
use std::fs;
use std::path::{Path, PathBuf};

fn files_below(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() { files_below(&path, found) } else { found.push(path) }
    }
}

/// Replaces a file (not the other links to it).
fn replace(path: &Path, bytes: &[u8]) {
    fs::remove_file(path).unwrap();
    fs::write(path, bytes).unwrap();
}

#[test]
fn whatever_file_is_damaged_the_next_run_delivers_the_right_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let (root, out) = (folder.path().join("store"), folder.path().join("out"));
    let toys = town_toys(2, &Log::default());
    let run_once = |toys: &[Toy]| {
        let store = Store::open(&root).unwrap();
        let delivery = deliver(&recipe(toys), &store, 4, &out, &options(2), &|_| {}).unwrap();
        assert_eq!(delivery.summary.outcome, RunOutcome::Complete);
        assert!(delivery.folder.is_some());
        fs::read(out.join("out")).unwrap()
    };
    let reference = run_once(&toys);
    let mut files = Vec::new();
    files_below(&root, &mut files);
    files.retain(|path| !path.ends_with("format") && !path.starts_with(root.join("locks")));
    assert!(files.len() > 30);
    for (number, file) in files.iter().enumerate() {
        let Ok(whole) = fs::read(file) else { continue };
        match number % 4 {
            0 => fs::remove_file(file).unwrap(),
            1 => replace(file, &whole[..whole.len() / 2]),
            2 => replace(file, b""),
            _ => {
                let mut flipped = whole.clone();
                flipped[whole.len() / 3] ^= 1;
                replace(file, &flipped);
            }
        }
        // A changed last stage reads its inputs, and the folder has to be made anew.
        let mut changed = town_toys(2, &Log::default());
        changed[4].parameters = json!({ "number": number });
        run_once(&changed);
        assert_eq!(run_once(&toys), reference, "{}", file.display());
    }
}

#[test]
fn a_lost_chain_of_blobs_is_made_again_from_its_beginning() {
    let (_folder, store) = fresh_store();
    let log = Log::default();
    let mut toys = town_toys(3, &log);
    let reference = run_quietly(&recipe(&toys), &store);
    log.take();
    for stage in ["town", "walkers", "expert"] {
        for (_, finished) in reference.finished_items(at(&toys, stage)) {
            for blob in finished.record.outputs.values() {
                let hex = blob.digest.to_string();
                fs::remove_file(store.root().join("cas").join(&hex[..2]).join(&hex)).unwrap();
            }
        }
    }
    toys[3].parameters = json!({ "new": 1 });
    let summary = run_quietly(&recipe(&toys), &store);
    assert_eq!(summary.outcome, RunOutcome::Complete);
    assert_eq!(counts(&summary), [11, 0, 0, 0, 0, 0]);
    let (before, after) = (records(&reference), records(&summary));
    assert!(
        before
            .iter()
            .filter(|(task, _)| !task.starts_with("noisy"))
            .all(|(task, record)| { task.starts_with("dataset") || after[task] == *record })
    );
}

#[test]
fn a_blob_damaged_during_the_run_is_made_again_before_its_reader_goes_on() {
    let (_folder, store) = fresh_store();
    let log = Log::default();
    let mut toys = town_toys(2, &log);
    run_quietly(&recipe(&toys), &store);
    log.take();
    // The size stays right, so the damage shows only when the experts read the town.
    let store = Store::open(store.root()).unwrap();
    let town = records(&run_quietly(&recipe(&toys), &store))["town/i00000"].outputs["out"];
    let hex = town.digest.to_string();
    replace(&store.root().join("cas").join(&hex[..2]).join(&hex), &vec![b'x'; town.bytes as usize]);
    toys[2].parameters = json!({ "new": 1 });
    let summary = run(&recipe(&toys), &store, &options(1), &|_| {}).unwrap();
    assert_eq!(summary.outcome, RunOutcome::Complete);
    let ran = log.take();
    assert_eq!(ran.iter().filter(|task| *task == "town/i00000").count(), 1, "{ran:?}");
    assert!(!ran.iter().any(|task| task.starts_with("walkers")), "{ran:?}");
}

#[test]
fn records_that_were_exchanged_are_not_believed() {
    for area in ["ac", "done", "plan"] {
        let (_folder, store) = fresh_store();
        let log = Log::default();
        let recipe = recipe(&town_toys(3, &log));
        let reference = records(&run_quietly(&recipe, &store));
        let mut files = Vec::new();
        files_below(&store.root().join(area), &mut files);
        let contents: Vec<Vec<u8>> = files.iter().map(|path| fs::read(path).unwrap()).collect();
        for (number, path) in files.iter().enumerate() {
            replace(path, &contents[(number + 1) % files.len()]);
        }
        fs::remove_dir_all(store.root().join("index")).unwrap();
        log.take();
        let summary = run_quietly(&recipe, &Store::open(store.root()).unwrap());
        assert_eq!(summary.outcome, RunOutcome::Complete, "{area}");
        assert_eq!(records(&summary), reference, "{area}");
        assert_eq!(log.take().len(), if area == "ac" { 11 } else { 0 }, "{area}");
    }
}

#[test]
fn a_delivered_file_that_was_edited_through_its_link_is_made_again() {
    let folder = tempfile::tempdir().unwrap();
    let (root, out) = (folder.path().join("store"), folder.path().join("out"));
    let log = Log::default();
    let toys = town_toys(2, &log);
    let run_once = || {
        let store = Store::open(&root).unwrap();
        deliver(&recipe(&toys), &store, 4, &out, &options(2), &|_| {}).unwrap().folder.unwrap()
    };
    assert!(run_once().changed && !run_once().changed);
    log.take();
    let path = out.join("out");
    let whole = fs::read(&path).unwrap();
    let (metadata, mut edited) = (fs::metadata(&path).unwrap(), whole.clone());
    edited[0] ^= 1;
    let mut permissions = metadata.permissions();
    #[expect(clippy::permissions_set_readonly_false, reason = "a file of a test")]
    permissions.set_readonly(false);
    fs::set_permissions(&path, permissions).unwrap();
    fs::write(&path, &edited).unwrap();
    fs::File::options().write(true).open(&path).unwrap().set_modified(metadata.modified().unwrap()).unwrap();
    assert!(run_once().changed);
    assert_eq!(fs::read(&path).unwrap(), whole);
    assert!(log.take().contains(&"dataset/i00000".to_owned()));
    assert!(!run_once().changed);
    let inside = deliver(&recipe(&toys), &Store::open(&root).unwrap(), 4, &root.join("x"), &options(1), &|_| {});
    assert_eq!(inside.err().unwrap().code, "out-in-store");
}
