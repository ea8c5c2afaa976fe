//! Every shipped recipe and every available real town gives a whole, verified dataset.

use crate::shared::shared_input;
use crate::support::cosfly;
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
fn a_map_of_boxes_makes_a_verified_dataset() {
    check_town(&crate::support::repository_root().join("tests/towns/yard.json"), &["stages.town.terrain_margin_m=30"]);
}

#[test]
fn carla_towns_make_verified_datasets() {
    let Some(towns) = shared_input("carla_xodr") else { return };
    let filled = ["stages.town.fill.buildings=true", "stages.town.fill.trees=true"];
    for town in ["Town01", "Town03_2019-04", "Town04", "Town07"] {
        check_town(&towns.join(format!("{town}.xodr")), &filled);
    }
    let shoulders = [filled[0], filled[1], "stages.town.shoulders_as_sidewalks=true"];
    check_town(&towns.join("Town06.xodr"), &shoulders);
}

#[test]
fn a_city_survey_makes_a_verified_dataset() {
    let Some(city) = shared_input("xodr_city/Ingolstadt_CityHall.xodr") else { return };
    check_town(&city, &[]);
}

#[test]
fn a_town_without_sidewalks_is_refused_with_the_option_that_helps() {
    let Some(town) = shared_input("carla_xodr/Town06.xodr") else { return };
    let source = format!("stages.town.source={}", town.display());
    let folder = tempfile::tempdir().expect("scratch");
    let store = folder.path().join("store").display().to_string();
    let printed = cosfly(&["run", "recipes/small.toml", "--quiet", "--store", &store, "--set", &source]).run();
    assert_eq!(printed.code, Some(4), "{}", printed.stderr);
    assert!(printed.stderr.contains("shoulders_as_sidewalks"), "{}", printed.stderr);
}
