//! Every shipped recipe and every available real town gives a whole, verified dataset.

use crate::support::{cosfly, shared_data};
use std::path::Path;

/// Runs the small recipe on `map` with `changes` and verifies the dataset.
fn check_town(map: &Path, changes: &[&str]) {
    let folder = tempfile::tempdir().expect("scratch");
    let (store, out) = (folder.path().join("store"), folder.path().join("out"));
    let source = format!("stages.town.source={}", map.display());
    let (store, out) = (store.display().to_string(), out.display().to_string());
    let mut arguments =
        vec!["run", "recipes/small.toml", "--quiet", "--store", &store, "--out", &out, "--set", &source];
    for change in changes {
        arguments.extend_from_slice(&["--set", change]);
    }
    let printed = cosfly(&arguments).run();
    assert_eq!(printed.code, Some(0), "{}: {}", map.display(), printed.stderr);
    cosfly(&["verify", &out]).run_ok();
}

#[test]
fn the_small_recipe_makes_a_verified_dataset() {
    check_town(&crate::support::repository_root().join("recipes/towns/downtown.xodr"), &[]);
}

#[test]
fn carla_towns_make_verified_datasets() {
    let Some(data) = shared_data() else { return };
    let filled = ["stages.town.fill.buildings=true", "stages.town.fill.trees=true"];
    for town in ["Town01", "Town03_2019-04", "Town04", "Town07"] {
        check_town(&data.join(format!("carla_xodr/{town}.xodr")), &filled);
    }
    let shoulders = [filled[0], filled[1], "stages.town.shoulders_as_sidewalks=true"];
    check_town(&data.join("carla_xodr/Town06.xodr"), &shoulders);
}

#[test]
fn a_city_survey_makes_a_verified_dataset() {
    let Some(data) = shared_data() else { return };
    check_town(&data.join("xodr_city/Ingolstadt_CityHall.xodr"), &[]);
}

#[test]
fn a_town_without_sidewalks_is_refused_with_the_option_that_helps() {
    let Some(data) = shared_data() else { return };
    let source = format!("stages.town.source={}", data.join("carla_xodr/Town06.xodr").display());
    let folder = tempfile::tempdir().expect("scratch");
    let store = folder.path().join("store").display().to_string();
    let printed = cosfly(&["run", "recipes/small.toml", "--quiet", "--store", &store, "--set", &source]).run();
    assert_eq!(printed.code, Some(4), "{}", printed.stderr);
    assert!(printed.stderr.contains("shoulders_as_sidewalks"), "{}", printed.stderr);
}
