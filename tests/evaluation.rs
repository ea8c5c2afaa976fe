//! `cosfly eval` through the real binary: scores, baselines, malformed rows, errors.

use crate::street::{RECIPE, Street, map};
use crate::support::{Printed, cosfly, tree_digests};
use std::path::Path;

fn street() -> Street {
    let street = Street::new();
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    street
}

fn eval(street: &Street, arguments: &[&str]) -> Printed {
    cosfly(&[&["eval", "out/street"], arguments].concat()).within(street.path()).run()
}

fn row(trajectory: &str, step: &str) -> String {
    let deltas = [step; 5].join(", ");
    format!("{{\"trajectory_id\": \"{trajectory}\", \"frame\": 0, \"waypoint_deltas\": [{deltas}]}}\n")
}

fn report(path: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(path.join("report.json")).expect("a report")).expect("JSON")
}

#[test]
fn predictions_are_scored_beside_baselines_the_same_way_twice() {
    let street = street();
    let ids = ["perturbed-p00000", "perturbed-p00001", "perturbed-p00002"];
    let text: String = ids.iter().map(|id| row(id, "[0, 0, 0]")).collect();
    std::fs::write(street.path().join("zero.jsonl"), text).expect("writable");
    let before = tree_digests(&street.dataset());
    let printed = eval(&street, &["zero.jsonl"]);
    assert_eq!(printed.code, Some(0), "{}", printed.stderr);
    assert!(printed.stdout.contains("| SR@1m %") && printed.stdout.contains("constant velocity"), "{}", printed.stdout);
    let folder = street.path().join("zero-evaluation");
    let found = report(&folder);
    assert_eq!((&found["rows"]["scored"], &found["rows"]["malformed"]), (&3.into(), &0.into()));
    assert_eq!(found["methods"][0]["scores"]["fde_m"], found["methods"][1]["scores"]["fde_m"], "zero is zero");
    let again = eval(&street, &["zero.jsonl", "--out", "again", "--json", "--jobs", "1"]);
    assert_eq!(again.stdout, std::fs::read_to_string(street.path().join("again/report.json")).expect("a report"));
    assert!(tree_digests(&folder) == tree_digests(&street.path().join("again")));
    assert!(tree_digests(&street.dataset()) == before, "the dataset itself is not touched");
}

#[test]
fn baselines_are_scored_without_predictions() {
    let street = street();
    let printed = eval(&street, &["--out", "base", "--input", "expert"]);
    assert_eq!(printed.code, Some(0), "{}", printed.stderr);
    let found = report(&street.path().join("base"));
    assert!(found["rows"].is_null() && found["methods"][0]["name"] == "predict zero");
}

#[test]
fn malformed_rows_are_counted_and_named() {
    let street = street();
    let answer = "<think>[1, 2]</think> Here: {\\\"waypoint_deltas\\\": [{\\\"dx\\\": 1}, [1], [1], [1], [1]]}";
    let text = [
        format!("{{\"trajectory_id\": \"perturbed-p00001\", \"frame\": 0, \"text\": \"{answer}\"}}\n"),
        "{\"trajectory_id\": \"perturbed-p00001\"\n".to_owned(),
        row("perturbed-p00001", "[1]"),
        row("perturbed-p00099", "[1]"),
        row("perturbed-p00000", "[NaN]"),
        row("perturbed-p00000", "[1e999]"),
        row("expert-p00000", "[1]"),
        row("perturbed-p00002", "[1]").replace("\"frame\": 0", "\"frame\": 1"),
        row("perturbed-p00002", "[1], [2]"),
        "{\"trajectory_id\": \"perturbed-p00002\", \"frame\": 0, \"text\": \"no\"}\n".to_owned(),
    ];
    std::fs::write(street.path().join("mixed.jsonl"), text.concat()).expect("writable");
    let printed = eval(&street, &["mixed.jsonl"]);
    assert_eq!(printed.code, Some(1), "{}", printed.stderr);
    assert!(printed.stdout.contains("9 of 10 rows") && printed.stdout.contains("line 2: "), "{}", printed.stdout);
    let problems = report(&street.path().join("mixed-evaluation"))["rows"]["problems"].clone();
    insta::assert_snapshot!("eval_malformed", serde_json::to_string_pretty(&problems).expect("JSON"));
}

