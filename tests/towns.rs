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
    check_town(
        &crate::support::repository_root().join("tests/towns/yard.json"),
        &["stages.town.options.terrain_margin_m=30"],
    );
}

#[test]
fn carla_towns_make_verified_datasets() {
    let Some(towns) = shared_input("carla_xodr") else { return };
    let filled = ["stages.town.fill.buildings=true", "stages.town.fill.trees=true"];
    for town in ["Town01", "Town03_2019-04", "Town04", "Town06", "Town07"] {
        check_town(&towns.join(format!("{town}.xodr")), &filled);
    }
}

#[test]
fn a_city_survey_makes_a_verified_dataset() {
    let Some(city) = shared_input("xodr_city/Ingolstadt_CityHall.xodr") else { return };
    check_town(&city, &[]);
}

#[test]
fn towns_without_sidewalks_make_verified_datasets_without_an_option() {
    for town in [
        "carla_xodr/Town06",
        "xodr_city/esmini_Junction_with_building0",
        "xodr_city/esmini_Weird_looking_building_road_coord",
        "xodr_city/esmini_stationary_objects",
    ] {
        let Some(town) = shared_input(&format!("{town}.xodr")) else { return };
        check_town(&town, &[]);
    }
}
