//! Leaves of toy recipes: their numbers, dependencies and files.

use cosfly_cluster::{Command, Leaf, Request, RequestChange, job_file, json_lines, kept_stages, leaves, requests_of};
use cosfly_fingerprint::Digest;
use cosfly_recipe::Recipe;
use cosfly_runner::{RunOptions, plan, run_tasks};
use cosfly_stage::{Fan, Registry};
use cosfly_store::Store;
use cosfly_toys::{Toy, ToyKind, toy_recipe};
use std::collections::{BTreeMap, BTreeSet};

/// A town, walks in it, experts, an album of all experts for each of three critics, a dataset of the critics.
fn recipe() -> Recipe {
    let toys = [
        Toy::new("town", 1, &[]),
        Toy::new("walks", 5, &[(0, Fan::Broadcast)]),
        Toy::new("expert", 0, &[(1, Fan::Each), (0, Fan::Broadcast)]),
        Toy::new("critics", 3, &[(2, Fan::Gather)]),
        Toy::new("dataset", 1, &[(3, Fan::Gather), (2, Fan::Gather)]),
        Toy::new("after", 1, &[(4, Fan::Broadcast)]),
    ];
    toy_recipe("toys", 7, &toys).unwrap()
}

fn requests(recipe: &Recipe) -> Vec<Request> {
    let changes = ["walks:batch=2,time=1h,memory=2GB", "expert:cpus=4,gpus=1,batch=2"].map(RequestChange::read);
    let changes: Vec<RequestChange> = changes.into_iter().map(Result::unwrap).collect();
    requests_of(recipe, &changes).unwrap()
}

fn store() -> (tempfile::TempDir, Store) {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(folder.path()).unwrap();
    (folder, store)
}

fn all_leaves(recipe: &Recipe, store: &Store, failed: &[Digest]) -> Vec<Leaf> {
    let plan = plan(recipe, store).unwrap();
    let leaves = leaves(&plan, &kept_stages(&plan, 4), |digest| failed.contains(digest), &requests(recipe));
    assert_well_formed(&leaves);
    leaves
}

/// Numbers are unique, and what a leaf depends on comes before it.
fn assert_well_formed(leaves: &[Leaf]) {
    let mut before = BTreeSet::new();
    for leaf in leaves {
        assert!(leaf.deps.iter().all(|dep| before.contains(dep)), "{leaf:?}");
        assert!(leaf.deps.is_sorted() && before.insert(leaf.id), "{leaf:?}");
        assert_eq!(leaf.tasks.len(), leaf.plans.len());
    }
}

fn shape(leaves: &[Leaf]) -> Vec<(u32, &str, Vec<u32>)> {
    leaves.iter().map(|leaf| (leaf.id, leaf.name.as_str(), leaf.deps.clone())).collect()
}

#[test]
fn leaves_hold_batches_and_barriers_stand_between_many_and_many() {
    let (_folder, store) = store();
    let recipe = recipe();
    let expected = [
        (1, "town/i00000", vec![]),
        (2, "walks/i00000 + 1", vec![1]),
        (3, "walks/i00002 + 1", vec![1]),
        (4, "walks/i00004", vec![1]),
        (5, "expert/i00000 + 1", vec![1, 2]),
        (6, "expert/i00002 + 1", vec![1, 3]),
        (7, "expert/i00004", vec![1, 4]),
        (15, "all of expert", vec![5, 6, 7]),
        (8, "critics/i00000", vec![15]),
        (9, "critics/i00001", vec![15]),
        (10, "critics/i00002", vec![15]),
    ];
    assert_eq!(shape(&all_leaves(&recipe, &store, &[])), expected);
}

#[test]
fn numbers_stay_when_some_tasks_are_finished_and_what_reads_failed_ones_is_left_out() {
    let (_folder, store) = store();
    let recipe = recipe();
    let planned = plan(&recipe, &store).unwrap();
    planned.publish_documents(&store).unwrap();
    let done = [planned.stages[0].plans[0], planned.stages[1].plans[0], planned.stages[1].plans[1]];
    let registry = Registry::new(vec![Box::new(ToyKind { version: 1 })]);
    let ends = run_tasks(&store, &registry, &done, &RunOptions::default()).unwrap();
    assert!(ends.iter().all(Result::is_ok));
    let expected = [
        (3, "walks/i00002", vec![]),
        (4, "walks/i00004", vec![]),
        (5, "expert/i00000 + 1", vec![]),
        (6, "expert/i00002", vec![3]),
        (7, "expert/i00004", vec![4]),
    ];
    assert_eq!(shape(&all_leaves(&recipe, &store, &[planned.stages[1].plans[3]])), expected);
}

#[test]
fn a_thousand_leaves_that_read_a_thousand_have_few_dependencies() {
    let (_folder, store) = store();
    let toys = [Toy::new("films", 1000, &[]), Toy::new("critics", 1000, &[(0, Fan::Gather)])];
    let recipe = toy_recipe("toys", 7, &toys).unwrap();
    let plan = plan(&recipe, &store).unwrap();
    let leaves = leaves(&plan, &BTreeSet::new(), |_| false, &[Request::default(); 2]);
    assert_well_formed(&leaves);
    assert_eq!(leaves.iter().map(|leaf| leaf.deps.len()).sum::<usize>(), 2000);
}

