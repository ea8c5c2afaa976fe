//! Sensors that are no cameras, through the real binary: tables of readings, and recipes that are refused.

use crate::street::{RECIPE, Street, map};
use crate::support::{column, cosfly};
use std::collections::BTreeMap;

/// The street with two altimeters on the drone, whose readings the dataset has.
fn street(second: &str) -> Street {
    let stages = format!(
        "[stages.altitude]\nuse = \"sense\"\nsensor = \"laser_altimeter\"\ninputs = {{ town = \"town\", frames = \"frames\" }}\n\n\
         [stages.nose]\nuse = \"sense\"\nsensor = \"laser_altimeter\"\n{second}\ninputs = {{ town = \"town\", frames = \"frames\" }}\n\n\
         [stages.dataset]"
    );
    let recipe = RECIPE.replacen("[stages.dataset]", &stages, 1).replacen(
        "captions = \"captions\" }\n",
        "captions = \"captions\", extras = [\"altitude\", \"nose\"] }\n",
        1,
    );
    Street::with(&recipe, &map())
}

#[test]
fn readings_are_tables_of_a_verified_dataset() {
    let street = street("table = \"nose_m\"\nrate_hz = 50\nposition_in_body_m = [0.5, 0.0, 0.0]");
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let dataset = street.dataset();
    cosfly(&["verify", dataset.to_str().expect("UTF-8")]).within(street.path()).run_ok();
    // One reading in each frame: the drone's height above roofs and ground, which is near height 0 here.
    // Files of a table come in any order: rows are met by flight and frame.
    let numbers = |table: &str, name: &str| -> BTreeMap<(String, String), f64> {
        let keys = column(&dataset, table, "trajectory_id").into_iter().zip(column(&dataset, table, "frame"));
        let values = column(&dataset, table, name);
        keys.zip(values.iter().map(|value| value.parse().expect("a number"))).collect()
    };
    let (ranges, heights) = (numbers("laser_altimeter", "range_m"), numbers("frames", "drone_z_m"));
    assert_eq!((ranges.len(), heights.len()), (72, 72));
    for (at, height) in &heights {
        let range = ranges.get(at).expect("a reading in each frame");
        assert!(*range > 0.0 && *range <= height + 0.3, "{at:?}: {range} m of {height} m");
    }
    // 50 a second: 11 frames of 0.2 s, both ends.
    let rows = column(&dataset, "nose_m", "time_s");
    assert_eq!(rows.len() % 6, 0);
    assert!(rows.len() > 6 * 100, "{}", rows.len());
    let card = std::fs::read_to_string(dataset.join("README.md")).expect("a card");
    assert!(card.contains("Given by the sensor `laser_altimeter` 1: A gimballed laser beam"), "{card}");
    assert!(card.contains("| `range_m` | float64 | distance to the first thing below"), "{card}");
}

#[test]
fn sensors_that_are_not_there_and_names_that_are_taken_are_refused_with_the_way_out() {
    let refused = |second: &str, words: &[&str]| {
        let printed = cosfly(&["run", "recipe.toml"]).within(street(second).path()).run();
        assert_eq!(printed.code, Some(3), "{}", printed.stderr);
        let said = printed.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        words.iter().for_each(|word| assert!(said.contains(word), "{word}: {}", printed.stderr));
    };
    refused("table = \"frames\"", &["reserved for the dataset's own tables"]);
    refused("rate_hz = 0.0", &["rate_hz"]);
    refused("table = \"Nose\"", &["table"]);
    refused("", &["two stages give `laser_altimeter`", "`table`"]);
    let unknown = RECIPE.to_owned()
        + "\n[stages.lidar]\nuse = \"sense\"\nsensor = \"laser_altimetre\"\ninputs = { town = \"town\", frames = \"frames\" }\n";
    let street = Street::with(&unknown, &map());
    let printed = cosfly(&["run", "recipe.toml"]).within(street.path()).run();
    assert!(printed.code == Some(3) && printed.stderr.contains("laser_altimeter"), "{}", printed.stderr);
}
