//! Bytes of every stage kind, preset, planner, objective and plugin world: they change only with an ingredient of a stage's
//! key, such as its version. The recipes and the held digests are in `tests/versions_held`.

use crate::support::repository_root;
use cosfly_fingerprint::Digest;
use cosfly_recipe::{Recipe, RecipeStage};
use cosfly_runner::RunOptions;
use cosfly_stage::StageRole;
use cosfly_store::{Finished, Store};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// Set while generated files are to be written anew, by `.ci/generate`.
const GENERATE: &str = "COSFLY_GENERATE";

/// Held bytes of a stage in a recipe.
#[derive(Debug, PartialEq, Eq)]
struct Held {
    kind: String,
    version: String,
    /// Digest of the action keys of all items: kind, version, parameters, contents of inputs, seeds.
    key: String,
    /// Digest of the outputs of all items.
    bytes: String,
}

fn folder() -> PathBuf {
    repository_root().join("tests/versions_held")
}

fn recipes() -> Vec<Recipe> {
    let entries = std::fs::read_dir(folder()).expect("a folder").map(|entry| entry.expect("entry").path());
    let mut paths: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|it| it == "toml")).collect();
    paths.sort();
    let registry = cosfly_stages::registry();
    let load = |path: PathBuf| match cosfly_recipe::load(&path, &[], &registry) {
        Ok(recipe) => recipe,
        Err(problems) => panic!("{}", cosfly_diagnose::render_all(problems.iter().map(|it| &**it), false)),
    };
    paths.into_iter().map(load).collect()
}

/// Digest of a text for each item of a stage, shortened.
fn short<'a>(finished: impl Iterator<Item = &'a Finished>, text: impl Fn(&Finished) -> String) -> String {
    Digest::of(finished.map(text).collect::<String>().as_bytes()).to_string()[..16].to_owned()
}

/// Runs all recipes; what was made by recipe and stage.
fn made() -> BTreeMap<String, Held> {
    let scratch = tempfile::tempdir().expect("a scratch folder");
    let store = Store::open(&scratch.path().join("store")).expect("a store");
    let jobs = std::thread::available_parallelism().map_or(1, usize::from);
    let mut made = BTreeMap::new();
    for recipe in recipes() {
        let options = RunOptions { jobs, cancelled: Default::default(), ..RunOptions::default() };
        let summary = cosfly_runner::run(&recipe, &store, &options, &|_| {}).expect("it runs");
        if let Some(failure) = summary.failures.first() {
            panic!("`{}` of recipe `{}`: {}", failure.id, recipe.name, failure.diagnostic.message);
        }
        for (index, stage) in recipe.stages.iter().enumerate() {
            let finished = || summary.finished_items(index).map(|(_, finished)| finished);
            let outputs = |finished: &Finished| {
                let blobs = finished.record.outputs.iter();
                blobs.map(|(name, blob)| format!("{name} {}\n", blob.digest)).collect()
            };
            let properties = stage.stage.properties();
            let held = Held {
                kind: properties.kind.clone(),
                version: properties.version.to_string(),
                key: short(finished(), |finished| finished.action.to_string()),
                bytes: short(finished(), outputs),
            };
            made.insert(format!("{}/{}", recipe.name, stage.name), held);
        }
    }
    made
}

fn text_of(held: &BTreeMap<String, Held>) -> String {
    let line = |(name, Held { kind, version, key, bytes }): (&String, &Held)| {
        format!("{name} {kind} {version} {key} {bytes}\n")
    };
    format!("# recipe/stage, kind, version, key, bytes; written by `.ci/generate`\n{}", {
        held.iter().map(line).collect::<String>()
    })
}

fn read(text: &str) -> BTreeMap<String, Held> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let held = lines.map(|line| {
        let words: Vec<String> = line.split(' ').map(str::to_owned).collect();
        let [name, kind, version, key, bytes] = words.try_into().expect("five words");
        (name, Held { kind, version, key, bytes })
    });
    held.collect()
}

/// Stages that give other bytes from the same ingredients, as the developer reads it.
fn forgotten_versions(held: &BTreeMap<String, Held>, made: &BTreeMap<String, Held>) -> Vec<String> {
    let is_forgotten = |name: &String, now: &Held| {
        held.get(name).is_some_and(|before| before.key == now.key && before.bytes != now.bytes)
    };
    let forgotten = made.iter().filter(|(name, now)| is_forgotten(name, now));
    let words = |(name, Held { kind, version, .. }): (&String, &Held)| {
        format!(
            "`{name}` gives other bytes: raise the version of stage kind `{kind}`, now {version}, then run `.ci/generate`"
        )
    };
    forgotten.map(words).collect()
}

