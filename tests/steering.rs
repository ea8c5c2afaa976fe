//! Planner parameters have the effects described in the book, by the certificates in the dataset; other objectives
//! work.

use crate::street::{RECIPE, Street, map};
use crate::support::{Printed, cosfly};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::collections::BTreeMap;

/// The street with longer walks, experts only.
const WALKERS: &str = "stages.walkers.frames=48";

/// Experts of the street with `changes`: the output, and per flight the numbers of table `trajectories`.
fn flights(changes: &[&str]) -> (Printed, Vec<BTreeMap<String, f64>>) {
    let street = Street::with(&RECIPE.replace("[\"expert\", \"perturbed\"]", "[\"expert\"]"), &map());
    let mut arguments = vec!["run", "recipe.toml", "--set", WALKERS];
    changes.iter().for_each(|change| arguments.extend_from_slice(&["--set", change]));
    let printed = cosfly(&arguments).within(street.path()).run_ok();
    cosfly(&["verify", "out/street"]).within(street.path()).run_ok();
    (printed, numbers(&street))
}

fn numbers(street: &Street) -> Vec<BTreeMap<String, f64>> {
    let folder = street.dataset().join("data/trajectories");
    let files = std::fs::read_dir(folder).expect("a table").map(|file| file.expect("entry").path());
    let mut rows = Vec::new();
    for file in files {
        let reader = SerializedFileReader::new(std::fs::File::open(file).expect("readable")).expect("Parquet");
        for row in reader.get_row_iter(None).expect("rows").map(|row| row.expect("readable")) {
            let number = |field: &Field| match field {
                Field::Double(value) => Some(*value),
                Field::Long(value) => Some(*value as f64),
                Field::Int(value) => Some(f64::from(*value)),
                Field::Bool(value) => Some(f64::from(u8::from(*value))),
                _ => None,
            };
            let named = row.get_column_iter().filter_map(|(name, field)| Some((name.clone(), number(field)?)));
            rows.push(named.collect());
        }
    }
    rows
}

fn mean(rows: &[BTreeMap<String, f64>], column: &str) -> f64 {
    rows.iter().map(|row| row[column]).sum::<f64>() / rows.len() as f64
}

#[test]
fn distance_pitch_and_altitude_bands_are_seen_in_the_mean_distance() {
    let (_, usual) = flights(&[]);
    let view = ["distance_m=14", "min_altitude_m=8", "preferred_altitude_m=9", "max_altitude_m=14", "max_radius_m=20"];
    let near: Vec<String> = view.iter().map(|change| format!("stages.expert.view.{change}")).collect();
    let (_, near) = flights(&near.iter().map(String::as_str).collect::<Vec<_>>());
    assert!((mean(&usual, "mean_distance_m") - 28.0).abs() < 3.0, "{}", mean(&usual, "mean_distance_m"));
    assert!((mean(&near, "mean_distance_m") - 14.0).abs() < 3.0, "{}", mean(&near, "mean_distance_m"));
}

#[test]
fn presets_keep_behind_the_walker_or_fly_short_ways() {
    let (_, usual) = flights(&[]);
    let (_, rear) = flights(&["stages.expert.preset=rear"]);
    assert!(mean(&rear, "mean_rear_angle_deg") <= mean(&usual, "mean_rear_angle_deg") + 1.0);
    let (_, short) = flights(&["stages.expert.preset=short"]);
    assert!(mean(&short, "length_m") <= mean(&usual, "length_m") + 0.1);
}

#[test]
fn limits_are_stated_and_kept() {
    let (_, slow) = flights(&["stages.expert.limits.speed_mps=4", "stages.expert.limits.acceleration_mps2=1.5"]);
    for flight in &slow {
        assert_eq!((flight["limit_speed_mps"], flight["limit_acceleration_mps2"]), (4.0, 1.5));
        assert!(flight["max_speed_mps"] <= 4.0 && flight["max_acceleration_mps2"] <= 1.5 + 1e-6);
        assert_eq!(flight["certificate_holds"], 1.0);
    }
}

#[test]
fn ordered_losses_are_stated_and_what_is_missing_is_a_warning() {
    let (printed, lost) = flights(&["stages.expert.occlusion.count=1", "stages.expert.occlusion.max_s=3"]);
    assert!(!lost.is_empty());
    for flight in &lost {
        assert!((flight["occlusion_ordered_s"] - 2.5).abs() < 1.1, "{}", flight["occlusion_ordered_s"]);
        assert!(flight["occlusion_reached_s"] <= flight["occlusion_ordered_s"]);
        let short = flight["occlusion_reached_s"] < 2.0;
        let warned = printed.stdout.contains("was to be lost") || printed.stderr.contains("was to be lost");
        assert!(!short || warned, "{}{}", printed.stdout, printed.stderr);
    }
}

