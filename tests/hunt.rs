//! `hunt`: failures that the expert does not have, the same for any jobs and after a stop, as a suite that flies and a recipe that runs.

use crate::street::{RECIPE, Street, map};
use crate::support::{cosfly, tree_digests};
use serde_json::Value;

const POLICY: &str = "constant-velocity:gain=3";

fn hunt(street: &Street, out: &str, more: &[&str]) -> Value {
    let arguments = ["hunt", "recipe.toml", "--out", out, "--budget", "12", "--pool", "40", "--json"];
    let printed = cosfly(&[&arguments, more].concat()).within(street.path()).run_ok().stdout;
    serde_json::from_str(&printed).expect("JSON")
}

#[test]
fn failures_do_not_depend_on_jobs_or_stops_and_fly_bundle_and_verify_as_a_suite() {
    // Longer than a target may be out of sight.
    let street = Street::with(&RECIPE.replace("frames = 12", "frames = 40"), &map());
    let found = hunt(&street, "one", &["--policy", POLICY, "--jobs", "1"]);
    let failures = found["failures"].as_u64().expect("a number");
    assert!(failures > 0 && found["flown"].as_u64() <= Some(12) && found["walks"] == found["failures"], "{found}");
    let digests = |folder: &str| tree_digests(&street.path().join(folder));
    assert_eq!(hunt(&street, "two", &["--policy", POLICY, "--jobs", "2"]), found);
    assert_eq!(digests("two"), digests("one"));
    let rows = std::fs::read_dir(street.path().join("two/rows")).expect("rows");
    rows.skip(2).for_each(|row| std::fs::remove_file(row.expect("readable").path()).expect("removed"));
    hunt(&street, "two", &["--policy", POLICY]);
    assert_eq!(digests("two"), digests("one"));

    let run = |arguments: &[&str]| cosfly(arguments).within(street.path()).run_ok().stdout;
    let fly =
        ["fly", "one/failures.toml", "--tier", "all", "--json", "--logs", "none", "--clips", "0", "--out", "flown"];
    let scores: Value =
        serde_json::from_str(&run(&[&fly[..], &["--policy", POLICY, "--policy", "expert"]].concat())).expect("JSON");
    let success = |name: &str| scores[name]["all"]["success"]["mean"].as_f64();
    assert_eq!(
        (success("constant-velocity-gain3-delay0-noise0"), success("expert")),
        (Some(0.0), Some(1.0)),
        "{scores}"
    );
    let rows = std::fs::read_to_string(street.path().join("flown/expert/episodes.jsonl")).expect("rows");
    assert_eq!(rows.lines().count() as u64, failures);
    run(&["fly", "bundle", "flown/expert"]);
    run(&["fly", "verify", "flown/expert.jsonl.zst", "one/failures.toml"]);
    run(&["plan", "one/training.toml"]);

    let failures = std::fs::read_to_string(street.path().join("one/failures.toml")).expect("a benchmark");
    let failures = failures.replace("episodes = [", "episodes = [\"street-nobody\",");
    std::fs::write(street.path().join("one/wrong.toml"), failures).expect("written");
    let fly = ["fly", "one/wrong.toml", "--tier", "all", "--policy", "expert"];
    let printed = cosfly(&fly).within(street.path()).run();
    assert!(printed.code == Some(3) && printed.stderr.contains("`street-nobody`"), "{}", printed.stderr);
}

#[test]
fn training_data_have_all_inputs_and_files_of_traffic() {
    let traffic = "\n[stages.crowd]\nuse = \"traffic\"\ninputs = { town = \"town\", avoid = \"walkers\" }\nframes = 40\n\
                   people.count = 4\nvehicles.count = 0\nfollow = { count = 1, min_length_m = 0.5 }\n\
                   recorded = [{ source = \"tracks.csv\" }]\n\
                   \n[stages.second]\nuse = \"plan\"\ninputs = { town = \"town\", walks = \"crowd\" }\n";
    let street = Street::with(&(RECIPE.replace("frames = 12", "frames = 40") + traffic), &map());
    let track: String = (0..30).map(|second| format!("{second},a,{},6\n", 20 + second)).collect();
    std::fs::write(street.path().join("tracks.csv"), format!("t,id,x,y\n{track}")).expect("written");
    hunt(&street, "one", &["--policy", POLICY]);
    let training = std::fs::read_to_string(street.path().join("one/training.toml")).expect("a recipe");
    for words in ["inputs.avoid = \"walkers_1\"", "\"source\" = \"../tracks.csv\""] {
        assert!(training.contains(words), "{training}");
    }
    cosfly(&["plan", "one/training.toml"]).within(street.path()).run_ok();
}

#[test]
fn what_is_wrong_is_told() {
    let street = Street::new();
    let refused = |arguments: &[&str], code: i32, words: &str| {
        let printed = cosfly(&[&["hunt", "recipe.toml", "--policy"], arguments].concat()).within(street.path()).run();
        assert_eq!(printed.code, Some(code), "{arguments:?}: {}", printed.stderr);
        assert!(printed.stderr.contains(words), "{arguments:?}: {}", printed.stderr);
    };
    refused(&["folow"], 3, "did you mean `follow`?");
    refused(&["follow", "--vary", "stages.walkers.frames"], 3, "is no range: it has no `=`");
    refused(&["follow", "--vary", "stages.walker.frames=10..20"], 3, "did you mean `walkers`?");
    refused(&["follow", "--vary", "tool.fly.latency_ms=0..9000", "--pool", "9"], 3, "latency_ms");
    refused(&["follow", "--budget", "0"], 2, "--budget");
    refused(&["follow", "--seed", "9223372036854775808"], 2, "--seed");
    refused(&["follow", "--actions", "rotors", "--pool", "4"], 3, "fly-drone");
    refused(&["ws://127.0.0.1:9", "--wait-s", "0.1", "--pool", "4"], 5, "fly-policy-unready");
}
