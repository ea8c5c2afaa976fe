//! `fly`: suites in closed loop; results that do not depend on jobs, shares or interruptions.

use crate::street::Street;
use crate::support::{cosfly, tree_digests};
use cosfly_fly::bundle::Bundle;
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
    let scores = fly(&street, "one", &["--policy", "follow", "--policy", "expert", "--clips", "1", "--jobs", "1"]);
    let rate = |name: &str| scores[name]["all"]["tracking_rate"]["mean"].as_f64().expect("a rate");
    assert!(rate("expert") > 0.5 && rate("follow") <= 1.0, "{scores}");
    let digests = |folder: &str| tree_digests(&street.path().join(folder));
    fly(&street, "two", &["--policy", "follow", "--policy", "expert", "--clips", "1", "--jobs", "2"]);
    assert_eq!(digests("two"), digests("one"));
    for share in ["2/2", "1/2"] {
        fly(&street, "three", &["--policy", "follow", "--policy", "expert", "--clips", "1", "--shard", share]);
    }
    assert_eq!(digests("three"), digests("one"));
    let row = std::fs::read_dir(street.path().join("two/follow/rows")).expect("rows").next().expect("a row");
    std::fs::remove_file(row.expect("readable").path()).expect("removed");
    fly(&street, "two", &["--policy", "follow", "--clips", "1"]);
    assert_eq!(digests("two"), digests("one"));
}

#[test]
fn two_results_compare_and_others_are_refused() {
    let street = Street::new();
    fly(&street, "at_once", &["--policy", "follow", "--clips", "0"]);
    fly(&street, "late", &["--policy", "follow", "--clips", "0", "--latency-ms", "200"]);
    fly(&street, "coarse", &["--policy", "follow", "--clips", "0", "--step-ms", "200"]);
    let compare = ["fly", "compare", "at_once/follow", "late/follow", "--json"];
    let printed = cosfly(&compare).within(street.path()).run_ok().stdout;
    let compared: Value = serde_json::from_str(&printed).expect("JSON");
    assert!(compared["metrics"]["tracking_rate"]["difference"].is_number(), "{compared}");
    refused(&street, &["compare", "at_once/follow", "coarse/follow"], 4, "step_s is 0.1 and 0.2");
    refused(&street, &["compare", "at_once/follow", "nowhere"], 4, "is no finished result");
    refused(&street, &["recipe.toml", "--policy", "follow", "--clips", "0", "--out", "late"], 3, "another evaluation");
    refused(&street, &["recipe.toml", "--policy", "folow"], 3, "did you mean `follow`?");
    refused(&street, &["recipe.toml", "--policy", "python:mine"], 3, "python:MODULE:FUNCTION");
    refused(&street, &["recipe.toml", "--policy", "wss://host"], 3, "encrypted");
    refused(&street, &["recipe.toml", "--policy", "hold", "--policy", "hold"], 3, "the name `hold`");
    refused(&street, &["recipe.toml"], 2, "--policy");
    refused(&street, &["recipe.toml", "--policy", "ws://127.0.0.1:9", "--wait-s", "0.1", "--out", "gone"], 1, "kept");
}

#[test]
fn logs_clips_and_the_page_are_there_as_they_were_asked_for() {
    let street = Street::new();
    let kept = |folder: &str, part: &str, ending: &str| {
        let entries = std::fs::read_dir(street.path().join(folder).join("random").join(part)).expect("a part");
        let names = entries.map(|entry| entry.expect("readable").file_name().to_string_lossy().into_owned());
        let mut names: Vec<String> = names.filter_map(|name| name.strip_suffix(ending).map(str::to_owned)).collect();
        names.sort();
        names
    };
    fly(&street, "all", &["--policy", "random"]);
    let episodes = kept("all", "rows", ".json");
    assert_eq!(kept("all", "logs", ".mcap"), episodes);
    let clips = kept("all", "clips", ".gif");
    assert_eq!(clips.len(), episodes.len().min(3));
    let page = std::fs::read_to_string(street.path().join("all/random/report.html")).expect("a page");
    assert!(
        clips.iter().all(|name| page.contains(&format!("clips/{name}.gif"))) && !page.contains("<script"),
        "{page}"
    );
    fly(&street, "worst", &["--policy", "random", "--logs", "worst", "--clips", "1"]);
    let worst = kept("worst", "clips", ".gif");
    assert_eq!((worst.len(), kept("worst", "logs", ".mcap")), (1, worst.clone()));
    let read = |folder: &str| std::fs::read(street.path().join(format!("{folder}/random/logs/{}.mcap", worst[0])));
    assert_eq!(read("worst").expect("a log"), read("all").expect("a log"), "the same log in both");
    fly(&street, "none", &["--policy", "random", "--logs", "none", "--clips", "0"]);
    assert!(kept("none", "logs", ".mcap").is_empty() && kept("none", "clips", ".gif").is_empty());
    assert_eq!(kept("none", "logs", ".jsonl"), episodes);
}

