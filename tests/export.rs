//! `cosfly export` through the real binary: output and error messages.

use crate::street::Street;
use crate::support::{Printed, cosfly, tree_digests};

fn export(street: &Street, arguments: &[&str]) -> Printed {
    cosfly(&[&["export"], arguments].concat()).within(street.path()).run()
}

#[test]
fn a_dataset_is_exported_whole_or_not_at_all() {
    let street = Street::new();
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let before = tree_digests(&street.dataset());
    let first = export(&street, &["out/street", "--format", "v7", "--out", "v7"]);
    assert_eq!(first.code, Some(0), "{}", first.stderr);

    assert!(first.stdout.starts_with("v7: ") && first.stdout.contains("`Town01`"), "{}", first.stdout);
    assert!(tree_digests(&street.dataset()) == before, "the dataset itself is not touched");
    for (name, arguments) in [
        ("export_exists", &["out/street", "--format", "v7", "--out", "v7"][..]),
        ("export_inside", &["out/street", "--format", "v7", "--out", "out/street/v7"]),
        ("export_town", &["out/street", "--format", "v7", "--out", "x", "--town", "street=Paris"]),
        ("export_split", &["out/street", "--format", "v7", "--out", "x", "--split", "dev"]),
        ("export_pairs", &["out/street", "--format", "v7", "--out", "x", "--trajectory", "expert-p00000"]),
        ("export_format", &["out/street", "--format", "v8", "--out", "x"]),
        ("export_foreign_option", &["out/street", "--format", "coco", "--out", "x", "--shard-mb", "100"]),
        ("export_option_value", &["out/street", "--format", "v7", "--out", "x", "--town", "street"]),
    ] {
        let printed = export(&street, arguments);
        let code = printed.code.unwrap_or(-1);
        insta::assert_snapshot!(name, format!("exit code {code}\n{}", printed.stderr));
    }
    let left = std::fs::read_dir(street.path()).expect("a folder").map(|entry| entry.expect("readable").file_name());
    assert!(left.into_iter().all(|name| name != "x" && !name.to_string_lossy().starts_with(".x.unfinished")));
}

#[test]
fn the_answers_that_models_learn_are_scored_as_right() {
    let street = Street::new();
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let shape = ["--history", "3", "--horizon", "2", "--frame", "body"];
    export(&street, &[&["out/street", "--format", "vlm", "--out", "vlm"][..], &shape].concat());
    let lines = ["train", "val"].map(|split| std::fs::read_to_string(street.path().join(format!("vlm/{split}.jsonl"))));
    let mut answers = String::new();
    for line in lines.iter().flatten().flat_map(|text| text.lines()) {
        let row: serde_json::Value = serde_json::from_str(line).expect("JSON");
        let answer = serde_json::json!({
            "trajectory_id": row["trajectory_id"],
            "frame": row["frame"],
            "text": format!("<think>where to?</think>{}", row["messages"][2]["content"].as_str().expect("text")),
        });
        answers.push_str(&format!("{answer}\n"));
    }
    std::fs::write(street.path().join("answers.jsonl"), answers).expect("writable");
    let scored = cosfly(&[&["eval", "out/street", "answers.jsonl", "--json"][..], &shape].concat())
        .within(street.path())
        .run_ok();
    let report: serde_json::Value = serde_json::from_str(&scored.stdout).expect("JSON");
    let of_answers = &report["methods"][0];
    let score = |name: &str| of_answers["scores"][name]["value"].as_f64().expect("a score");
    assert_eq!(of_answers["name"], "predictions");
    assert!(score("ade_m") < 0.001 && score("yaw_mae_deg") < 0.01, "{of_answers}");
}

#[test]
fn the_help_has_examples() {
    insta::assert_snapshot!("help_export", cosfly(&["export", "--help"]).run_ok().stdout);
}

#[test]
fn bags_of_a_result_name_the_episodes_without_a_log() {
    let street = Street::new();
    cosfly(&["fly", "recipe.toml", "--out", "flown", "--policy", "follow", "--clips", "0"])
        .within(street.path())
        .run_ok();
    let logs = street.path().join("flown/follow/logs");
    let mut names: Vec<_> = std::fs::read_dir(&logs).expect("logs").map(|it| it.expect("a file").path()).collect();
    names.retain(|path| path.extension().is_some_and(|it| it == "mcap"));
    names.sort();
    assert!(names.len() > 1);
    std::fs::remove_file(&names[0]).expect("removed");
    let printed = cosfly(&["fly", "bags", "flown/follow", "--out", "bags"]).within(street.path()).run();
    let lost = names[0].file_stem().expect("a name").to_string_lossy();
    let told = format!("1 episode without a log, so without a bag: `{lost}`");
    assert!(printed.code == Some(0) && printed.stdout.contains(&told), "{}{}", printed.stdout, printed.stderr);
    // Another byte of the next one is no other flight.
    let mut bytes = std::fs::read(&names[1]).expect("a log");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&names[1], bytes).expect("written");
    let refused = cosfly(&["fly", "bags", "flown/follow", "--out", "more"]).within(street.path()).run();
    assert!(refused.code == Some(4) && refused.stderr.contains("error[dataset-damaged]"), "{}", refused.stderr);
    assert!(!street.path().join("more").exists());
}
