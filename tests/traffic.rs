//! Traffic through the real binary: the shipped recipe, smaller, is verified; its bytes depend on nothing but the recipe.

use crate::people;
use crate::support::{Call, cosfly, tree_digests};
use std::path::Path;

const SMALL: [&str; 8] = [
    "stages.street.frames=50",
    "stages.street.people.count=60",
    "stages.street.vehicles.count=12",
    "stages.street.follow.count=3",
    "stages.street.follow.min_length_m=5",
    "stages.frames.width=160",
    "stages.frames.height=96",
    "stages.frames.look=simple",
];

/// A run of the recipe, smaller and with further changes.
fn run(folder: &Path, recipe: &str, out: &str, changes: &[&str]) -> Call {
    let at = |name: &str| folder.join(name).display().to_string();
    let mut arguments: Vec<String> = ["run", recipe, "--json"].map(str::to_owned).to_vec();
    arguments.extend(["--store".to_owned(), at("store"), "--out".to_owned(), at(out)]);
    for change in SMALL.iter().filter(|_| recipe.ends_with("busy_street.toml")).chain(changes) {
        arguments.extend(["--set".to_owned(), (*change).to_owned()]);
    }
    cosfly(&arguments)
}

fn made(printed: &str) -> Vec<(String, u64)> {
    let summary: serde_json::Value = serde_json::from_str(printed).expect("a JSON summary");
    let stages = summary["stages"].as_array().expect("stages").iter();
    let ran = stages.map(|it| (it["stage"].as_str().expect("name").to_owned(), it["ran"].as_u64().expect("count")));
    ran.filter(|(_, ran)| *ran > 0).collect()
}

#[test]
fn a_busy_street_is_verified_and_further_flights_change_no_earlier_one() {
    let folder = tempfile::tempdir().expect("scratch");
    let natural = ["stages.street.look_alikes.shares=[]"];
    run(folder.path(), "recipes/busy_street.toml", "out", &natural).run_ok();
    let out = folder.path().join("out");
    cosfly(&["verify", out.to_str().expect("UTF-8")]).run_ok();
    for table in ["bodies", "target_losses", "phrases"] {
        assert!(out.join("data").join(table).is_dir(), "{table}");
    }
    let more = [natural[0], "stages.street.follow.count=4"];
    let printed = run(folder.path(), "recipes/busy_street.toml", "more", &more).run_ok().stdout;
    let made = made(&printed);
    for stage in ["street", "expert", "expert.trials", "frames"] {
        assert!(made.contains(&(stage.to_owned(), 1)), "{stage}: {made:?}");
    }
    assert!(!made.iter().any(|(stage, _)| stage == "street.bodies"), "{made:?}");
}

#[test]
fn traffic_has_the_same_bytes_on_one_thread_and_on_three() {
    let digests = |jobs: &str| {
        let folder = tempfile::tempdir().expect("scratch");
        let at = |name: &str| folder.path().join(name).display().to_string();
        let mut arguments = vec!["run", "recipes/busy_street.toml", "--quiet", "--jobs", jobs];
        SMALL.iter().for_each(|change| arguments.extend_from_slice(&["--set", change]));
        let (store, out) = (at("store"), at("out"));
        arguments.extend_from_slice(&["--store", &store, "--out", &out]);
        cosfly(&arguments).run_ok();
        tree_digests(&folder.path().join("out"))
    };
    assert_eq!(digests("1"), digests("3"));
}