#[test]
fn quadrotors_fly_suites_and_their_sensors_are_in_the_logs() {
    let street = Street::new();
    let arguments = ["--policy", "expert", "--drone", "pelican", "--wind-mps", "3", "--gusts", "--clips", "0"];
    let scores = fly(&street, "one", &[&arguments[..], &["--jobs", "1"]].concat());
    let mean = |name: &str| scores["expert"]["all"][name]["mean"].as_f64().expect("a number");
    assert!(mean("tracking_error_m") > 0.0 && mean("tracking_error_m") < 1.0 && mean("saturated") < 0.1, "{scores}");
    assert!(mean("from_expert_m") < 1.0, "{scores}");
    fly(&street, "two", &[&arguments[..], &["--jobs", "2"]].concat());
    let digests = |folder: &str| tree_digests(&street.path().join(folder));
    assert_eq!(digests("two"), digests("one"));
    let log = std::fs::read_dir(street.path().join("one/expert/logs")).expect("logs").filter_map(|entry| {
        let path = entry.expect("readable").path();
        path.extension().is_some_and(|ending| ending == "mcap").then(|| std::fs::read(path).expect("a log"))
    });
    let has_sensors = |log: &[u8]| log.windows(15).any(|window| window == b"cosfly.Inertial");
    assert!(log.into_iter().all(|log| has_sensors(&log)));
    refused(&street, &["recipe.toml", "--policy", "follow", "--wind-mps", "3"], 3, "wind does not move a point mass");
    refused(&street, &["recipe.toml", "--policy", "follow", "--actions", "rotors"], 3, "a point mass takes no actions");
    refused(&street, &["recipe.toml", "--policy", "follow", "--drone", "glider"], 2, "point-mass, crazyflie, pelican");
}

#[test]
fn a_suite_names_its_drone_and_other_keys_are_refused() {
    let street = Street::new();
    let recipe = std::fs::read_to_string(street.path().join("recipe.toml")).expect("a recipe");
    let with = |table: &str| {
        let text = format!("{recipe}\n[tool.fly]\n{table}\n");
        std::fs::write(street.path().join("recipe.toml"), text).expect("written");
    };
    with("drone = \"crazyflie\"\nblackouts = 1");
    let scores = fly(&street, "small", &["--policy", "expert", "--clips", "0"]);
    assert!(scores["expert"]["all"]["tracking_error_m"]["mean"].is_number(), "{scores}");
    let card = std::fs::read_to_string(street.path().join("small/expert/card.json")).expect("a card");
    assert!(card.contains("\"drone\": \"crazyflie\""), "{card}");
    with("drone = \"glider\"");
    refused(&street, &["recipe.toml", "--policy", "follow"], 3, "`drone` is `glider`; it must be");
    with("wings = 2");
    refused(&street, &["recipe.toml", "--policy", "follow"], 3, "`wings` is not a parameter of `tool.fly`");
    with("wind_mps = 3");
    refused(&street, &["recipe.toml", "--policy", "follow"], 3, "wind does not move a point mass");
}

#[test]
fn measured_latencies_are_told_and_simulated_ones_are_not() {
    let street = Street::new();
    let scores = fly(&street, "measured", &["--policy", "follow", "--latency-ms", "measured", "--clips", "0"]);
    assert!(scores["follow"]["all"]["latency_s"]["mean"].as_f64().is_some_and(|mean| mean >= 0.0), "{scores}");
    let report = std::fs::read_to_string(street.path().join("measured/follow/report.md")).expect("a report");
    assert!(report.contains("Latencies are measured"), "{report}");
    refused(&street, &["recipe.toml", "--policy", "follow", "--latency-ms", "long"], 2, "0 to 5000, or `measured`");
}

