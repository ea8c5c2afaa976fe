//! Sensors that are no cameras, through the real binary: tables of readings, and recipes that are refused.

use crate::several_towns::bytes_below;
use crate::street::{RECIPE, Street, map};
use crate::support::{column, cosfly};
use std::collections::{BTreeMap, BTreeSet};

/// The street with two altimeters, an inertial unit, a satellite receiver and a lidar on the drone, whose readings the dataset has.
fn street(second: &str) -> Street {
    let stages = format!(
        "[stages.altitude]\nuse = \"sense\"\nsensor = \"laser_altimeter\"\ninputs = {{ town = \"town\", frames = \"frames\", others = \"walkers\" }}\n\n\
         [stages.nose]\nuse = \"sense\"\nsensor = \"laser_altimeter\"\n{second}\ninputs = {{ town = \"town\", frames = \"frames\" }}\n\n\
         [stages.motion]\nuse = \"sense\"\nsensor = \"inertial_unit\"\nrate_hz = 200\nposition_in_body_m = [0.1, 0.0, 0.05]\n\
         inputs = {{ town = \"town\", frames = \"frames\" }}\n\n\
         [stages.fixes]\nuse = \"sense\"\nsensor = \"satellite_receiver\"\ninputs = {{ town = \"town\", frames = \"frames\" }}\n\n\
         [stages.scan]\nuse = \"scan\"\ntable = \"top\"\n\
         pattern = {{ elevations_deg = [-80, -60, -45, -35, -25, 5], shots_hz = 2000, range_m = [0.5, 80] }}\n\
         inputs = {{ town = \"town\", frames = \"frames\" }}\n\n\
         [stages.dataset]"
    );
    let recipe = RECIPE.replacen("[stages.dataset]", &stages, 1).replacen(
        "captions = \"captions\" }\n",
        "captions = \"captions\", extras = [\"altitude\", \"nose\", \"motion\", \"fixes\", \"scan\"] }\n",
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
    // Sweeps of a tenth of a second: 20 of a flight of 2.2 s or so, most of them with the ground below.
    let points = column(&dataset, "top", "points");
    assert!(
        points.len() >= 6 * 20 && points.iter().filter(|count| *count != "0").count() > points.len() / 2,
        "{points:?}"
    );
    let card = std::fs::read_to_string(dataset.join("README.md")).expect("a card");
    assert!(card.contains("Given by the sensor `laser_altimeter` 3: A gimballed laser beam"), "{card}");
    assert!(card.contains("| `range_m` | float64 | distance to the first thing below"), "{card}");
}

#[test]
fn readings_are_in_logs_and_in_exports() {
    let street = street("table = \"nose_m\"\nrate_hz = 50");
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let dataset = cosfly_read::PublishedDataset::open(&street.dataset()).expect("a dataset");
    let keys = column(&street.dataset(), "laser_altimeter", "trajectory_id");
    let values = column(&street.dataset(), "laser_altimeter", "range_m");
    for flight in dataset.flights() {
        let bytes = std::fs::read(street.dataset().join(&flight.mcap_path)).expect("a log");
        let has = |word: &str| bytes.windows(word.len()).any(|part| part == word.as_bytes());
        assert!(has("/sensor/top") && has("foxglove.PointCloud"));
        let mut log = dataset.log(flight).expect("a log");
        let sensors = log.sensors();
        let names: Vec<(&str, String)> = sensors.iter().map(|it| (it.name.as_str(), it.quantities.join(" "))).collect();
        let quantities = "range_m is_hit true_x_m true_y_m true_z_m".to_owned();
        assert_eq!(names[1..3], [("laser_altimeter", quantities.clone()), ("nose_m", quantities)]);
        assert_eq!((names[0].0, names[3].0), ("inertial_unit", "satellite_receiver"));
        // One in each frame, those of the table.
        let read = log.readings(&sensors[1]).expect("readings");
        let own = keys.iter().zip(&values).filter(|(id, _)| id.trim_matches('"') == flight.trajectory_id);
        let own: Vec<f64> = own.map(|(_, value)| value.parse().expect("a number")).collect();
        assert_eq!(read.iter().map(|(_, numbers)| numbers[0]).collect::<Vec<_>>(), own);
        let often = log.readings(&sensors[2]).expect("readings");
        assert!(often.is_sorted_by_key(|it| it.0) && often.windows(2).all(|pair| pair[1].0 - pair[0].0 == 20_000_000));
    }
    let out = street.dataset();
    let export = |format: &str| {
        let arguments = ["export", out.to_str().expect("UTF-8"), "--format", format, "--out", format];
        cosfly(&arguments).within(street.path()).run_ok();
    };
    let arguments =
        ["export", out.to_str().expect("UTF-8"), "--format", "clouds", "--cloud-files", "las", "--out", "las"];
    cosfly(&arguments).within(street.path()).run_ok();
    export("ros2");
    export("lerobot");
    export("clouds");
    let flight = &dataset.flights()[0];
    let metadata =
        street.path().join("ros2").join(&*flight.split).join("000").join(&flight.trajectory_id).join("metadata.yaml");
    let metadata = std::fs::read_to_string(metadata).expect("a bag");
    let topic = "name: /sensor/laser_altimeter\n        type: std_msgs/msg/Float64MultiArray";
    assert!(metadata.contains(topic) && metadata.contains("name: /sensor/nose_m"), "{metadata}");
    let topic = |name: &str, kind: &str| format!("name: /sensor/{name}\n        type: sensor_msgs/msg/{kind}\n");
    for topic in [topic("inertial_unit", "Imu"), topic("satellite_receiver", "NavSatFix"), topic("top", "PointCloud2")]
    {
        assert!(metadata.contains(&topic), "{topic}{metadata}");
    }
    let clouds = street.path().join("clouds").join(&*flight.split).join("000").join(&flight.trajectory_id).join("top");
    let poses = std::fs::read_to_string(clouds.join("poses.txt")).expect("poses");
    assert!(poses.lines().count() >= 20 && poses.lines().all(|line| line.split(' ').count() == 12), "{poses}");
    let size = |name: &str| std::fs::metadata(clouds.join(name)).expect("a file").len();
    assert_eq!(size("velodyne/000019.bin"), 4 * size("labels/000019.label"));
    // LAS 1.4 counts its points in eight bytes.
    let las = street.path().join("las").join(clouds.strip_prefix(street.path().join("clouds")).expect("below"));
    let las = std::fs::read(las.join("las/000019.las")).expect("a file");
    assert_eq!(
        (&las[..4], las[247..255].to_vec()),
        (&b"LASF"[..], (size("velodyne/000019.bin") / 16).to_le_bytes().to_vec())
    );
    let info = street.path().join("lerobot").join(&*flight.split).join("meta/info.json");
    let info: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(info).expect("a dataset")).expect("JSON");
    let names = ["laser_altimeter.range_m", "laser_altimeter.is_hit", "nose_m.range_m", "nose_m.is_hit"];
    let found: Vec<&str> = info["features"]["observation.sensors"]["names"]
        .as_array()
        .expect("names")
        .iter()
        .filter_map(|name| name.as_str())
        .collect();
    assert_eq!((found.len(), &found[6..10]), (6 + 4 + 12, &names[..]));
    assert!(found.iter().all(|name| !name.contains("true_")), "{found:?}");
}