#[test]
fn losses_ordered_for_a_share_leave_the_other_flights_as_they_are() {
    let (_, usual) = flights(&[]);
    let (_, some) = flights(&["stages.expert.occlusion.count=1", "stages.expert.occlusion.share=0.34"]);
    assert_eq!((usual.len(), some.len()), (3, 3), "a flight is missing");
    assert!(some.iter().filter(|flight| flight["occlusion_ordered_s"] > 0.0).count() <= 2);
    let kept = some.iter().filter(|flight| flight["occlusion_ordered_s"] == 0.0);
    assert!(
        kept.clone().count() >= 1
            && kept.clone().all(|flight| usual.iter().any(|it| it["length_m"] == flight["length_m"]))
    );
}

/// The street with companions for its experts.
fn accompanied(companions: u32) -> String {
    let with = format!(
        "inputs = {{ town = \"town\", walks = \"walkers\", others = \"walkers\" }}\ntargets.companions = {companions}"
    );
    RECIPE.replacen("inputs = { town = \"town\", walks = \"walkers\" }", &with, 1)
}

#[test]
fn companions_are_the_other_walkers_and_change_the_flight() {
    let street = Street::with(&accompanied(2), &map());
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    cosfly(&["verify", "out/street"]).within(street.path()).run_ok();
    let alone = Street::new();
    cosfly(&["run", "recipe.toml", "--quiet"]).within(alone.path()).run_ok();
    let lengths = |street: &Street| numbers(street).iter().map(|row| row["length_m"]).collect::<Vec<_>>();
    assert_ne!(lengths(&street), lengths(&alone));
}

/// Exit code and messages of an invalid recipe.
fn check_refusal(name: &str, recipe: &str, changes: &[&str]) {
    let street = Street::with(recipe, &map());
    let mut arguments = vec!["run", "recipe.toml", "--quiet", "--jobs", "1"];
    changes.iter().for_each(|change| arguments.extend_from_slice(&["--set", change]));
    let printed = cosfly(&arguments).within(street.path()).run();
    let code = printed.code.map_or("none".into(), |code| code.to_string());
    insta::assert_snapshot!(name, format!("exit code {code}\n{}", printed.stderr));
}

#[test]
fn what_contradicts_itself_is_refused_with_the_way_out() {
    check_refusal("companions_without_others", RECIPE, &["stages.expert.targets.companions=2"]);
    check_refusal("companions_too_many", &accompanied(3), &[]);
    check_refusal("occlusion_contradiction", RECIPE, &["stages.expert.occlusion.min_s=9"]);
    let other =
        |objective: &str| RECIPE.replacen("walks = \"walkers\" }", &format!("walks = \"walkers\" }}\n{objective}"), 1);
    check_refusal("companions_of_a_baseline", &accompanied(1), &["stages.expert.planner=astar"]);
    check_refusal("inspect_with_paths", &other("objective = \"inspect\""), &[]);
    check_refusal("unknown_objective", &other("objective = \"race\""), &[]);
    let rounds = |waypoints: &str| {
        let objective = format!("}}\nobjective = \"patrol\"\npatrol.waypoints = {waypoints}");
        RECIPE.replacen(", walks = \"walkers\" }", &objective, 1)
    };
    check_refusal("patrol_too_fast", &rounds("[[0, 0, 20, 0], [90, 0, 20, 5]]"), &[]);
    check_refusal("patrol_short_waypoint", &rounds("[[0, 0, 20], [90, 0, 20, 5]]"), &[]);
    check_refusal("patrol_at_one_place", &rounds("[[0, 0, 20, 0], [0, 0, 20, 9]]"), &[]);
    check_refusal("patrol_knobs_of_an_inspection", &other("objective = \"inspect\"\npatrol.radius_m = 40.0"), &[]);
    check_refusal("baseline_within_limits", RECIPE, &["stages.expert.planner=astar"]);
    check_refusal("paper_beside_a_baseline", RECIPE, &["stages.expert.planner=beam", "stages.expert.preset=paper"]);
    check_refusal("losses_of_the_paper", RECIPE, &["stages.expert.preset=paper", "stages.expert.occlusion.count=1"]);
    check_refusal("patrol_in_the_ground", &rounds("[[0, 0, 20, 0], [40, 0, -3, 9]]"), &[]);
}

#[test]
fn the_objectives_recipe_makes_a_verified_dataset_that_covers_and_meets() {
    let folder = tempfile::tempdir().expect("scratch");
    let (store, out) = (folder.path().join("store"), folder.path().join("out"));
    let (store, out) = (store.display().to_string(), out.display().to_string());
    let printed = cosfly(&["run", "recipes/objectives.toml", "--store", &store, "--out", &out]).run_ok().stdout;
    cosfly(&["verify", &out]).run_ok();
    let note = |name: &str| {
        let line = printed.lines().find_map(|line| line.trim().strip_prefix(name)?.strip_prefix(": "));
        line.unwrap_or_else(|| panic!("no `{name}` in {printed}")).to_owned()
    };
    assert!(note("coverage").parse::<f64>().expect("a share") > 0.7, "{printed}");
    assert!(note("waypoints").starts_with("6 of 6 within 2 m"), "{printed}");
}