#[test]
fn dagger_adds_rounds_and_says_what_is_new() {
    let street = Street::new();
    let dagger = |arguments: &[&str]| {
        let all = [&["dagger", "recipe.toml"], arguments].concat();
        cosfly(&all).within(street.path()).run_ok().stdout
    };
    let kept = ["--keep", "mask,depth,laser_altimeter", "--size-px", "16", "--jobs", "1"];
    let clone = ["--policy", "hold", "--expert-share", "1", "--round", "clone", "--out", "v1"];
    let first = dagger(&[&clone[..], &kept].concat());
    assert!(first.contains("added: round `clone`") && first.contains("the expert flew 100 %"), "{first}");
    let mixed = ["--policy", "follow", "--expert-share", "0.5", "--round", "next", "--onto", "v1"];
    let mixed = [&mixed[..], &kept[..4]].concat();
    let second = dagger(&[&mixed[..], &["--out", "v2", "--jobs", "1"]].concat());
    assert!(second.contains("kept: round `clone`") && second.contains("added: round `next`"), "{second}");
    dagger(&[&mixed[..], &["--out", "v3", "--jobs", "2"]].concat());
    let digests = |folder: &str| tree_digests(&street.path().join(folder));
    assert_eq!(digests("v3"), digests("v2"), "labels do not depend on threads");
    // An episode that is missing is flown again; the bytes are the same.
    let rounds = street.path().join("v3/rounds/next");
    let episode = std::fs::read_dir(rounds).expect("a round").next().expect("an episode").expect("readable");
    std::fs::remove_file(episode.path()).expect("removed");
    dagger(&[&mixed[..], &["--out", "v3"]].concat());
    assert_eq!(digests("v3"), digests("v2"));
    // Copies of older rounds that a kill cut off are made again; an older round that was changed is refused.
    let copies = street.path().join("v3/rounds/clone");
    std::fs::remove_dir_all(&copies).expect("removed");
    dagger(&[&mixed[..], &["--out", "v3"]].concat());
    assert_eq!(digests("v3"), digests("v2"));
    let copy = std::fs::read_dir(copies).expect("a round").next().expect("an episode").expect("readable").path();
    let text = std::fs::read_to_string(&copy).expect("labels");
    std::fs::write(&copy, text.split_once('\n').expect("lines").1).expect("written");
    let changed = [&["dagger", "recipe.toml"], &mixed[..], &["--out", "v3"]].concat();
    let printed = cosfly(&changed).within(street.path()).run();
    assert!(printed.code != Some(0) && printed.stderr.contains("round `clone` is not"), "{}", printed.stderr);
    let diff = cosfly(&["dagger", "diff", "v2", "v1"]).within(street.path()).run_ok().stdout;
    assert!(diff.contains("dropped: round `next`"), "{diff}");
    let states = std::fs::read(street.path().join("v2/states.npy")).expect("states");
    let actions = std::fs::read(street.path().join("v2/expert_actions.npy")).expect("actions");
    assert!(
        states.starts_with(b"\x93NUMPY") && (states.len() - 128) / 16 == (actions.len() - 128) / 5,
        "{}",
        states.len()
    );
    let bytes = |file: &str| std::fs::metadata(street.path().join(file)).expect("pictures").len() - 128;
    assert_eq!(bytes("v2/mask.npy"), (states.len() as u64 - 128) / 64 * 256);
    assert_eq!(bytes("v2/depth.npy"), 4 * bytes("v2/mask.npy"));
    assert_eq!(bytes("v2/laser_altimeter.npy"), (states.len() as u64 - 128) / 8);
    let again = [&["--policy", "follow", "--round", "clone", "--onto", "v1", "--out", "v4"][..], &kept].concat();
    for (arguments, words) in [
        (&again[..], "has a round `clone` already"),
        (&["--policy", "follow", "--round", "other", "--onto", "v1", "--out", "v4"], "keeps other observations"),
        (&["--policy", "follow", "--round", "other", "--out", "v2"], "another version of labels"),
        (&["--policy", "follow", "--round", "other", "--onto", "nowhere", "--out", "v4"], "no version of labels"),
        (&["--policy", "follow", "--actions", "rotors", "--round", "other", "--out", "v4"], "labels are velocities"),
    ] {
        let printed = cosfly(&[&["dagger", "recipe.toml"], arguments].concat()).within(street.path()).run();
        assert!(printed.code != Some(0) && printed.stderr.contains(words), "{arguments:?}: {}", printed.stderr);
    }
}

