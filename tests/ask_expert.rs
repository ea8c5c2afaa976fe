//! `ask-expert`: continuations by the expert from other states, or the reasons for their absence.

use crate::street::Street;
use crate::support::cosfly;
use serde_json::{Value, json};

/// A street whose experts are in the store.
fn flown_street() -> Street {
    let street = Street::new();
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    street
}

fn ask(street: &Street, changes: &[&str]) -> (Option<i32>, Value) {
    let mut arguments = vec!["ask-expert", "recipe.toml", "--trajectory", "expert-p00001", "--json"];
    arguments.extend_from_slice(changes);
    let printed = cosfly(&arguments).within(street.path()).run();
    let answer =
        serde_json::from_str(&printed.stdout).unwrap_or_else(|_| panic!("{}{}", printed.stdout, printed.stderr));
    (printed.code, answer)
}

fn place(waypoint: &Value) -> [f64; 3] {
    core::array::from_fn(|axis| waypoint["position_in_world"][axis].as_f64().expect("a number"))
}

/// Command-line arguments of the state.
fn texts(place: [f64; 3]) -> [String; 3] {
    place.map(|value| value.to_string())
}

#[test]
fn the_expert_goes_on_from_where_the_drone_is_and_again_from_where_that_leads() {
    let street = flown_street();
    let (code, first) =
        ask(&street, &["--frame", "2", "--position-m", "40", "-20", "25", "--velocity-mps", "0", "1", "0"]);
    assert_eq!((code, first["planned"].as_bool()), (Some(0), Some(true)), "{first}");
    let waypoints = first["waypoints"].as_array().expect("waypoints");
    assert_eq!((place(&waypoints[0]), waypoints.len()), ([40.0, -20.0, 25.0], 10));
    assert_eq!((&waypoints[9]["frame"], &waypoints[9]["time_s"]), (&json!(11), &json!(5.5)));
    assert_eq!(first["certificate"]["holds"], json!(true));

    let (at, before) = (place(&waypoints[4]), place(&waypoints[3]));
    let velocity: [f64; 3] = core::array::from_fn(|axis| (at[axis] - before[axis]) / 0.5);
    let ([x, y, z], [vx, vy, vz]) = (texts(at), texts(velocity));
    let state = ["--frame", "6", "--position-m", &x, &y, &z, "--velocity-mps", &vx, &vy, &vz];
    let (_, whole) = ask(&street, &[&state[..], &["--horizon-s", "1e9"]].concat());
    assert_eq!(whole["waypoints"].as_array().map(Vec::len), Some(6), "{whole}");
    let (code, next) = ask(&street, &[&state[..], &["--horizon-s", "1"]].concat());
    assert_eq!((code, next["waypoints"].as_array().map(Vec::len)), (Some(0), Some(3)), "{next}");
}

#[test]
fn states_without_a_way_on_are_answered_with_the_reason() {
    let street = flown_street();
    for (state, reason) in [
        (["--position-m", "40", "-20", "0.2", "--velocity-mps", "0", "0", "0"], "from an obstacle or the ground"),
        (["--position-m", "40", "-20", "25", "--velocity-mps", "0", "15", "0"], "15.00 m/s; the limit is 12 m/s"),
    ] {
        let (code, answer) = ask(&street, &[&["--frame", "0"], &state[..]].concat());
        assert_eq!((code, answer["planned"].as_bool()), (Some(1), Some(false)), "{answer}");
        assert!(answer["reason"].as_str().is_some_and(|found| found.contains(reason)), "{answer}");
    }
}