#[test]
fn cheap_stages_whose_items_read_each_other_share_commands() {
    let (_folder, store) = store();
    let toys = [
        Toy::new("town", 1, &[]),
        Toy::new("walks", 5, &[(0, Fan::Broadcast)]),
        Toy::new("expert", 0, &[(1, Fan::Each), (0, Fan::Broadcast)]),
        Toy::new("twins", 0, &[(2, Fan::Each), (1, Fan::Each)]),
        Toy::new("critics", 5, &[(2, Fan::Gather)]),
        // Reads all of a stage that is not finished before the chain begins.
        Toy::new("scores", 0, &[(3, Fan::Each), (4, Fan::Gather)]),
    ];
    let recipe = toy_recipe("toys", 7, &toys).unwrap();
    let shape_of = |change: &str| {
        let requests = requests_of(&recipe, &[RequestChange::read(change).unwrap()]).unwrap();
        let leaves = leaves(&plan(&recipe, &store).unwrap(), &BTreeSet::new(), |_| false, &requests);
        assert_well_formed(&leaves);
        leaves
    };
    let expected = [
        (1, "town/all", vec![]),
        (2, "walks/i00000 + 8", vec![1]),
        (3, "walks/i00003 + 5", vec![1]),
        (20, "all of expert", vec![2, 3]),
        (8, "critics/i00000 + 2", vec![20]),
        (9, "critics/i00003 + 1", vec![20]),
        (22, "all of critics", vec![8, 9]),
        (10, "scores/i00000 + 2", vec![2, 22]),
        (11, "scores/i00003 + 1", vec![3, 22]),
    ];
    let leaves = shape_of("*:batch=3");
    let found: Vec<_> = shape(&leaves).into_iter().map(|(id, name, deps)| (id, name.to_owned(), deps)).collect();
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for ((_, name, deps), (_, expected, before)) in found.iter().zip(expected) {
        assert_eq!(
            (name.replace("i00000 + 0", "all").replace("town/i00000", "town/all"), deps.len()),
            (expected.to_owned(), before.len())
        );
    }
    let first = &leaves[1];
    assert_eq!(first.tasks, [1, 2, 3].iter().flat_map(|stage| (0..3).map(|item| (*stage, item))).collect::<Vec<_>>());
    assert_eq!(shape_of("*:batch=1").iter().filter(|leaf| !leaf.tasks.is_empty()).count(), 26);
}

fn command() -> Command {
    Command { program: vec!["/opt/a \"b\"/cosfly".to_owned()], store: "/shared/store".to_owned() }
}

/// Plan digests as short words: they change with every version of a stage.
fn with_short_digests(mut text: String, leaves: &[Leaf]) -> String {
    let digests: BTreeMap<Digest, String> = leaves
        .iter()
        .flat_map(|leaf| {
            leaf.plans.iter().zip(&leaf.tasks).map(move |(plan, (_, item))| (*plan, format!("{}.{item}", leaf.id)))
        })
        .collect();
    for (digest, word) in digests {
        text = text.replace(&digest.to_string(), &word);
    }
    text
}

#[test]
fn the_job_file_is_as_held() {
    let (_folder, store) = store();
    let leaves = all_leaves(&recipe(), &store, &[]);
    let chosen: Vec<Leaf> = leaves.iter().filter(|leaf| [2, 5, 15].contains(&leaf.id)).cloned().collect();
    let text = with_short_digests(job_file("toys", &chosen, &command()), &leaves);
    let expected = r#"name = "toys"

[[task]]
id = 2
command = ["/opt/a \"b\"/cosfly", "task", "run", "--store", "/shared/store", "--jobs", "1", "2.0", "2.1"]
deps = [1]
stdout = "none"
stderr = "none"
crash_limit = 8
[[task.request]]
resources = { cpus = 1, mem = 2048 }
time_request = "3600s"

[[task]]
id = 5
command = ["/opt/a \"b\"/cosfly", "task", "run", "--store", "/shared/store", "--jobs", "4", "5.0", "5.1"]
deps = [1, 2]
stdout = "none"
stderr = "none"
crash_limit = 8
[[task.request]]
resources = { cpus = 4, "gpus/nvidia" = 1 }

[[task]]
id = 15
command = ["/opt/a \"b\"/cosfly", "task", "run", "--store", "/shared/store", "--jobs", "1"]
deps = [5, 6, 7]
stdout = "none"
stderr = "none"
crash_limit = 8
[[task.request]]
resources = { cpus = 1 }
"#;
    assert_eq!(text, expected);
}

#[test]
fn json_lines_name_command_dependencies_and_resources() {
    let (_folder, store) = store();
    let leaves = all_leaves(&recipe(), &store, &[]);
    let text = with_short_digests(json_lines(&leaves[4..5], &command()), &leaves);
    let expected = concat!(
        r#"{"command":["/opt/a \"b\"/cosfly","task","run","--store","/shared/store","--jobs","4","5.0","5.1"],"#,
        r#""cpus":4,"deps":[1,2],"gpus":1,"id":5,"memory_mib":0,"name":"expert/i00000 + 1","time_s":0}"#,
        "\n"
    );
    assert_eq!(text, expected);
}

#[test]
fn a_request_for_an_unknown_stage_is_refused_with_the_known_ones() {
    let change = RequestChange::read("film:cpus=2").unwrap();
    let refusal = requests_of(&recipe(), &[change]).unwrap_err();
    assert_eq!(refusal.code, "request-unknown-stage");
    assert!(refusal.hints[0].contains("`critics`"), "{refusal:?}");
}