#[test]
fn bytes_change_only_with_the_version_of_their_stage() {
    let path = folder().join("held.txt");
    let held = read(&std::fs::read_to_string(&path).unwrap_or_default());
    let made = made();
    let forgotten = forgotten_versions(&held, &made);
    assert!(forgotten.is_empty(), "{}", forgotten.join("\n"));
    if std::env::var_os(GENERATE).is_some() {
        std::fs::write(&path, text_of(&made)).expect("writable");
        return;
    }
    let changed: Vec<&String> =
        made.keys().chain(held.keys()).filter(|name| made.get(*name) != held.get(*name)).collect();
    assert!(changed.is_empty(), "versions, parameters or inputs of {changed:?} changed: run `.ci/generate`");
}

#[test]
fn a_forgotten_version_is_told_with_its_stage_and_a_raised_one_is_not() {
    let text = |key: &str, bytes: &str| read(&format!("# words\npipeline/expert muco 2 {key} {bytes}\n"));
    let told = forgotten_versions(&text("k", "a"), &text("k", "b"));
    assert!(told.len() == 1 && told[0].contains("`pipeline/expert`") && told[0].contains("`muco`, now 2"), "{told:?}");
    assert!(forgotten_versions(&text("k", "a"), &text("l", "b")).is_empty());
    assert!(forgotten_versions(&text("k", "a"), &text("k", "a")).is_empty());
}

/// Names that an enumeration of a schema allows.
fn allowed(schema: &serde_json::Value, name: &str) -> BTreeSet<String> {
    let values = |key: &str| schema["$defs"][name][key].as_array().cloned().unwrap_or_default();
    let consts = values("oneOf").into_iter().map(|choice| choice["const"].clone());
    let names = consts.chain(values("enum")).filter_map(|value| value.as_str().map(str::to_owned));
    names.collect()
}

#[test]
fn every_kind_preset_planner_objective_and_plugin_world_has_a_recipe() {
    let (recipes, registry) = (recipes(), cosfly_stages::registry());
    let stages = || recipes.iter().flat_map(|recipe| &recipe.stages);
    let kinds: BTreeSet<&str> = stages().map(|stage| stage.kind.as_str()).collect();
    for kind in registry.iter() {
        assert!(kinds.contains(kind.name()), "no recipe in `tests/versions_held` uses `{}`", kind.name());
    }
    let plans = |stage: &&RecipeStage| stage.has_role(StageRole::Plans);
    let planner = stages().find(plans).expect("a planner");
    let schema = registry.get(&planner.kind).expect("a kind").schema();
    for (key, name, default) in
        [("preset", "Preset", "cosfly"), ("planner", "Planner", "muco"), ("objective", "Objective", "track")]
    {
        let planned = stages().filter(plans);
        let used: BTreeSet<&str> = planned.map(|stage| stage.parameters[key].as_str().unwrap_or(default)).collect();
        let all = allowed(&schema, name);
        assert!(all.len() > 2 && all.contains(default), "{all:?}");
        for value in &all {
            assert!(used.contains(value.as_str()), "no recipe in `tests/versions_held` has `{key} = \"{value}\"`");
        }
    }
    let worlds = std::fs::read_dir(repository_root().join("plugins/wit")).expect("the interface");
    let texts = worlds.map(|file| std::fs::read_to_string(file.expect("entry").path()).expect("UTF-8"));
    let worlds: BTreeSet<String> = texts
        .flat_map(|text| {
            text.lines().filter_map(|line| Some(line.strip_prefix("world ")?.replace(" {", ""))).collect::<Vec<_>>()
        })
        .collect();
    let held = [
        ("cost-term", stages().any(|stage| stage.parameters["terms"].is_array())),
        ("objective", stages().any(|stage| stage.parameters["plugin"].is_object())),
        ("stage", kinds.contains("wasm")),
    ];
    let held: BTreeSet<String> =
        held.into_iter().filter(|(_, is_held)| *is_held).map(|(name, _)| name.into()).collect();
    assert_eq!(worlds, held);
}