#[test]
fn flights_of_policies_have_the_readings_that_are_asked_for() {
    let street = Street::new();
    let fly = |out: &str, more: &[&str]| {
        let arguments =
            [&["fly", "recipe.toml", "--policy", "hold", "--clips", "0", "--quiet", "--out", out], more].concat();
        cosfly(&arguments).within(street.path()).run_ok();
        let folder = street.path().join(out).join("hold");
        let read = |name: String| std::fs::read(folder.join(name)).expect("a file of the result");
        let card: serde_json::Value = serde_json::from_slice(&read("card.json".into())).expect("JSON");
        let row = String::from_utf8(read("episodes.jsonl".into())).expect("UTF-8");
        let row: serde_json::Value = serde_json::from_str(row.lines().next().expect("an episode")).expect("JSON");
        let episode = row["episode"].as_str().expect("a name");
        let log = read(format!("logs/{episode}.mcap"));
        let has_topic = log.windows(23).any(|bytes| bytes == b"/sensor/laser_altimeter");
        let steps = String::from_utf8(read(format!("logs/{episode}.jsonl"))).expect("UTF-8");
        (card["policy"]["sensors"].clone(), has_topic, steps)
    };
    let (sensors, has_topic, steps) = fly("plain", &[]);
    assert!(sensors.is_null() && !has_topic && !steps.contains("readings"));
    let (sensors, has_topic, steps) = fly("sensed", &["--obs", "laser_altimeter"]);
    assert_eq!((sensors, has_topic), (serde_json::json!(["laser_altimeter"]), true));
    for line in steps.lines() {
        let step: serde_json::Value = serde_json::from_str(line).expect("JSON");
        let (range_m, height_m) = (&step["readings"]["laser_altimeter"][0], &step["position_in_world"][2]);
        let (range_m, height_m) = (range_m.as_f64().expect("a number"), height_m.as_f64().expect("a number"));
        assert!(range_m > 0.0 && range_m <= height_m + 0.3, "{line}");
    }
}