#[test]
fn an_absurd_number_is_a_malformed_row_and_writes_small_reports() {
    let street = street();
    let answer = "{\\\"waypoint_deltas\\\": [[1e24], [0], [0], [0], [0]]}";
    let text = [
        row("perturbed-p00000", "[1e23]"),
        format!("{{\"trajectory_id\": \"perturbed-p00001\", \"frame\": 0, \"text\": \"{answer}\"}}\n"),
        row("perturbed-p00001", "[0.1]"),
        row("perturbed-p00002", "[9e8]"),
    ];
    std::fs::write(street.path().join("huge.jsonl"), text.concat()).expect("writable");
    let printed = eval(&street, &["huge.jsonl"]);
    assert_eq!(printed.code, Some(1), "{}", printed.stderr);
    assert!(printed.stdout.contains("**Partial: 1 of 3 windows without a prediction."), "{}", printed.stdout);
    assert!(
        printed.stdout.contains("line 1: `dx` of waypoint 1 is larger than 1e9 in magnitude: 1e23"),
        "{}",
        printed.stdout
    );
    let folder = street.path().join("huge-evaluation");
    assert_eq!(report(&folder)["rows"]["kinds"], serde_json::json!({"implausible": 2}));
    for name in ["errors.svg", "report.md", "report.json"] {
        let size = std::fs::metadata(folder.join(name)).expect("written").len();
        assert!(size < 500_000, "{name} has {size} bytes");
    }
}

#[test]
fn windows_of_cameras_with_other_steps_have_no_common_mean() {
    let cameras = "height = 54\n[stages.frames.cameras.front]\n[stages.frames.cameras.slow]\nevery = 2\n";
    let street = Street::with(&RECIPE.replacen("height = 54\n", cameras, 1), &map());
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let windows = ["--history", "2", "--horizon", "1", "--split", "train", "--split", "val", "--out", "scores"];
    let score = |more: &[&str]| eval(&street, &[more, &windows].concat());
    let printed = score(&[]);
    let words = ["evaluation-steps", "`--camera front` or `--camera slow`"];
    assert!(printed.code == Some(4) && words.iter().all(|it| printed.stderr.contains(it)), "{}", printed.stderr);
    let windows_of = |camera: &str| {
        let printed = score(&["--camera", camera]);
        assert_eq!(printed.code, Some(0), "{}", printed.stderr);
        report(&street.path().join("scores"))["windows"]["expected"].as_u64().expect("a count")
    };
    assert!(windows_of("front") > windows_of("slow"), "the slow camera has half the frames");
    // Predictions for the films of a camera are of that camera.
    let text = row("perturbed-p00000-slow", "[0]").replace(", [0], [0], [0], [0]", "");
    std::fs::write(street.path().join("slow.jsonl"), text).expect("writable");
    let printed = score(&["slow.jsonl", "--missing-as-zero"]);
    assert_eq!(printed.code, Some(0), "{}", printed.stderr);
    assert_eq!(report(&street.path().join("scores"))["settings"]["cameras"], serde_json::json!(["slow"]));
    let printed = score(&["--camera", "rear"]);
    assert!(printed.code == Some(3) && printed.stderr.contains("front, slow"), "{}", printed.stderr);
}

#[test]
fn a_part_of_the_windows_is_no_score_of_the_dataset() {
    let street = street();
    std::fs::write(street.path().join("one.jsonl"), row("perturbed-p00000", "[0]")).expect("writable");
    let splits = ["--split", "train", "--split", "val"];
    let printed = eval(&street, &[&["one.jsonl"][..], &splits].concat());
    assert_eq!(printed.code, Some(1), "{}", printed.stderr);
    assert!(printed.stdout.contains("**Partial: 2 of 3 windows without a prediction."), "{}", printed.stdout);
    assert_eq!(report(&street.path().join("one-evaluation"))["is_partial"], true);
    let filled = eval(&street, &[&["one.jsonl", "--missing-as-zero"][..], &splits].concat());
    assert_eq!(filled.code, Some(0), "{}", filled.stderr);
    assert!(!filled.stdout.contains("Partial"), "{}", filled.stdout);
}

#[test]
fn an_empty_list_of_detections_scores_zero_and_says_so() {
    let street = street();
    cosfly(&["export", "out/street", "--format", "coco", "--out", "coco"]).within(street.path()).run_ok();
    let images = ["--images", "coco/annotations/instances_train.json"];
    std::fs::write(street.path().join("none.json"), "[]").expect("writable");
    for arguments in [&["none.json"][..], &[&["none.json"][..], &images].concat()] {
        let printed = eval(&street, arguments);
        assert_eq!(printed.code, Some(1), "{}", printed.stderr);
        assert!(printed.stdout.contains("**Empty: there is no detection."), "{}", printed.stdout);
        assert_eq!(report(&street.path().join("none-evaluation"))["scores"]["ap"]["value"], 0.0);
    }
    let found =
        |score: &str| format!("{{\"image_id\": 1, \"category_id\": 12, \"bbox\": [1, 2, 3, 4], \"score\": {score}}}");
    std::fs::write(street.path().join("nan.json"), format!("[{}, {}]", found("NaN"), found("0.5"))).expect("writable");
    let printed = eval(&street, &[&["nan.json"][..], &images].concat());
    assert_eq!(printed.code, Some(1), "{}", printed.stderr);
    let files = report(&street.path().join("nan-evaluation"))["files"].clone();
    assert_eq!((&files["scored"], &files["kinds"]), (&1.into(), &serde_json::json!({"not-finite": 1})));
    assert!(files["problems"][0]["reason"].as_str().expect("words").contains("`score` is not finite"), "{files}");
}