#[test]
fn a_filter_hands_on_the_bodies_around_a_flight() {
    let folder = tempfile::tempdir().expect("scratch");
    let recipes = crate::support::repository_root().join("recipes");
    let street = std::fs::read_to_string(recipes.join("busy_street.toml")).expect("the recipe");
    let keep = "\n[stages.expert]\nuse = \"wasm:RECIPES/plugins/keep_good.wasm\"\ninputs = { town = \"town\", trajectories = \"planned\" }\n\
                params.rules = [{ column = \"visibility\", of = \"mean\", at_least = 0.0 }]\n";
    let filtered =
        street.replace("source = \"", "source = \"RECIPES/").replace("[stages.expert]", "[stages.planned]") + keep;
    // Flights differ by the name of their stage, and pictures with them: it is the same in both.
    let plain = street.replace("source = \"", "source = \"RECIPES/").replace("stages.expert", "stages.planned");
    let plain = plain.replace("\"expert\"", "\"planned\"");
    let written = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text.replace("RECIPES", &recipes.display().to_string())).expect("written");
        path.display().to_string()
    };
    let (plain, filtered) = (written("plain.toml", &plain), written("filtered.toml", &filtered));
    let changes = ["stages.street.follow.kinds=[\"car\"]", "stages.street.follow.count=2"];
    let rows = |recipe: &str, out: &str| {
        run(folder.path(), recipe, out, &changes).run_ok();
        let out = folder.path().join(out);
        cosfly(&["verify", out.to_str().expect("UTF-8")]).run_ok();
        people::rows(&out, "bodies", "body_id", "frame")
    };
    assert_eq!(rows(&plain, "plain"), rows(&filtered, "kept"));
}

#[test]
fn tracks_that_cannot_be_used_are_named_with_their_line() {
    let folder = tempfile::tempdir().expect("scratch");
    let recipe = "name = \"tracks\"\nseed = 1\n[stages.town]\nuse = \"map\"\nsource = \"MAP\"\n[stages.street]\nuse = \"traffic\"\n\
                  inputs.town = \"town\"\nframes = 4\npeople.count = 0\nvehicles.count = 0\nrecorded = [{ source = \"tracks.csv\" }]\n";
    let map = crate::support::repository_root().join("recipes/towns/downtown.xodr");
    std::fs::write(folder.path().join("recipe.toml"), recipe.replace("MAP", &map.display().to_string()))
        .expect("written");
    std::fs::write(folder.path().join("tracks.csv"), "t,id,x,y\n0,a,1,2\n1,a,nan,2\n").expect("written");
    let recipe = folder.path().join("recipe.toml");
    let printed = run(folder.path(), recipe.to_str().expect("UTF-8"), "out", &[]).run();
    assert_ne!(printed.code, Some(0));
    assert!(printed.stderr.contains("tracks.csv") && printed.stderr.contains("line 3"), "{}", printed.stderr);
}

#[test]
fn scripted_people_are_followed_by_their_names() {
    let folder = tempfile::tempdir().expect("scratch");
    let recipe = "name = \"named\"\nseed = 1\n[stages.town]\nuse = \"map\"\nsource = \"MAP\"\n[stages.street]\nuse = \"traffic\"\n\
                  inputs.town = \"town\"\nframes = 20\npeople.count = 5\nvehicles.count = 0\nfollow = { count = 1, named = [\"Ada\"] }\n\
                  scripted = [{ id = \"Ada\", route = [{ at_m = [16.0, 1.0] }, { at_m = [56.0, 6.0] }] }]\n";
    let map = crate::support::repository_root().join("recipes/towns/downtown.xodr");
    let path = folder.path().join("recipe.toml");
    std::fs::write(&path, recipe.replace("MAP", &map.display().to_string())).expect("written");
    let path = path.to_str().expect("UTF-8");
    let printed = run(folder.path(), path, "out", &[]).run_ok();
    assert_eq!(made(&printed.stdout).iter().find(|it| it.0 == "street").map(|it| it.1), Some(1));
    let refused = run(folder.path(), path, "eve", &["stages.street.follow.named=[\"Eve\"]"]).run();
    assert!(refused.stderr.contains("nobody is called so") && refused.stderr.contains("`Ada`"), "{}", refused.stderr);
    let off = run(
        folder.path(),
        path,
        "off",
        &["stages.street.scripted=[{ id = \"Ada\", route = [{ at_m = [10.0, 6.0] }] }]"],
    );
    assert!(off.run().stderr.contains("the nearest is"));
}