#[test]
fn sensors_that_are_not_there_and_names_that_are_taken_are_refused_with_the_way_out() {
    let refused = |second: &str, words: &[&str]| {
        let printed = cosfly(&["plan", "recipe.toml"]).within(street(second).path()).run();
        assert_eq!(printed.code, Some(3), "{}", printed.stderr);
        let said = printed.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        words.iter().for_each(|word| assert!(said.contains(word), "{word}: {}", printed.stderr));
    };
    refused("table = \"frames\"", &["reserved for the dataset's own tables"]);
    refused("rate_hz = 0.0", &["rate_hz"]);
    refused("table = \"Nose\"", &["table"]);
    refused("", &["gets `laser_altimeter` from `altitude` and from `nose`", "`table`"]);
    let pattern = "pattern = { elevations_deg = [0], shots_hz = 1000, range_m = [0, 50] }";
    for (kind, keys, word) in [
        ("scan", "lidar = \"vlp61\"", "`vlp16`"),
        ("scan", "lidar = \"vlp16\"\nrate_hz = 7", "18080 shots"),
        ("scan", pattern, "two distances"),
        ("sense", "sensor = \"laser_altimetre\"", "laser_altimeter"),
        ("sense", "sensor = \"inertial_unit\"\nlevelled = true", "fixed to the airframe"),
    ] {
        let stage =
            format!("\n[stages.more]\nuse = \"{kind}\"\n{keys}\ninputs = {{ town = \"town\", frames = \"frames\" }}\n");
        let street = Street::with(&(RECIPE.to_owned() + &stage), &map());
        let printed = cosfly(&["run", "recipe.toml"]).within(street.path()).run();
        assert!(printed.code == Some(3) && printed.stderr.contains(word), "{}", printed.stderr);
    }
}

