//! One dataset from several towns: whole towns in one split, and errors of towns that cannot be combined.

use crate::street::{RECIPE, Street, map};
use crate::support::cosfly;
use std::collections::BTreeSet;
use std::os::unix::fs::MetadataExt;
use std::path::Path;

/// The street's recipe with a second town and its stages, whose names begin with `far_`. The dataset's line of inputs
/// is `inputs`.
fn recipe_of_two_towns(inputs: &str) -> String {
    let (chain, dataset) = RECIPE.split_at(RECIPE.find("[stages.captions]").expect("it has captions"));
    let (_, chain) = chain.split_at(chain.find("[stages.town]").expect("it has a town"));
    let mut far = chain.replace("street.xodr", "far.xodr").replace("[stages.", "[stages.far_");
    for name in ["town", "walkers", "expert", "perturbed"] {
        far = far.replace(&format!("\"{name}\""), &format!("\"far_{name}\""));
    }
    let captions = "\"expert\", \"perturbed\", \"far_expert\", \"far_perturbed\"";
    let old_inputs = "inputs = { town = \"town\", frames = \"frames\", captions = \"captions\" }";
    let dataset = dataset.replace("\"expert\", \"perturbed\"", captions).replace(old_inputs, inputs);
    format!("name = \"street\"\nseed = 3\n\n{chain}{far}{dataset}")
}

const BOTH: &str =
    "inputs = { town = [\"town\", \"far_town\"], frames = [\"frames\", \"far_frames\"], captions = \"captions\" }";

/// The street, four kilometres away and with a bend: another place.
fn far_map() -> String {
    map().replace("x=\"0.0\"", "x=\"4000.0\"").replace("x=\"0\"", "x=\"4000\"")
}

fn two_towns(inputs: &str, far: &str) -> Street {
    let street = Street::with(&recipe_of_two_towns(inputs), &map());
    std::fs::write(street.path().join("far.xodr"), far).expect("writable");
    street
}

