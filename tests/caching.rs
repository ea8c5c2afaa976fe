//! Caching through the real binary: items that are made again and items that are not; causes given by `why`.

use crate::street::Street;
use crate::support::cosfly;
use std::collections::BTreeMap;

/// Numbers of items made per stage, from the machine-readable summary.
fn made(street: &Street, overrides: &[&str]) -> BTreeMap<String, u64> {
    let mut arguments = vec!["run", "recipe.toml", "--json"];
    for change in overrides {
        arguments.extend_from_slice(&["--set", change]);
    }
    let printed = cosfly(&arguments).within(street.path()).run_ok();
    let summary: serde_json::Value = serde_json::from_str(&printed.stdout).expect("a JSON summary");
    summary["stages"]
        .as_array()
        .expect("stages")
        .iter()
        .map(|stage| (stage["stage"].as_str().expect("name").to_owned(), stage["ran"].as_u64().expect("count")))
        .filter(|(_, ran)| *ran > 0)
        .collect()
}

fn stages(expected: &[(&str, u64)]) -> BTreeMap<String, u64> {
    expected.iter().map(|(stage, ran)| ((*stage).to_owned(), *ran)).collect()
}

#[test]
fn only_what_depends_on_a_change_runs_and_changing_back_runs_nothing() {
    let street = Street::new();
    assert_eq!(
        made(&street, &[]),
        stages(&[
            ("town", 1),
            ("walkers", 3),
            ("expert", 3),
            ("perturbed", 3),
            ("frames", 6),
            ("captions", 6),
            ("dataset.logs", 6),
            ("dataset.notes", 1),
            ("dataset.splits", 1),
            ("dataset.tables", 1),
            ("dataset.planners", 1),
            ("dataset", 1)
        ])
    );
    assert_eq!(made(&street, &[]), stages(&[]));
    let reworded = ["stages.dataset.title=Another title"];
    assert_eq!(made(&street, &reworded), stages(&[("dataset", 1)]), "a new title plans nothing");
    let disturbed = ["stages.perturbed.rotation_probability=0.9"];
    let after = made(&street, &disturbed);
    assert_eq!(after.get("perturbed"), Some(&3));
    assert_eq!(after.get("frames"), Some(&3), "the experts' pictures stay");
    assert!(!after.contains_key("expert") && !after.contains_key("walkers"));
    assert_eq!(made(&street, &[]), stages(&[]));
    let more = made(&street, &["stages.walkers.count=5"]);
    assert_eq!(more.get("walkers"), Some(&2), "asking for more makes only those");
    assert_eq!(more.get("frames"), Some(&4));
    assert_eq!(more.get("dataset.logs"), Some(&4));
}

#[test]
fn pictures_lie_once_and_are_made_again_only_where_something_reads_them() {
    let street = Street::new();
    let remove = "intermediates=remove";
    made(&street, &[remove]);
    let plan = |change: &str| {
        let plan = cosfly(&["plan", "recipe.toml", "--json", "--set", remove, "--set", change]).within(street.path());
        let plan: serde_json::Value = serde_json::from_str(&plan.run_ok().stdout).expect("a JSON plan");
        let stages = plan["stages"].as_array().expect("stages").clone();
        stages.iter().find(|stage| stage["stage"] == "frames").expect("frames")["made_again"].as_u64()
    };
    assert_eq!(plan("stages.dataset.title=Another title"), Some(0));
    assert_eq!(made(&street, &[remove, "stages.dataset.title=Another title"]), stages(&[("dataset", 1)]));
    assert_eq!(plan("stages.captions.clothes=false"), Some(6));
    let reworded = made(&street, &[remove, "stages.captions.clothes=false"]);
    assert_eq!((reworded.get("captions"), reworded.get("frames"), reworded.get("expert")), (Some(&6), Some(&6), None));
}

#[test]
fn a_single_stage_is_made_with_what_it_needs() {
    let street = Street::new();
    let told = cosfly(&["run", "recipe.toml", "--stage", "expert"]).within(street.path()).run_ok().stdout;
    assert!(told.contains(".expert in ") && told.contains("not needed") && !told.contains("README.md"), "{told}");
    assert!(!street.dataset().exists());
    let rest = made(&street, &[]);
    assert!(!rest.contains_key("expert") && !rest.contains_key("walkers") && rest.contains_key("frames"), "{rest:?}");
    let unknown = cosfly(&["run", "recipe.toml", "--stage", "expret"]).within(street.path()).run();
    assert!(unknown.stderr.contains("did you mean `expert`?"), "{}", unknown.stderr);
}

#[test]
fn why_names_the_changed_ingredient() {
    let street = Street::new();
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let why = |subject: &str, change: &str| {
        cosfly(&["why", "recipe.toml", subject, "--set", change]).within(street.path()).run_ok().stdout
    };
    let own = why("expert/p00001", "stages.expert.weights.visibility=5");
    assert!(own.contains("weights.visibility") && own.contains('5'), "{own}");
    let upstream = why("frames/expert-p00001", "stages.walkers.turn_slowdown_m=0.123");
    assert!(
        upstream.contains("walkers") && upstream.contains("turn_slowdown_m") && upstream.contains("0.123"),
        "{upstream}"
    );
    let seed = why("captions", "seed=4");
    assert!(seed.contains("seed"), "{seed}");
    let new = why("walkers/p00004", "stages.walkers.count=5");
    assert!(new.contains("new"), "{new}");
    let cached = cosfly(&["why", "recipe.toml", "frames"]).within(street.path()).run_ok().stdout;
    assert!(cached.contains("cached") || cached.contains("nothing changed"), "{cached}");
    let edited = crate::street::map().replacen("height=\"14.0\"", "height=\"15.0\"", 1);
    std::fs::write(street.path().join("street.xodr"), edited).expect("writable");
    let source = cosfly(&["why", "recipe.toml", "town"]).within(street.path()).run_ok().stdout;
    assert!(source.contains("the file that `source` names changed"), "{source}");
}

#[test]
fn a_single_task_runs_from_its_plan_digest() {
    let street = Street::new();
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let before = crate::support::tree_digests(&street.dataset());
    let done = street.path().join(".cosfly/done");
    let records: Vec<_> = std::fs::read_dir(&done)
        .expect("readable")
        .flat_map(|shard| std::fs::read_dir(shard.expect("entry").path()).expect("readable"))
        .map(|record| record.expect("entry").path())
        .collect();
    assert!(!records.is_empty());
    for record in records {
        let digest = record.file_name().expect("a name").to_string_lossy().into_owned();
        assert_eq!(cosfly(&["task", "run", &digest]).within(street.path()).run_ok().stdout, "already done\n");
        std::fs::remove_file(&record).expect("removable");
        cosfly(&["task", "run", &digest]).within(street.path()).run_ok();
        assert!(record.exists(), "the task published its done record again");
    }
    assert_eq!(made(&street, &[]), stages(&[]), "the tasks did all that a run would do");
    assert_eq!(before, crate::support::tree_digests(&street.dataset()));
    let unknown = "0".repeat(64);
    let refused = cosfly(&["task", "run", &unknown]).within(street.path()).run();
    assert_eq!(refused.code, Some(4), "{}", refused.stderr);
}