/// The street filmed by two cameras, of which another stage films `around`; a unit reads `frames` along the films of `camera`.
fn rig(camera: &str, frames: &str) -> Street {
    let stages = format!(
        "[stages.frames.cameras.front]\nbase_line_m = 0.2\n[stages.frames.cameras.slow]\nevery = 3\n\n\
         [stages.around]\nuse = \"render\"\ninputs = {{ town = \"town\", trajectories = [\"expert\", \"perturbed\"] }}\n\
         [stages.around.cameras.wide]\nwidth = 96\nheight = 48\nlens = {{ model = \"equirectangular\" }}\n\n\
         [stages.motion]\nuse = \"sense\"\nsensor = \"inertial_unit\"\nrate_hz = 200\ncamera = \"{camera}\"\n\
         inputs = {{ town = \"town\", frames = {frames} }}\n\n\
         [stages.scan]\nuse = \"scan\"\ncamera = \"{camera}\"\n\
         pattern = {{ elevations_deg = [-60, -45], shots_hz = 1000, range_m = [0.5, 80] }}\n\
         inputs = {{ town = \"town\", frames = {frames} }}\n\n[stages.captions]"
    );
    let recipe = RECIPE.replacen("[stages.captions]", &stages, 1).replacen(
        "frames = \"frames\", captions = \"captions\" }\n",
        "frames = [\"frames\", \"around\"], captions = \"captions\", extras = [\"motion\", \"scan\"] }\n",
        1,
    );
    Street::with(&recipe, &map())
}

#[test]
fn a_plan_tells_what_a_lidar_along_one_camera_of_a_rig_writes() {
    let street = rig("front_left", "[\"frames\", \"around\"]");
    let shots = ["--set", "stages.scan.pattern.shots_hz=20000"];
    let planned = cosfly(&[&["plan", "recipe.toml", "--json"][..], &shots].concat()).within(street.path()).run_ok();
    let planned: serde_json::Value = serde_json::from_str(&planned.stdout).expect("JSON");
    cosfly(&[&["run", "recipe.toml", "--quiet"][..], &shots].concat()).within(street.path()).run_ok();
    // Alone, the tables too: what was left out of them hid what was predicted too much for other films.
    let stages = planned["stages"].as_array().expect("stages");
    let tables = stages.iter().find(|stage| stage["stage"] == "dataset.tables").expect("the tables");
    for (predicted, folder) in
        [(&planned["predicted_bytes"], ".cosfly"), (&tables["predicted_bytes"], "out/street/data")]
    {
        let written = bytes_below(&street.path().join(folder), &mut BTreeSet::new()) as f64;
        let ratio = predicted.as_f64().expect("a number") / written;
        assert!((0.67..1.5).contains(&ratio), "{folder}: {ratio:.2} of {written}");
    }
}

