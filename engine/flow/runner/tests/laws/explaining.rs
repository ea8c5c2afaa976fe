//! `why` names the ingredient, whichever of them changed.

use super::*;
use cosfly_fingerprint::Digest;
use cosfly_runner::{Change, Explanation, plan, why};

/// Runs a recipe, changes it, and asks why the dataset would run; then runs it and asks again.
fn explain(change: impl Fn(&mut Vec<Toy>) -> u64) -> Explanation {
    let (_folder, store) = fresh_store();
    let source = store.root().join("../town.xodr");
    std::fs::write(&source, "a town").unwrap();
    let with_source = || {
        let mut toys = town_toys(3, &Log::default());
        toys[0].sources = vec![source.clone()];
        toys
    };
    run_quietly(&recipe(&with_source()), &store);
    let mut toys = with_source();
    let seed = change(&mut toys);
    if toys[0].parameters["edit"] == true {
        toys[0].parameters = with_source()[0].parameters.clone();
        std::fs::write(&source, "another town").unwrap();
    }
    let changed = toy_recipe("toys", seed, &toys).unwrap();
    let before = why(&changed, &store, "dataset", None).unwrap();
    assert!(!before.finished);
    run_quietly(&changed, &store);
    let after = why(&changed, &store, "dataset", Some("i00000")).unwrap();
    assert!(after.finished);
    assert_eq!(before.chain, after.chain, "the answer is the same before and after the run");
    assert!(before.chain.iter().flat_map(|link| &link.changes).all(|change| !change.to_string().is_empty()));
    before
}

fn root(explanation: &Explanation) -> (&str, &[Change]) {
    let link = explanation.chain.last().unwrap();
    (link.id.stage.as_str(), &link.changes)
}

#[test]
fn a_parameter_is_named_by_its_path_with_both_values_through_the_whole_chain() {
    let found = explain(|toys| {
        toys[1].parameters = json!({ "speed": { "min_mps": 0.9 } });
        7
    });
    let stages: Vec<&str> = found.chain.iter().map(|link| link.id.stage.as_str()).collect();
    assert_eq!(stages, ["dataset", "expert", "walkers"]);
    assert_eq!(
        found.chain[0].changes,
        [Change::Upstream { first: recipe(&town_toys(3, &Log::default())).id(2, 0), inputs: 6 }]
    );
    let parameter =
        Change::Parameter { path: "speed.min_mps".to_owned(), old: Some(0.5.into()), new: Some(0.9.into()) };
    assert_eq!(root(&found).1, [parameter]);
    assert_eq!(root(&found).1[0].to_string(), "`speed.min_mps` changed from `0.5` to `0.9`");
}

#[test]
fn every_other_ingredient_is_named() {
    let new_parameter = explain(|toys| {
        toys[0].parameters = json!({ "speed": { "min_mps": 0.5 }, "fill": [1] });
        7
    });
    let parameter = Change::Parameter { path: "fill".to_owned(), old: None, new: Some(json!([1])) };
    assert_eq!(root(&new_parameter), ("town", &[parameter][..]));

    let seed = explain(|_| 8);
    assert!(root(&seed).1.contains(&Change::RecipeSeed { old: 7.into(), new: 8.into() }));

    let source = explain(|toys| {
        toys[0].parameters["edit"] = true.into();
        7
    });
    let (old, new) = (Some(Digest::of(b"a town")), Some(Digest::of(b"another town")));
    assert_eq!(root(&source), ("town", &[Change::Source { parameter: "source0".to_owned(), old, new }][..]));

    let version = explain(|toys| {
        toys[3].version = 2;
        7
    });
    assert_eq!(root(&version), ("noisy", &[Change::KindVersion { old: 1.into(), new: 2.into() }][..]));

    let wiring = explain(|toys| {
        toys[4].inputs = vec![(2, Fan::Gather), (1, Fan::Gather)];
        7
    });
    let (old, new) = (vec!["noisy".to_owned()], vec!["walkers".to_owned()]);
    assert_eq!(root(&wiring), ("dataset", &[Change::Wiring { port: "b".to_owned(), old, new }][..]));

    let port = explain(|toys| {
        toys[4].inputs.truncate(1);
        7
    });
    let gone = Change::Wiring { port: "b".to_owned(), old: vec!["noisy".to_owned()], new: vec![] };
    assert_eq!(root(&port), ("dataset", &[gone][..]));

    let items = explain(|toys| {
        toys[1].items = 4;
        7
    });
    let added = |port: &str| Change::Items { port: port.to_owned(), added: vec!["i00003".to_owned()], removed: vec![] };
    assert_eq!(root(&items), ("dataset", &[added("a"), added("b")][..]));
}

#[test]
fn first_runs_new_items_and_lost_outputs_are_told_apart() {
    let (_folder, store) = fresh_store();
    let ask = |paths: usize, stage: &str, item: Option<&str>| {
        let explanation = why(&recipe(&town_toys(paths, &Log::default())), &store, stage, item).unwrap();
        explanation.chain.into_iter().flat_map(|link| link.changes).collect::<Vec<_>>()
    };
    assert_eq!(ask(2, "town", None), [Change::FirstRun]);
    let summary = run_quietly(&recipe(&town_toys(2, &Log::default())), &store);
    assert_eq!(ask(2, "town", None), []);
    assert_eq!(ask(3, "walkers", None), [Change::NewItem]);
    assert_eq!(ask(3, "walkers", Some("i00002")), [Change::NewItem]);
    let hex = records(&summary)["expert/i00001"].outputs["out"].digest.to_string();
    std::fs::remove_file(store.root().join("cas").join(&hex[..2]).join(&hex)).unwrap();
    assert_eq!(ask(2, "expert", None), [Change::OutputLost]);
    let mut toys = town_toys(2, &Log::default());
    toys[3].name = "noisier";
    let renamed = recipe(&toys);
    let explanation = why(&renamed, &store, "noisier", None).unwrap();
    assert_eq!(explanation.chain[0].changes, [Change::NewStage]);
    let unknown = why(&renamed, &store, "noiser", None).unwrap_err();
    assert_eq!((unknown.code, unknown.hints[0].as_str()), ("why-unknown-stage", "did you mean `noisier`?"));
    assert_eq!(why(&renamed, &store, "town", Some("x")).unwrap_err().code, "why-unknown-item");
}

#[test]
fn a_plan_gives_the_reasons_of_a_stage_in_few_words() {
    let (_folder, store) = fresh_store();
    let reasons = |toys: &[Toy]| {
        let recipe = recipe(toys);
        let plan = plan(&recipe, &store).unwrap();
        let told = plan
            .stages
            .iter()
            .flat_map(|stage| stage.reasons.iter().map(|(reason, count)| format!("{} {count}: {reason}", stage.name)));
        told.collect::<Vec<_>>()
    };
    let mut toys = town_toys(3, &Log::default());
    assert_eq!(reasons(&toys).len(), 5);
    assert_eq!(reasons(&toys)[1], "walkers 3: this recipe has not run here before");
    run_quietly(&recipe(&toys), &store);
    assert!(reasons(&toys).is_empty());
    toys[1].items = 5;
    toys[3].parameters = json!({ "speed": { "min_mps": 0.7 } });
    let told = reasons(&toys);
    assert_eq!(
        told,
        [
            "walkers 2: the item is new",
            "expert 2: the item is new",
            "noisy 3: `speed.min_mps` changed from `0.5` to `0.7`",
            "noisy 2: the item is new",
            "dataset 1: its inputs from `expert`, `noisy` changed",
        ]
    );
}
