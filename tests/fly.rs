//! `fly`: suites in closed loop; results that do not depend on jobs, shares or interruptions.

use crate::street::Street;
use crate::support::{cosfly, tree_digests};
use serde_json::Value;

fn fly(street: &Street, out: &str, more: &[&str]) -> Value {
    let arguments = [&["fly", "recipe.toml", "--out", out, "--json"], more].concat();
    serde_json::from_str(&cosfly(&arguments).within(street.path()).run_ok().stdout).expect("JSON")
}

fn refused(street: &Street, arguments: &[&str], code: i32, words: &str) {
    let printed = cosfly(&[&["fly"], arguments].concat()).within(street.path()).run();
    assert_eq!(printed.code, Some(code), "{arguments:?}: {}", printed.stderr);
    assert!(printed.stderr.contains(words), "{arguments:?}: {}", printed.stderr);
}

#[test]
fn results_do_not_depend_on_jobs_shares_or_interruptions() {
    let street = Street::new();
    let scores = fly(&street, "one", &["--policy", "follow", "--policy", "expert", "--jobs", "1"]);
    let rate = |name: &str| scores[name]["all"]["tracking_rate"]["mean"].as_f64().expect("a rate");
    assert!(rate("expert") > 0.5 && rate("follow") <= 1.0, "{scores}");
    let digests = |folder: &str| tree_digests(&street.path().join(folder));
    fly(&street, "two", &["--policy", "follow", "--policy", "expert", "--jobs", "2"]);
    assert_eq!(digests("two"), digests("one"));
    for share in ["2/2", "1/2"] {
        fly(&street, "three", &["--policy", "follow", "--policy", "expert", "--shard", share]);
    }
    assert_eq!(digests("three"), digests("one"));
    let row = std::fs::read_dir(street.path().join("two/follow/rows")).expect("rows").next().expect("a row");
    std::fs::remove_file(row.expect("readable").path()).expect("removed");
    fly(&street, "two", &["--policy", "follow"]);
    assert_eq!(digests("two"), digests("one"));
}

#[test]
fn two_results_compare_and_others_are_refused() {
    let street = Street::new();
    fly(&street, "at_once", &["--policy", "follow"]);
    fly(&street, "late", &["--policy", "follow", "--latency-ms", "200"]);
    fly(&street, "coarse", &["--policy", "follow", "--step-ms", "200"]);
    let compare = ["fly", "compare", "at_once/follow", "late/follow", "--json"];
    let printed = cosfly(&compare).within(street.path()).run_ok().stdout;
    let compared: Value = serde_json::from_str(&printed).expect("JSON");
    assert!(compared["metrics"]["tracking_rate"]["difference"].is_number(), "{compared}");
    refused(&street, &["compare", "at_once/follow", "coarse/follow"], 4, "step_s is 0.1 and 0.2");
    refused(&street, &["compare", "at_once/follow", "nowhere"], 4, "is no finished result");
    refused(&street, &["recipe.toml", "--policy", "follow", "--out", "late"], 3, "another evaluation");
    refused(&street, &["recipe.toml", "--policy", "folow"], 3, "did you mean `follow`?");
    refused(&street, &["recipe.toml", "--policy", "python:mine"], 3, "python:MODULE:FUNCTION");
    refused(&street, &["recipe.toml", "--policy", "wss://host"], 3, "encrypted");
    refused(&street, &["recipe.toml"], 2, "--policy");
    refused(&street, &["recipe.toml", "--policy", "ws://127.0.0.1:9", "--wait", "0.1", "--out", "gone"], 1, "kept");
}