#[test]
fn a_sensor_reads_along_the_films_of_one_camera_of_a_rig() {
    let street = rig("front_left", "[\"frames\", \"around\"]");
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let dataset = street.dataset();
    cosfly(&["verify", dataset.to_str().expect("UTF-8")]).within(street.path()).run_ok();
    assert_eq!(column(&dataset, "trajectories", "trajectory_id").len(), 24);
    for table in ["inertial_unit", "lidar"] {
        let ids = column(&dataset, table, "trajectory_id");
        let films: BTreeSet<&String> = ids.iter().collect();
        assert!(films.len() == 6 && films.iter().all(|id| id.trim_matches('"').ends_with("-front_left")), "{films:?}");
    }
    // The other films' logs have no topic of a sensor, and exports take films by camera.
    let published = cosfly_read::PublishedDataset::open(&dataset).expect("a dataset");
    for flight in published.flights() {
        let sensors = published.log(flight).expect("a log").sensors().len();
        assert_eq!(sensors > 0, flight.trajectory_id.ends_with("-front_left"), "{}", flight.trajectory_id);
    }
    let export = |ids: &str, out: &str| {
        let all =
            ["export", dataset.to_str().expect("UTF-8"), "--format", "lerobot", "--trajectory", ids, "--out", out];
        cosfly(&all).within(street.path()).run()
    };
    assert_eq!(export("*-front_left", "left").code, Some(0));
    // Films with the same moments are one episode for LeRobot, with a feature for each camera.
    assert_eq!(export("*-front_*", "pair").code, Some(0));
    let mut episodes = 0;
    for split in ["train", "val", "test"] {
        let Ok(text) = std::fs::read_to_string(street.path().join(format!("pair/{split}/meta/info.json"))) else {
            continue;
        };
        let info: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        episodes += info["total_episodes"].as_u64().expect("a count");
        for name in ["observation.images.front_left", "observation.images.front_right", "observation.sensors"] {
            assert!(info["features"][name].is_object(), "{name}: {text}");
        }
        assert!(info["features"]["observation.images.rgb"].is_null());
    }
    assert_eq!(episodes, 6);
    // A bag has all films of a flight, each camera at its own times.
    let all = ["export", dataset.to_str().expect("UTF-8"), "--format", "ros2", "--out", "bags"];
    cosfly(&all).within(street.path()).run_ok();
    let bags = crate::support::tree_digests(&street.path().join("bags"));
    let bags: Vec<&String> = bags.iter().map(|it| &it.0).filter(|path| path.ends_with("metadata.yaml")).collect();
    assert!(bags.len() == 6 && bags.iter().any(|path| path.contains("/expert-p00000/")), "{bags:?}");
    for bag in bags {
        let text = std::fs::read_to_string(street.path().join("bags").join(bag)).expect("a description");
        let count = |topic: &str| -> usize {
            let after = text.split(&format!("name: {topic}\n")).nth(1).expect("a topic");
            after.split("message_count: ").nth(1).and_then(|it| it.lines().next()?.parse().ok()).expect("a count")
        };
        let pictures = |name: &str| count(&format!("/camera/{name}/image_raw/compressed"));
        assert_eq!((count("/odom"), pictures("front_left"), pictures("front_right")), (12, 12, 12));
        assert_eq!((pictures("slow"), pictures("wide"), count("/camera/wide/detections")), (4, 12, 12));
        assert!(count("/sensor/inertial_unit") > 400 && count("/sensor/lidar") > 4);
    }
    let refused = export("*", "all");
    assert!(refused.code == Some(3) && refused.stderr.contains("the times of its frames"), "{}", refused.stderr);
    let refused = export("*-left_front", "none");
    assert!(
        refused.code == Some(3) && refused.stderr.contains("no trajectory is like `*-left_front`"),
        "{}",
        refused.stderr
    );
}

#[test]
fn sensors_of_some_films_only_are_refused_before_anything_is_made() {
    let street = rig("front_left", "\"frames\"");
    let printed = cosfly(&["plan", "recipe.toml"]).within(street.path()).run();
    let words = [
        "`inputs.extras` of `dataset.logs` has 2 items for",
        "and 0 for `expert-p00000-wide`",
        "inputs.frames = [...]",
    ];
    let said = printed.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(printed.code == Some(3) && words.iter().all(|word| said.contains(word)), "{}", printed.stderr);
    // No camera is called so.
    let street = rig("frnt", "[\"frames\", \"around\"]");
    let refused = |set: &str, words: &[&str]| {
        let set: &[&str] = if set.is_empty() { &[] } else { &["--set", set] };
        let printed = cosfly(&[&["plan", "recipe.toml"], set].concat()).within(street.path()).run();
        let said = printed.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(printed.code == Some(3) && words.iter().all(|word| said.contains(word)), "{words:?}: {said}");
    };
    let words = [
        "no item at `inputs.frames` is called `frnt`",
        "names there: `front_left`, `front_right`, `slow`, `wide`",
        "recipe.toml:45",
        "camera = \"frnt\"",
    ];
    refused("", &words);
    // A film begins before its second picture.
    refused("stages.frames.cameras.front.offset_s=0.5", &["`0.5` is not less than `0.5`, the `dt_s` of `walkers`"]);
    refused(
        "stages.frames.cameras.slow.offset_s=1.5",
        &["`1.5` is not less than `1.5`, 3 times the `dt_s` of `walkers`"],
    );
}