/// Messages of a rejected run.
fn refusal(street: &Street, changes: &[&str]) -> String {
    let mut arguments = vec!["run", "recipe.toml", "--quiet"];
    changes.iter().for_each(|change| arguments.extend_from_slice(&["--set", change]));
    let printed = cosfly(&arguments).within(street.path()).run();
    assert_ne!(printed.code, Some(0));
    assert!(!street.dataset().exists(), "a refused run leaves no dataset behind");
    printed.stderr.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn text(path: &Path) -> String {
    String::from_utf8_lossy(&std::fs::read(path).unwrap_or_default()).into_owned()
}

#[test]
fn the_recipe_of_two_towns_makes_a_verified_dataset_with_an_unseen_town() {
    let folder = tempfile::tempdir().expect("scratch");
    let at = |name: &str| folder.path().join(name).display().to_string();
    let run = ["run", "recipes/two_towns.toml", "--quiet", "--store", &at("store"), "--out", &at("out")];
    cosfly(&run).run_ok();
    cosfly(&["verify", &at("out")]).run_ok();
    let lint = cosfly(&["dataset", "lint", &at("out"), "--by-town"]).run_ok().stdout;
    assert!(lint.contains("town `downtown`") && lint.contains("town `uptown`"), "{lint}");
    assert!(lint.contains("4 flights in `train`") && lint.contains("4 flights in `test`"), "{lint}");
    let out = folder.path().join("out");
    assert!(out.join("mcap/uptown/000/expert_uptown-p00000.mcap").is_file());
    let page = text(&out.join("report/index.html"));
    assert!(page.contains("<h3>downtown</h3>") && page.contains("<h3>uptown</h3>"));
    assert!(text(&out.join("README.md")).contains("| targets | 4 |"));
    // The predicted flights are those of `test`, all of them in the unseen town.
    let scored = cosfly(&["eval", &at("out"), "--json"]).run_ok().stdout;
    assert!(scored.contains("unseen") && !scored.contains("\"seen\""), "{scored}");
    cosfly(&["doctor", &at("out"), "--imperfect-share", "1"]).run_ok();
    cosfly(&["preview", &at("out"), "--trajectory", "perturbed_uptown-p00001", "--out", &at("pictures")]).run_ok();
    cosfly(&["carla-job", &at("out"), "--out", &at("job.json")]).run_ok();
    let job = text(&folder.path().join("job.json"));
    assert!(job.contains("\"uptown\"") && job.contains("\"downtown\""));
    for format in ["coco", "webdataset", "imagefolder", "vlm", "lerobot"] {
        cosfly(&["export", &at("out"), "--format", format, "--out", &at(format)]).run_ok();
    }
    let names = ["downtown=Town01", "uptown=Town02"];
    cosfly(&["export", &at("out"), "--format", "v7", "--out", &at("v7"), "--town", names[0], "--town", names[1]])
        .run_ok();
    // Any flight can be made again alone, in an empty store.
    let again =
        ["verify", &at("out"), "--regenerate", "3", "--recipe", "recipes/two_towns.toml", "--store", &at("store")];
    cosfly(&again).run_ok();
}

#[test]
fn adding_a_town_makes_no_flight_of_the_first_one_again() {
    let street = two_towns(BOTH, &far_map());
    std::fs::write(street.path().join("alone.toml"), RECIPE).expect("writable");
    cosfly(&["run", "alone.toml", "--quiet", "--out", "alone"]).within(street.path()).run_ok();
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let logs = |dataset: &Path| crate::support::tree_digests(&dataset.join("mcap/street"));
    assert_eq!(logs(&street.path().join("alone")), logs(&street.dataset()));
    cosfly(&["verify", "out/street"]).within(street.path()).run_ok();
}

#[test]
fn the_recipe_of_the_papers_size_has_its_counts_and_runs_in_small() {
    let folder = tempfile::tempdir().expect("scratch");
    let at = |name: &str| folder.path().join(name).display().to_string();
    let recipe = "recipes/cosfly_track_full.toml";
    let small = [
        "for_each.town.walks=1",
        "for_each.town.others=3",
        "for_each.town.files=towns/track/town0[18].json",
        "stages.walkers.frames=24",
        "stages.crowd.frames=24",
        "stages.frames.width=96",
        "stages.frames.height=54",
    ];
    let mut run = vec!["run", recipe, "--quiet", "--store", "", "--out", ""];
    let (store, out) = (at("store"), at("out"));
    (run[4], run[6]) = (&store, &out);
    run.extend(small.iter().flat_map(|change| ["--set", change]));
    cosfly(&run).run_ok();
    cosfly(&["verify", &out]).run_ok();
    assert_eq!(std::fs::read_dir(folder.path().join("out/mcap")).expect("it has logs").count(), 2);
    // The trial has measured every stage: the plan of the whole has its time and its price.
    let plan = cosfly(&["plan", recipe, "--store", &store, "--price", "0.04", "--json"]).run_ok().stdout;
    let plan: serde_json::Value = serde_json::from_str(&plan).expect("JSON");
    let items = |kind: &str| -> u64 {
        let stages = plan["stages"].as_array().into_iter().flatten();
        stages.filter(|it| it["uses"] == kind).filter_map(|it| it["items"].as_u64()).sum()
    };
    assert_eq!((items("map"), items("plan"), items("perturb"), items("caption")), (16, 6_000, 6_000, 12_000));
    assert_eq!(plan["all_measured"], true);
    assert!(plan["predicted_price"].as_f64().is_some_and(|price| price > 0.0), "{}", plan["predicted_price"]);
}

/// The street's recipe with its stages made for each town of a list.
fn recipe_of_a_list(towns: &str) -> String {
    let (head, stages) = RECIPE.split_at(RECIPE.find("[stages.town]").expect("it has a town"));
    let (chain, dataset) = stages.split_at(stages.find("[stages.captions]").expect("it has captions"));
    let chain = chain.replace("\nuse = ", "\nfor_each = \"town\"\nuse = ").replace("\"street.xodr\"", "\"{town}\"");
    format!("{head}\n[for_each]\ntown = {towns}\n\n{chain}{dataset}")
}

#[test]
fn another_file_in_the_folder_is_another_town_and_no_file_of_the_others_changes() {
    let street = Street::with(&recipe_of_a_list("\"maps/*.xodr\""), &map());
    let maps = street.path().join("maps");
    std::fs::create_dir(&maps).expect("writable");
    for (name, at) in [("near", "0"), ("far", "4000")] {
        let text = map().replace("x=\"0.0\"", &format!("x=\"{at}.0\"")).replace("x=\"0\"", &format!("x=\"{at}\""));
        std::fs::write(maps.join(format!("{name}.xodr")), text).expect("writable");
    }
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let files = |town: &str| {
        let mut files = crate::support::tree_digests(&street.dataset());
        files.retain(|(path, _)| path.contains(town));
        files
    };
    let before = [files("near"), files("far")];
    assert!(before.iter().all(|files| files.len() > 6), "{before:?}");
    std::fs::write(
        maps.join("middle.xodr"),
        map().replace("x=\"0.0\"", "x=\"9000.0\"").replace("x=\"0\"", "x=\"9000\""),
    )
    .expect("writable");
    let printed = cosfly(&["run", "recipe.toml"]).within(street.path()).run_ok();
    assert_eq!([files("near"), files("far")], before, "{}", printed.stdout);
    assert_eq!(files("middle").len(), before[0].len());
    cosfly(&["verify", "out/street"]).within(street.path()).run_ok();
    // A town alone: what is read of it needs no file of the others.
    for (path, _) in files("near").into_iter().chain(files("far")) {
        std::fs::remove_file(street.dataset().join(path)).expect("it is there");
    }
    cosfly(&["preview", "out/street", "--out", "pictures"]).within(street.path()).run_ok();
}

#[test]
fn the_same_town_twice_is_one_town() {
    let street = two_towns(BOTH, &map());
    let same_name = ["--set", "stages.far_town.name=street"];
    let run = [&["run", "recipe.toml", "--quiet"][..], &same_name[..]].concat();
    cosfly(&run).within(street.path()).run_ok();
    cosfly(&["verify", "out/street"]).within(street.path()).run_ok();
}

#[test]
fn a_copy_of_a_town_under_another_name_goes_to_its_split() {
    let street = two_towns(BOTH, &map());
    let shares = "stages.dataset.splits={ train = 0.5, val = 0.0, test = 0.5 }";
    cosfly(&["run", "recipe.toml", "--quiet", "--set", shares]).within(street.path()).run_ok();
    cosfly(&["verify", "out/street"]).within(street.path()).run_ok();
    cosfly(&["dataset", "lint", "out/street", "--by-town"]).within(street.path()).run_ok();
}

#[test]
fn towns_that_cannot_be_told_apart_or_are_not_there_are_refused() {
    let renamed = two_towns(BOTH, &far_map());
    let said = refusal(&renamed, &["stages.far_town.name=street"]);
    assert!(!renamed.path().join(".cosfly").exists(), "two towns of one name are refused before any work");
    assert!(
        said.contains("towns-same-name") && said.contains("`name = \"street_2\"` in `[stages.far_town]`"),
        "{said}"
    );
    let said = refusal(&renamed, &["stages.dataset.splits.towns={ farr = \"test\" }"]);
    assert!(said.contains("names `farr`") && said.contains("did you mean `far`?"), "{said}");
    let areas = "stages.dataset.splits={ by = \"area\", areas = { farr = { axis = \"x\", splits = [\"train\", \"test\"], at_m = [0.0] } } }";
    let said = refusal(&renamed, &[areas]);
    assert!(said.contains("`splits.areas` names `farr`") && said.contains("did you mean `far`?"), "{said}");
    let said = refusal(&renamed, &["stages.dataset.splits={ guard_m = 5.0 }"]);
    assert!(said.contains("a guard band has a meaning with `by = \"area\"` only"), "{said}");
    let said = refusal(&renamed, &["stages.dataset.splits.towns={ far = \"tset\" }"]);
    assert!(said.contains("`test`"), "{said}");
    let said = refusal(&renamed, &["stages.far_walkers.dt_s=0.25"]);
    assert!(said.contains("frames are 0.5 s apart in `expert-p00000` and 0.25 s in `far_expert-p00000`"), "{said}");
    let copy = two_towns(BOTH, &map());
    let said = refusal(&copy, &["stages.dataset.splits.towns={ street = \"train\", far = \"test\" }"]);
    assert!(said.contains("puts `street` and `far` into two splits, but they have the same ground plan"), "{said}");
}

#[test]
fn inputs_that_do_not_fit_together_are_refused() {
    let inputs =
        |town: &str, frames: &str| format!("inputs = {{ town = {town}, frames = {frames}, captions = \"captions\" }}");
    let check = |town: &str, frames: &str, expected: &str| {
        let said = refusal(&two_towns(&inputs(town, frames), &far_map()), &[]);
        assert!(said.contains(expected), "{town} {frames}: {said}");
    };
    let both = "[\"frames\", \"far_frames\"]";
    check("\"town\"", both, "`far_frames/far_expert-p00000` was made in another town than `town`");
    check("[\"town\", \"town\"]", both, "`town` is connected twice");
    check("[\"town\", \"far_town\"]", "[\"frames\", \"frames\"]", "`frames` is connected twice");
    check("[\"town\", \"far_town\"]", "\"frames\"", "have different items");
    let again = recipe_of_two_towns(BOTH)
        .replace("frames = [\"frames\", \"far_frames\"]", "frames = [\"frames\", \"again\"]")
        .replace("[stages.captions]", "[stages.again]\nuse = \"render\"\ninputs = { town = \"town\", trajectories = [\"expert\", \"perturbed\"] }\n\n[stages.captions]");
    let street = Street::with(&again, &map());
    std::fs::write(street.path().join("far.xodr"), far_map()).expect("writable");
    let said = refusal(&street, &[]);
    assert!(said.contains("gets an item `expert-p00000` from `frames` and from `again`"), "{said}");
    let uncaptioned = recipe_of_two_towns(&BOTH.replace(", captions = \"captions\"", ""))
        .replace("frames = [\"frames\", \"far_frames\"]", "frames = \"frames\"");
    let street = Street::with(&uncaptioned, &map());
    std::fs::write(street.path().join("far.xodr"), far_map()).expect("writable");
    let said = refusal(&street, &[]);
    assert!(said.contains("`far_town` is connected to `inputs.town`, but no picture shows that town"), "{said}");
}

/// Bytes of the files below a folder, each file once, whatever its names.
pub fn bytes_below(folder: &Path, seen: &mut BTreeSet<u64>) -> u64 {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry"));
    let bytes = |entry: std::fs::DirEntry| {
        let data = entry.metadata().expect("a file");
        match data.is_dir() {
            true => bytes_below(&entry.path(), seen),
            false if seen.insert(data.ino()) => data.len(),
            false => 0,
        }
    };
    entries.map(bytes).sum()
}

#[test]
fn a_plan_tells_what_a_run_writes_before_it_and_what_further_walks_add() {
    let folder = tempfile::tempdir().expect("a folder");
    for (frames, height) in [("16", "90"), ("48", "180")] {
        let store = folder.path().join(frames);
        let count = |count: u32| format!("stages.walkers.count={count}");
        let options = |count: &str| -> Vec<String> {
            let sets = [count, &format!("stages.walkers.frames={frames}"), &format!("stages.frames.height={height}")];
            let words = ["recipes/small.toml", "--store", &store.to_string_lossy()].map(str::to_owned);
            words.into_iter().chain(sets.iter().flat_map(|set| ["--set".to_owned(), (*set).to_owned()])).collect()
        };
        let planned = |number: u32| {
            let words = [vec!["plan".to_owned(), "--json".to_owned()], options(&count(number))].concat();
            let plan: serde_json::Value = serde_json::from_str(&cosfly(&words).run_ok().stdout).expect("JSON");
            plan["predicted_bytes"].as_f64().expect("a number")
        };
        let mut written = 0.0;
        for number in [2, 5] {
            let (before, predicted) = (written, planned(number));
            let out = folder.path().join(format!("{frames}-{number}")).to_string_lossy().into_owned();
            let run = ["run".to_owned(), "--quiet".to_owned(), "--out".to_owned(), out];
            cosfly(&[run.to_vec(), options(&count(number))].concat()).run_ok();
            written = bytes_below(&store, &mut BTreeSet::new()) as f64;
            let ratio = predicted / (written - before);
            assert!((0.67..1.5).contains(&ratio), "{frames} frames, {number} walks: {ratio:.2} of what was written");
        }
    }
}
