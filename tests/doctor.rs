//! `cosfly doctor` through the real binary: intact data, damaged data, other folders.

use crate::street::{RECIPE, Street, map};
use crate::support::{cosfly, tree_digests};

#[test]
fn sound_data_and_damaged_data_are_told_apart() {
    let street = Street::new();
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let examined = |more: &[&str]| {
        let arguments = [&["doctor", "out/street", "--imperfect-share", "1"], more].concat();
        cosfly(&arguments).within(street.path()).run()
    };
    let printed = examined(&["--quota", "0:2-4"]);
    assert_eq!(printed.code, Some(0), "{}{}", printed.stdout, printed.stderr);
    assert!(printed.stdout.contains("6 episodes with 72 frames") && printed.stdout.contains("quota met"));
    assert_eq!(examined(&["--quota", "0:2-4", "--jobs", "1"]).stdout, printed.stdout);
    assert_eq!(examined(&["--quota", "1:90-99"]).code, Some(1), "a quota that is not met");
    let log = street.dataset().join("mcap/street/000/perturbed-p00001.mcap");
    let mut bytes = std::fs::read(&log).expect("the log");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 4;
    std::fs::remove_file(&log).and_then(|()| std::fs::write(&log, bytes)).expect("writable");
    let printed = examined(&["--out", "verdict.json"]);
    assert_eq!(printed.code, Some(1));
    assert!(printed.stdout.contains("damage: mcap/street/000/perturbed-p00001.mcap"), "{}", printed.stdout);
    let verdict = std::fs::read(street.path().join("verdict.json")).expect("a verdict");
    let verdict: serde_json::Value = serde_json::from_slice(&verdict).expect("JSON");
    assert_eq!(verdict["flags"][0]["name"], "log-damaged");
}

#[test]
fn a_folder_of_no_known_layout_and_a_strange_quota_are_refused() {
    let street = Street::new();
    let printed = cosfly(&["doctor", "."]).within(street.path()).run();
    assert_eq!(printed.code, Some(4));
    insta::assert_snapshot!("doctor_unknown", printed.stderr);
    assert_eq!(cosfly(&["doctor", ".", "--quota", "0.2:4-2"]).within(street.path()).run().code, Some(2));
    insta::assert_snapshot!("help_doctor", cosfly(&["doctor", "--help"]).run_ok().stdout);
}

/// The street's recipe with a stage `inspect` between pictures and dataset.
fn inspected(parameters: &str) -> Street {
    inspected_in(RECIPE, parameters)
}

fn inspected_in(recipe: &str, parameters: &str) -> Street {
    let stage = format!(
        "[stages.inspected]\nuse = \"inspect\"\ninputs = {{ town = \"town\", frames = \"frames\" }}\n{parameters}\n"
    );
    let recipe = recipe.replace("frames = \"frames\"", "frames = \"inspected\"");
    Street::with(&recipe.replace("[stages.captions]", &format!("{stage}\n[stages.captions]")), &map())
}

#[test]
fn the_stage_inspect_lets_sound_flights_pass_and_leaves_out_imperfect_families() {
    let street = inspected("imperfect_share = 1.0");
    let printed = cosfly(&["run", "recipe.toml"]).within(street.path()).run_ok();
    assert!(printed.stdout.contains("kept: 6 of 6"), "{}", printed.stdout);
    let plain = Street::new();
    cosfly(&["run", "recipe.toml", "--quiet"]).within(plain.path()).run_ok();
    let tables = |street: &Street| tree_digests(&street.dataset().join("data/frames"));
    assert_eq!(tables(&street), tables(&plain), "what is kept passes as it is");
    // Targets in the exact middle of these tiny pictures fall between the pixels' centres.
    let exact = "use = \"plan\"\naim = { framing_deg = 0.0, tremor_deg = 0.0, lag_s = 0.0, lag_deviation_s = 0.0 }";
    let strict = RECIPE.replace("use = \"plan\"", exact).replace("width = 96\nheight = 54", "width = 72\nheight = 41");
    let strict = inspected_in(&strict, "");
    let printed = cosfly(&["run", "recipe.toml"]).within(strict.path()).run_ok();
    assert!(printed.stdout.contains("kept: 2 of 6"), "{}", printed.stdout);
    assert!(printed.stdout.contains("[mostly-lost]; more than 5.0 % would be imperfect"), "{}", printed.stdout);
    cosfly(&["verify", "out/street"]).within(strict.path()).run_ok();
}

#[test]
fn a_quota_that_no_flight_meets_is_refused() {
    let street = inspected("quotas = [{ share = 0.2, min_s = 30.0, max_s = 40.0 }]");
    let printed = cosfly(&["run", "recipe.toml"]).within(street.path()).run();
    assert_eq!(printed.code, Some(3), "{}", printed.stderr);
    assert!(printed.stderr.contains("no flight loses its target for 30 to 40 s"), "{}", printed.stderr);
}

#[test]
fn flights_that_follow_nobody_lose_nobody() {
    let patrol = "use = \"plan\"\ninputs = { town = \"town\" }\nobjective = \"patrol\"\npatrol = { radius_m = 20 }";
    let (expert, rest) = RECIPE.split_once("[stages.walkers]").expect("walkers");
    let (_, frames) = rest.split_once("[stages.frames]").expect("frames");
    let frames = frames.replace("\"perturbed\"", "").replace("\"expert\", ", "\"expert\"");
    let street = inspected_in(&format!("{expert}[stages.expert]\n{patrol}\n\n[stages.frames]{frames}"), "");
    let printed = cosfly(&["run", "recipe.toml"]).within(street.path()).run_ok();
    assert!(printed.stdout.contains("kept: 1 of 1"), "{}", printed.stdout);
    let printed = cosfly(&["doctor", "out/street"]).within(street.path()).run();
    assert_eq!(printed.code, Some(0), "{}{}", printed.stdout, printed.stderr);
    assert!(
        printed.stdout.contains("1 without a flag") && !printed.stdout.contains("visible share"),
        "{}",
        printed.stdout
    );
}
