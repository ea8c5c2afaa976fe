//! Sensors that are no cameras, through the real binary: tables of readings, and recipes that are refused.

use crate::street::{RECIPE, Street, map};
use crate::support::{column, cosfly};

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
    // One reading in each frame: the drone's height above roofs and ground.
    let flights = column(&dataset, "frames", "trajectory_id");
    let ranges = column(&dataset, "laser_altimeter", "range_m");
    assert_eq!((ranges.len(), flights.len()), (72, 72));
    assert_eq!(column(&dataset, "laser_altimeter", "frame"), column(&dataset, "frames", "frame"));
    let heights = column(&dataset, "frames", "drone_z_m");
    for (range, height) in ranges.iter().zip(&heights) {
        let (range, height): (f64, f64) = (range.parse().expect("a number"), height.parse().expect("a number"));
        assert!(range > 0.0 && range <= height + 1e-6, "{range} m of {height} m");
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