#[test]
fn what_cannot_be_scored_is_refused_with_a_way_out() {
    let street = street();
    std::fs::write(street.path().join("strangers.jsonl"), row("nobody", "[1]")).expect("writable");
    std::fs::write(street.path().join("empty.jsonl"), "").expect("writable");
    for (name, arguments) in [
        ("eval_no_overlap", &["strangers.jsonl"][..]),
        ("eval_empty", &["empty.jsonl"]),
        ("eval_no_file", &["nowhere.jsonl"]),
        ("eval_unknown_split", &["strangers.jsonl", "--split", "exam"]),
        ("eval_too_long", &["strangers.jsonl", "--history", "50"]),
    ] {
        let printed = eval(&street, arguments);
        let code = printed.code.unwrap_or(-1);
        insta::assert_snapshot!(name, format!("exit code {code}\n{}", printed.stderr));
        assert!(!street.path().join("strangers-evaluation").exists());
    }
    let swapped = cosfly(&["eval", "strangers.jsonl", "out/street"]).within(street.path()).run();
    assert_eq!(swapped.code, Some(4));
    assert!(swapped.stderr.contains("the dataset comes first"), "{}", swapped.stderr);
}

#[test]
fn exported_truth_scores_perfectly_and_faulty_pictures_are_named() {
    let street = street();
    for format in ["imagefolder", "coco"] {
        cosfly(&["export", "out/street", "--format", format, "--out", format]).within(street.path()).run_ok();
    }
    for (kind, key, expected) in [("depth", "delta1", 1.0), ("semantic", "miou", 1.0)] {
        let printed = eval(&street, &["imagefolder", "--kind", kind, "--out", kind]);
        assert_eq!(printed.code, Some(0), "{}", printed.stderr);
        let found = report(&street.path().join(kind));
        assert_eq!(found["scores"][key]["value"], expected, "{kind}");
        assert_eq!(
            (&found["frames"]["scored"], &found["files"]["malformed"]),
            (&found["frames"]["expected"], &0.into())
        );
    }
    let unclear = eval(&street, &["imagefolder"]);
    insta::assert_snapshot!("eval_two_kinds", format!("exit code {}\n{}", unclear.code.unwrap_or(-1), unclear.stderr));

    let annotations = street.path().join("coco/annotations/instances_train.json");
    let truth: serde_json::Value =
        serde_json::from_slice(&std::fs::read(annotations).expect("exported")).expect("JSON");
    let rows = truth["annotations"].as_array().expect("a list").iter().map(|it| {
        serde_json::json!({"image_id": it["image_id"], "category_id": it["category_id"], "bbox": it["bbox"], "score": 0.5})
    });
    let rows: Vec<_> = rows.collect();
    std::fs::write(street.path().join("boxes.json"), serde_json::to_vec(&rows).expect("JSON")).expect("writable");
    let images = ["--images", "coco/annotations/instances_train.json"];
    let printed = eval(&street, &[&["boxes.json", "--out", "boxes"][..], &images].concat());
    assert_eq!(printed.code, Some(0), "{}", printed.stderr);
    assert_eq!(report(&street.path().join("boxes"))["scores"]["ap"]["value"], 1.0);
    let unexplained = eval(&street, &["boxes.json"]);
    insta::assert_snapshot!(
        "eval_unexplained",
        format!("exit code {}\n{}", unexplained.code.unwrap_or(-1), unexplained.stderr)
    );

    let folder = street.path().join("faulty/expert-p00000");
    std::fs::create_dir_all(&folder).expect("writable");
    let picture = "imagefolder/train/depth/000/expert-p00000/000/000000.png";
    std::fs::copy(street.path().join(picture), folder.join("0.png")).expect("exported");
    std::fs::write(folder.join("1.png"), "no picture").expect("writable");
    std::fs::copy(folder.join("0.png"), folder.join("77777.png")).expect("writable");
    let printed = eval(&street, &["faulty", "--kind", "depth"]);
    assert_eq!(printed.code, Some(1), "{}", printed.stderr);
    let files = report(&street.path().join("faulty-evaluation"))["files"].clone();
    assert_eq!(files["kinds"], serde_json::json!({"no-frame": 1, "unreadable": 1}));
    assert_eq!(files["problems"][0]["place"], "expert-p00000/1.png");
}

