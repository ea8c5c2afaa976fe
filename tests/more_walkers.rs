//! The recipe that everybody runs first: nobody walks through anybody, and one more walker makes no other expert again.

use crate::support::repository_root;
use cosfly_experts::artifacts;
use cosfly_frames::{DVec3, TargetState};
use cosfly_recipe::Recipe;
use cosfly_runner::{RunOptions, RunSummary};
use cosfly_stage::BlobSource;
use cosfly_store::{ActionRecord, Store};
use std::collections::BTreeMap;
use std::path::Path;

/// Overrides that make small pictures of short walks.
const SMALL: [&str; 6] = [
    "stages.walkers.frames=40",
    "stages.crowd.frames=40",
    "stages.crowd.people.count=150",
    "stages.frames.width=160",
    "stages.frames.height=90",
    "stages.frames.look=simple",
];

/// The shipped recipe with overrides, up to a stage.
fn recipe(overrides: &[&str], last: &str) -> Recipe {
    let overrides: Vec<String> = overrides.iter().map(|&change| change.to_owned()).collect();
    let path = repository_root().join("recipes/carla_town.toml");
    let mut recipe = cosfly_recipe::load(&path, &overrides, &cosfly_stages::registry()).expect("a sound recipe");
    recipe.stages.truncate(recipe.position(last).expect("a stage") + 1);
    recipe
}

fn run(recipe: &Recipe, store: &Path, jobs: usize) -> RunSummary {
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

/// Places of a person, frame by frame; `None` where the person is absent.
type Places = Vec<Option<DVec3>>;

/// Tracks of all who are near a film, the target first.
fn tracks(store: &Store, target: &ActionRecord, near: &ActionRecord) -> Vec<Places> {
    let bytes = |record: &ActionRecord, blob: &str| store.read(&record.outputs[blob]).expect("it is there");
    let place = |state: &TargetState| Some(state.feet_in_world);
    let walk = |record: &ActionRecord, blob: &str| {
        let walk = artifacts::WALK.decode(&bytes(record, blob)).expect("a walk");
        walk.track.states.iter().map(place).collect()
    };
    let walks = near.outputs.keys().filter(|blob| blob.starts_with("walk-")).map(|blob| walk(near, blob));
    let mut all: Vec<Places> = std::iter::once(walk(target, artifacts::WALK.blob)).chain(walks).collect();
    for near in artifacts::NEARBY_BODIES.decode(&bytes(near, artifacts::NEARBY_BODIES.blob)).expect("bodies") {
        let around = near.around;
        let frames = around.traffic.frames;
        all.extend(around.bodies().map(|(_, body)| (0..frames).map(|at| body.state(at).and_then(place)).collect()));
    }
    all
}

/// Pairs of people nearer than a distance in a frame, over all frames.
fn near_pairs(tracks: &[Places], nearer_than_m: f64) -> usize {
    let pairs = |(number, one): (usize, &Places)| {
        let near = |(a, b): (&Option<DVec3>, &Option<DVec3>)| {
            a.zip(*b).is_some_and(|(a, b)| (a - b).truncate().length() < nearer_than_m)
        };
        tracks[number + 1..].iter().map(|other| one.iter().zip(other).filter(|pair| near(*pair)).count()).sum::<usize>()
    };
    tracks.iter().enumerate().map(pairs).sum()
}

#[test]
fn no_two_people_of_the_first_recipe_come_nearer_than_0_4_m() {
    let scratch = tempfile::tempdir().expect("a scratch folder");
    let people = |jobs: usize| {
        let (store, recipe) = (scratch.path().join(jobs.to_string()), recipe(&[], "frames.nearby"));
        let summary = run(&recipe, &store, jobs);
        let walks = items(&recipe, &summary, "walkers");
        (Store::open(&store).expect("a store"), walks, items(&recipe, &summary, "frames.nearby"))
    };
    let (store, walks, films) = people(2);
    assert_eq!((walks.len(), films.len()), (4, 8));
    let mut shown = 0;
    for (film, near) in &films {
        let target = &walks[film.rsplit('-').next().expect("an item")];
        let tracks = tracks(&store, target, near);
        assert!(tracks.iter().all(|places| places.len() == 200), "{film}");
        assert_eq!(near_pairs(&tracks, 0.4), 0, "{film}");
        shown += tracks.len() - 1;
    }
    assert!(shown > 8 * 20, "only {shown} people are near 8 films");
    assert_eq!((walks, films), (people(1).1, people(1).2), "on one thread and on two");
}

#[test]
fn one_more_walker_makes_no_other_expert_and_films_only_what_shows_somebody_new() {
    let scratch = tempfile::tempdir().expect("a scratch folder");
    let (old, fresh) = (scratch.path().join("old"), scratch.path().join("fresh"));
    let of = |walkers: &str| recipe(&[&SMALL[..], &[walkers]].concat(), "frames");
    let (few, more) = (of("stages.walkers.count=4"), of("stages.walkers.count=5"));
    let first = run(&few, &old, 2);
    let (films, people) = (items(&few, &first, "frames"), items(&few, &first, "frames.nearby"));
    let second = run(&more, &old, 2);
    let ran = |stage: &str| second.stages.iter().find(|it| it.name == *stage).map(|it| it.ran).expect("a stage");
    assert_eq!(["walkers", "expert", "perturbed", "crowd.bodies", "frames.nearby"].map(ran), [1, 1, 1, 1, 10]);
    let (after, people_after) = (items(&more, &second, "frames"), items(&more, &second, "frames.nearby"));
    let kept = films.keys().filter(|film| people[*film].outputs == people_after[*film].outputs);
    let kept: Vec<&String> = kept.collect();
    assert_eq!((films.len(), ran("frames")), (8, 10 - kept.len() as u64));
    assert!(kept.iter().all(|film| after[*film] == films[*film]));
    assert!(kept.len() >= 2, "{} of 8 films are kept", kept.len());
    assert_eq!(after, items(&more, &run(&more, &fresh, 1), "frames"));
}
