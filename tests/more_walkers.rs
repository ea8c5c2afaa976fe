//! One more walker in the shipped recipe: only what is new is made, and films in which that walker is never in view stay.

use crate::support::repository_root;
use cosfly_recipe::Recipe;
use cosfly_runner::{RunOptions, RunSummary};
use cosfly_store::{ActionRecord, Store};
use std::collections::BTreeMap;
use std::path::Path;

/// Overrides that make small pictures of short walks.
const SMALL: [&str; 5] = [
    "stages.walkers.steps=40",
    "stages.crowd.steps=40",
    "stages.frames.width=160",
    "stages.frames.height=90",
    "stages.frames.look=simple",
];

/// The shipped recipe up to its films, with `walkers` walkers.
fn recipe(walkers: u32) -> Recipe {
    let mut overrides = SMALL.map(str::to_owned).to_vec();
    overrides.push(format!("stages.walkers.count={walkers}"));
    let path = repository_root().join("recipes/carla_town.toml");
    let mut recipe = cosfly_recipe::load(&path, &overrides, &cosfly_stages::registry()).expect("a sound recipe");
    recipe.stages.truncate(recipe.position("frames").expect("a stage") + 1);
    recipe
}

fn run(recipe: &Recipe, store: &Path) -> RunSummary {
    let jobs = std::thread::available_parallelism().map_or(1, usize::from);
    let options = RunOptions { jobs, cancelled: Default::default(), ..RunOptions::default() };
    let store = Store::open(store).expect("a store");
    let summary = cosfly_runner::run(recipe, &store, &options, &|_| {}).expect("it runs");
    assert!(summary.failures.is_empty());
    summary
}

/// Items of a stage by name.
fn items(recipe: &Recipe, summary: &RunSummary, stage: &str) -> BTreeMap<String, ActionRecord> {
    let finished = summary.finished_items(recipe.position(stage).expect("a stage"));
    finished.map(|(item, finished)| (item.to_string(), (*finished.record).clone())).collect()
}

#[test]
fn one_more_walker_films_only_flights_that_may_show_it() {
    let scratch = tempfile::tempdir().expect("a scratch folder");
    let (old, fresh) = (scratch.path().join("old"), scratch.path().join("fresh"));
    let (few, more) = (recipe(4), recipe(5));
    let before = items(&few, &run(&few, &old), "frames");
    let summary = run(&more, &old);
    let frames = summary.stages.iter().find(|stage| stage.name == *"frames").expect("a stage");
    let nearby = items(&more, &summary, "frames.nearby");
    let shows_the_new_one = |record: &ActionRecord| record.outputs.contains_key("walk-walkers-p00004");
    let shown = before.keys().filter(|film| shows_the_new_one(&nearby[*film])).count() as u64;
    // The walker's own two films, and those that may show the walker.
    assert_eq!((before.len(), frames.ran, frames.reused), (8, 2 + shown, 8 - shown));
    assert!(shown <= 4, "{shown} of 8 films may show the new walker");
    let after = items(&more, &summary, "frames");
    assert!(before.iter().all(|(film, record)| shows_the_new_one(&nearby[film]) || after[film] == *record));
    assert_eq!(after, items(&more, &run(&more, &fresh), "frames"));
}