#[test]
fn a_batch_answers_line_by_line_and_names_lines_that_are_no_states() {
    let street = flown_street();
    let lines = [
        r#"{"trajectory_id": "perturbed-p00001", "frame": 2, "position_in_world": [40, -20, 25], "velocity_in_world": [0, 1, 0]}"#,
        r#"{"trajectory_id": "expert-p00001", "frame": 2}"#,
        r#"{"trajectory_id": "expert-p00009", "frame": 2, "position_in_world": [40, -20, 25]}"#,
        r#"{"trajectory_id": "expert/p00001", "frame": 2, "position_in_world": [40, -20, 25], "velocity_in_world": [0, 1, 0]}"#,
    ];
    let batch = cosfly(&["ask-expert", "recipe.toml", "--batch"]).within(street.path()).fed(lines.join("\n")).run();
    assert_eq!(batch.code, Some(4), "{}", batch.stderr);
    let answers: Vec<Value> =
        batch.stdout.lines().map(|line| serde_json::from_str(line).expect("a line of JSON")).collect();
    assert_eq!(answers.len(), 4);
    assert_eq!((&answers[1]["line"], &answers[1]["error"]["code"]), (&json!(2), &json!("ask-expert-line")));
    assert_eq!((&answers[2]["line"], &answers[2]["error"]["code"]), (&json!(3), &json!("ask-expert-unknown")));
    let (_, single) =
        ask(&street, &["--frame", "2", "--position-m", "40", "-20", "25", "--velocity-mps", "0", "1", "0"]);
    for answer in [&answers[0], &answers[3]] {
        assert_eq!((&answer["waypoints"], &answer["certificate"]), (&single["waypoints"], &single["certificate"]));
    }
}

#[test]
fn a_line_that_is_no_text_spoils_no_other_line_and_null_is_as_good_as_nothing() {
    let street = flown_street();
    let state = r#"{"trajectory_id": "expert-p00001", "frame": 2, "position_in_world": [40, -20, 25], "velocity_in_world": null}"#;
    let lines = [state.as_bytes(), b"\xff\xfe", b"", state.as_bytes()].join(&b"\n"[..]);
    let batch = cosfly(&["ask-expert", "recipe.toml", "--batch"]).within(street.path()).fed(lines).run();
    assert_eq!((batch.code, batch.stderr.as_str()), (Some(4), ""));
    let answers: Vec<Value> = batch.stdout.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!((answers.len(), &answers[1]["line"]), (3, &json!(2)));
    assert!(answers[1]["error"]["message"].as_str().is_some_and(|found| found.contains("UTF-8")), "{}", answers[1]);
    assert_eq!((&answers[0]["planned"], &answers[0]), (&json!(true), &answers[2]));
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_no_success() {
    let street = flown_street();
    let state = r#"{"trajectory_id": "expert-p00001", "frame": 2, "position_in_world": [40, -20, 25]}"#;
    let batch = cosfly(&["ask-expert", "recipe.toml", "--batch"]).within(street.path()).fed(state);
    for call in [cosfly(&["town"]), cosfly(&["graph", "recipe.toml"]).within(street.path()), batch] {
        let (code, words) = call.run_on_a_full_disk();
        assert_eq!(code, Some(5), "{words}");
        assert!(words.contains("could not write to standard output"), "{words}");
    }
}

/// Exit code and messages of an invalid request.
fn check_refusal(name: &str, street: &Street, arguments: &[&str]) {
    let all = [&["ask-expert", "recipe.toml"], arguments].concat();
    let printed = cosfly(&all).within(street.path()).run();
    let code = printed.code.map_or("none".into(), |code| code.to_string());
    insta::assert_snapshot!(name, format!("exit code {code}\n{}", printed.stderr));
}

#[test]
fn questions_that_cannot_be_answered_say_what_to_do() {
    let place = ["--position-m", "40", "-20", "25"];
    let asked = |id: &'static str, frame: &'static str| [&["--trajectory", id, "--frame", frame], &place[..]].concat();
    let untouched = Street::new();
    check_refusal("ask_expert_before_a_run", &untouched, &asked("expert-p00001", "2"));
    assert!(!untouched.path().join(".cosfly").exists(), "asking makes no store");
    let street = flown_street();
    check_refusal("ask_expert_unknown", &street, &asked("expert-p0001", "2"));
    check_refusal("ask_expert_beyond_the_end", &street, &asked("expert-p00001", "12"));
    check_refusal("ask_expert_changed", &street, &[&asked("expert-p00001", "2")[..], &["--set", "seed=9"]].concat());
    check_refusal("ask_expert_horizon", &street, &[&asked("expert-p00001", "2")[..], &["--horizon-s", "0"]].concat());
    let at = |place: [&'static str; 3]| {
        [&["--trajectory", "expert-p00001", "--frame", "2", "--position-m"], &place[..]].concat()
    };
    check_refusal("ask_expert_far_away", &street, &at(["1e5", "-20", "25"]));
    check_refusal("ask_expert_nowhere", &street, &at(["nan", "-20", "25"]));
    check_refusal("ask_expert_nothing_asked", &street, &["--frame", "2"]);
}