#[test]
fn a_result_is_one_file_whose_actions_come_to_the_same_rows() {
    let street = Street::new();
    let at = |name: &str| street.path().join(name);
    let verify = |file: &str, more: &[&str]| {
        cosfly(&[&["fly", "verify", file, "recipe.toml"], more].concat()).within(street.path()).run()
    };
    for (out, policy, more) in [
        ("plain", "follow", &[][..]),
        ("late", "random", &["--latency-ms", "250"]),
        ("dark", "follow", &["--blackouts", "2"]),
        ("measured", "follow", &["--latency-ms", "measured"]),
        ("windy", "expert", &["--drone", "pelican", "--wind-mps", "3", "--gusts", "--logs", "none"]),
    ] {
        fly(&street, out, &[&["--policy", policy, "--clips", "0"], more].concat());
        cosfly(&["fly", "bundle", &format!("{out}/{policy}")]).within(street.path()).run_ok();
        let same = verify(&format!("{out}/{policy}.jsonl.zst"), &[]);
        assert_eq!(same.code, Some(0), "{out}: {}{}", same.stdout, same.stderr);
        assert!(same.stdout.contains("come out the same, byte for byte"), "{}", same.stdout);
    }
    // Somebody changed an action, or a score.
    let bundle = Bundle::read(&at("plain/follow.jsonl.zst")).expect("a bundle");
    assert!(bundle.card.policy.prompt.is_empty());
    let changed = |name: &str, change: &dyn Fn(&mut Bundle)| {
        let mut other = bundle.clone();
        change(&mut other);
        std::fs::write(at(name), other.bytes().expect("bytes")).expect("written");
        let printed = verify(name, &[]);
        (printed.code, printed.stdout + &printed.stderr)
    };
    let (code, said) = changed("older.zst", &|bundle| bundle.card.cosfly = "0.0.9".to_owned());
    assert!(code == Some(0) && said.contains("flown by cosfly 0.0.9 before"), "{said}");
    let last = bundle.episodes[0].steps.len() - 1;
    let (code, text) = changed("action", &|it| {
        let action = it.episodes[0].steps[4].action.as_mut().expect("an action");
        action.velocity_mps.x += 0.25;
    });
    assert!(code == Some(1) && text.contains("step 5 comes out differently"), "{text}");
    let (code, text) = changed("prompt", &|it| it.episodes[0].steps[4].latency_s = Some(0.5));
    assert!(code == Some(1) && text.contains("step 5 comes out differently"), "{text}");
    let (code, text) = changed("early", &|it| it.episodes[0].steps[4].latency_s = Some(-0.5));
    assert!(code == Some(4) && text.contains("its latency is -0.5 s"), "{text}");
    let (code, text) = changed("score", &|it| it.episodes[0].row.score.visible_sum += 1.0);
    assert!(code == Some(1) && text.contains("the row is not"), "{text}");
    let (code, text) = changed("longer", &|it| {
        let step = it.episodes[0].steps[last].clone();
        it.episodes[0].steps.push(step);
    });
    assert!(code == Some(1) && text.contains("it ends after"), "{text}");
    let (code, text) = changed("twice", &|it| it.episodes[1] = it.episodes[0].clone());
    assert!(code == Some(4) && text.contains("stands in it twice"), "{text}");
    let (code, text) = changed("huge", &|it| {
        it.episodes[0].steps[2].action.as_mut().expect("an action").velocity_mps.y = 1e9;
    });
    assert!(code == Some(4) && text.contains("step 3"), "{text}");
    let (code, text) = changed("other", &|it| it.card.suite.hash = "0".repeat(64));
    assert!(code == Some(4) && text.contains("of another suite"), "{text}");
    let printed = verify("plain/follow.jsonl.zst", &["--set", "seed=99"]);
    assert!(printed.code == Some(4) && printed.stderr.contains("of another suite"), "{}", printed.stderr);
    refused(&street, &["bundle", "nowhere"], 4, "is no finished result");
    refused(&street, &["verify", "plain/follow", "recipe.toml"], 4, "is a folder");
    refused(&street, &["verify", "nowhere", "recipe.toml"], 4, "does not exist");
}

#[test]
fn damaged_files_of_results_are_refused_wherever_the_damage_is() {
    let street = Street::new();
    fly(&street, "plain", &["--policy", "hold", "--clips", "0"]);
    cosfly(&["fly", "bundle", "plain/hold", "--out", "hold.zst"]).within(street.path()).run_ok();
    let whole = std::fs::read(street.path().join("hold.zst")).expect("a file");
    let made = Bundle::of_bytes(&whole).expect("whole");
    assert_eq!(made.bytes().expect("bytes"), whole, "the same bytes");
    for round in 0..1000 {
        let mut bytes = whole.clone();
        let place = round * 7919 % bytes.len();
        match round % 3 {
            0 => bytes[place] ^= 1 << (round % 8),
            1 => bytes.truncate(place),
            _ => _ = bytes.remove(place),
        }
        // A flip in the head of the frame may change nothing.
        if let Ok(read) = Bundle::of_bytes(&bytes) {
            assert_eq!(read, made, "round {round}");
        }
    }
}