/// Results of a tracker that finds what an export has: its files of truth, changed by `change`.
fn tracker(street: &Street, name: &str, export: &str, truth: &str, change: &dyn Fn(&str) -> String) {
    let list = std::fs::read_to_string(street.path().join(export).join("sequences.jsonl")).expect("exported");
    let folder = street.path().join(name);
    std::fs::create_dir_all(&folder).expect("writable");
    for line in list.lines() {
        let row: serde_json::Value = serde_json::from_str(line).expect("JSON");
        let [split, sequence] = ["split", "sequence"].map(|key| row[key].as_str().expect("a text").to_owned());
        let kind = sequence.split('-').next().expect("a word");
        let path = truth.replace("SPLIT", &split).replace("KIND", kind).replace("SEQUENCE", &sequence);
        let text = std::fs::read_to_string(street.path().join(export).join(path)).expect("exported");
        std::fs::write(folder.join(format!("{sequence}.txt")), change(&text)).expect("writable");
    }
}

#[test]
fn trackers_that_find_the_truth_score_perfectly() {
    let street = street();
    for format in ["mot", "otb", "lasot"] {
        cosfly(&["export", "out/street", "--format", format, "--out", format]).within(street.path()).run_ok();
    }
    let of_many = |text: &str| {
        text.lines().map(|line| line.rsplit_once(",1,").map_or("", |it| it.0).to_owned() + ",1\n").collect()
    };
    tracker(&street, "many", "mot", "SPLIT/SEQUENCE/gt/gt.txt", &of_many);
    // Whatever a tracker says where nobody is seen, does not count.
    let of_target = |text: &str| text.replace("NaN,NaN,NaN,NaN", "1,1,5,5");
    tracker(&street, "target", "otb", "SPLIT/SEQUENCE/groundtruth_rect.txt", &of_target);
    tracker(&street, "named", "lasot", "SPLIT/KIND/SEQUENCE/groundtruth.txt", &str::to_owned);
    for (name, options, keys) in [
        ("many", &[][..], &["hota", "det_a", "ass_a", "idf1", "mota"][..]),
        ("target", &[], &["precision", "normalised_precision"]),
        ("named", &["--sequences", "lasot"], &["precision", "normalised_precision"]),
    ] {
        let printed = eval(&street, &[&[name][..], options].concat());
        assert_eq!(printed.code, Some(0), "{}{}", printed.stdout, printed.stderr);
        assert!(printed.stdout.contains("## By sequence, the worst first"), "{}", printed.stdout);
        let found = report(&street.path().join(format!("{name}-evaluation")));
        for key in keys {
            let score = found["scores"][key]["value"].as_f64().expect("a score");
            assert!((score - 1.0).abs() < 1e-9, "{name}, {key}: {score}");
        }
    }
}

#[test]
fn faulty_files_of_trackers_are_named_and_left_out() {
    let street = street();
    cosfly(&["export", "out/street", "--format", "otb", "--out", "otb"]).within(street.path()).run_ok();
    let of_target = |text: &str| text.replace("NaN,NaN,NaN,NaN", "1,1,5,5");
    tracker(&street, "some", "otb", "SPLIT/SEQUENCE/groundtruth_rect.txt", &of_target);
    let file = |name: &str| street.path().join("some").join(name);
    let text = std::fs::read_to_string(file("expert-p00000.txt")).expect("written");
    let faulty = text.lines().next().expect("a line").to_owned() + "\nNaN,NaN,NaN,NaN\n";
    std::fs::write(file("expert-p00000.txt"), faulty).expect("writable");
    std::fs::write(file("stranger.txt"), "1,1,5,5\n").expect("writable");
    std::fs::remove_file(file("expert-p00001.txt")).expect("it was there");
    let printed = eval(&street, &["some"]);
    assert_eq!(printed.code, Some(1), "{}", printed.stderr);
    let found = report(&street.path().join("some-evaluation"));
    assert_eq!(found["files"]["kinds"], serde_json::json!({"not-finite": 1, "unknown-sequence": 1}));
    assert_eq!(found["files"]["problems"][0]["place"], "expert-p00000.txt line 2");
    let missing: Vec<&String> = found["frames"]["missing"].as_object().expect("an object").keys().collect();
    assert_eq!(missing, ["expert-p00000", "expert-p00001"]);
    assert_eq!(found["is_partial"], true);

    std::fs::create_dir(street.path().join("strangers")).expect("writable");
    std::fs::rename(file("stranger.txt"), street.path().join("strangers/stranger.txt")).expect("writable");
    let nothing = eval(&street, &["strangers"]);
    insta::assert_snapshot!(
        "eval_strange_tracker",
        format!("exit code {}\n{}", nothing.code.unwrap_or(-1), nothing.stderr)
    );
}

#[test]
fn the_help_has_examples() {
    insta::assert_snapshot!("help_eval", cosfly(&["eval", "--help"]).run_ok().stdout);
}
