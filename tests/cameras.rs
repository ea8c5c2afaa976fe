//! Cameras and weathers through the real binary: paired renderings, drawn optics, and rejected recipes.

use crate::street::{RECIPE, Street, map};
use crate::support::{column, cosfly};

/// The street with `lines` added to its render stage.
fn street(lines: &str) -> Street {
    let changed = RECIPE.replacen("width = 96\n", &format!("width = 96\n{lines}\n"), 1);
    assert_ne!(changed, RECIPE);
    Street::with(&changed, &map())
}

/// The street with tables of `cameras` in its render stage.
fn filmed_by(cameras: &str) -> Street {
    let changed = RECIPE.replacen("height = 54\n", &format!("height = 54\n{cameras}\n"), 1);
    assert_ne!(changed, RECIPE);
    Street::with(&changed, &map())
}

/// Numbers of runs per stage.
fn ran(street: &Street, arguments: &[&str], stage: &str) -> u64 {
    let all = [&["run", "recipe.toml", "--json"][..], arguments].concat();
    let printed = cosfly(&all).within(street.path()).run_ok();
    let summary: serde_json::Value = serde_json::from_str(&printed.stdout).expect("a JSON summary");
    let stages = summary["stages"].as_array().expect("stages");
    let found = stages.iter().find(|it| it["stage"] == stage).expect("the stage");
    found["ran"].as_u64().expect("a count")
}

#[test]
fn several_cameras_film_every_flight_at_the_same_moments() {
    let street = filmed_by(
        "bodies_3d = true\n\
         channels = [\"rgb\", \"depth\", \"semantic\", \"instance\", \"depth_stereo\", \"disparity\"]\n\
         [stages.frames.cameras.front]\nbase_line_m = 0.3\n\
         gimbal = { position_in_body_m = [0.2, -0.15, 0.05], roll_deg = 4.0, levelled = false }\n\
         [stages.frames.cameras.down]\nwidth = 64\nheight = 64\nfov_deg = 70.0\nevery = 2\nlens = { model = \"fisheye\", k1 = -0.02 }\n\
         gimbal = { pitch_range_deg = [-90, -90], yaw_range_deg = [0, 0] }",
    );
    assert_eq!(ran(&street, &[], "frames"), 18);
    let dataset = street.dataset();
    cosfly(&["verify", dataset.to_str().expect("UTF-8")]).within(street.path()).run_ok();
    cosfly(&["doctor", dataset.to_str().expect("UTF-8")]).within(street.path()).run();
    // A row for each flight and camera.
    let of = |name: &str| column(&dataset, "trajectories", name);
    let (ids, flights, cameras) = (of("trajectory_id"), of("flight_id"), of("camera_name"));
    let (widths, pitches, experts) = (of("camera_width_px"), of("camera_mount_pitch_deg"), of("expert_id"));
    assert_eq!(ids.len(), 18);
    for at in 0..ids.len() {
        let camera = cameras[at].trim_matches('"');
        assert_eq!(ids[at].trim_matches('"'), format!("{}-{camera}", flights[at].trim_matches('"')));
        let expected = if camera == "down" { ("64", -90.0) } else { ("96", 0.0) };
        assert_eq!((widths[at].as_str(), pitches[at].parse::<f64>().expect("a number")), expected, "{camera}");
        // Twins are paired within their camera.
        let expert = experts[at].trim_matches('"');
        assert!(["", "null"].contains(&expert) || expert.ends_with(camera), "{expert} of {camera}");
    }
    // The pair stands a base line apart, in a place of its own.
    let of_film = |name: &str, film: &str| {
        let values = of(name).into_iter().zip(&cameras);
        values.filter(|(_, camera)| camera.contains(film)).map(|(value, _)| value).collect::<Vec<_>>()
    };
    assert_eq!(of_film("camera_mount_right_m", "front_left"), vec!["0E0"; 6]);
    assert_eq!(of_film("camera_mount_right_m", "front_right"), vec!["0.3"; 6]);
    // One camera films every second frame, at the same moments.
    assert_eq!(of_film("dt_s", "down"), vec!["1.0"; 6]);
    assert_eq!(of_film("dt_s", "front_left"), vec!["0.5"; 6]);
    let poses = |film: &str| {
        let all = column(&dataset, "frames", "trajectory_id").into_iter().zip(column(&dataset, "frames", "drone_x_m"));
        let own = all.filter(|(id, _)| id.contains(&format!("expert-p00000-{film}")));
        own.map(|(_, x_m)| x_m).collect::<Vec<_>>()
    };
    let every_second: Vec<String> = poses("front_left").into_iter().step_by(2).collect();
    assert!(every_second.len() > 2 && poses("down") == every_second);
    assert_eq!(of_film("camera_lens_model", "down"), vec!["\"fisheye\""; 6]);
    // Key points of somebody are seen, and COCO's file has them.
    let shown = column(&dataset, "bodies_3d", "key_points_shown");
    assert!(!shown.is_empty() && shown.iter().any(|points| points.contains('2')), "{shown:?}");
    let folder = dataset.to_str().expect("UTF-8");
    cosfly(&["export", folder, "--format", "coco", "--out", "coco"]).within(street.path()).run_ok();
    cosfly(&["export", folder, "--format", "ros2", "--out", "bags"]).within(street.path()).run_ok();
    let files = std::fs::read_dir(street.path().join("coco/annotations")).expect("annotations");
    let text: String = files.map(|file| std::fs::read_to_string(file.expect("a file").path()).expect("text")).collect();
    assert!(text.contains("\"left_ankle\"") && text.contains("\"num_keypoints\":"));
    // All cameras of a flight have its texts.
    let captioned = column(&dataset, "captions", "trajectory_id");
    assert!(ids.iter().all(|id| captioned.contains(id)));
}

#[test]
fn a_camera_with_an_offset_films_between_the_steps() {
    let street = filmed_by(
        "channels = [\"rgb\", \"depth\", \"semantic\", \"instance\", \"flow_forward\", \"flow_forward_valid\"]\nbodies_3d = true\n\
         [stages.frames.cameras.front]\n[stages.frames.cameras.late]\noffset_s = 0.2\n\
         gimbal = { position_in_body_m = [0.5, 0.3, 0.2], roll_deg = 9.0, levelled = false }\n\
         [stages.frames.cameras.slow]\nevery = 2\noffset_s = 0.7",
    );
    assert_eq!(ran(&street, &[], "frames"), 18);
    let dataset = street.dataset();
    let folder = dataset.to_str().expect("UTF-8");
    cosfly(&["verify", folder]).within(street.path()).run_ok();
    let examined = cosfly(&["doctor", folder]).within(street.path()).run();
    assert!(!examined.stdout.contains("caption-mismatch"), "{}", examined.stdout);
    let [ids, times, places] = ["trajectory_id", "time_s", "drone_x_m"].map(|name| column(&dataset, "frames", name));
    let film = |camera: &str| -> Vec<(f64, f64)> {
        let number = |text: &String| text.parse().expect("a number");
        let rows = ids.iter().zip(times.iter().zip(&places));
        rows.filter(|it| it.0.contains(&format!("expert-p00000-{camera}")))
            .map(|it| (number(it.1.0), number(it.1.1)))
            .collect()
    };
    let front = film("front");
    for (camera, first_s, step_s, count) in [("late", 0.2, 0.5, 11), ("slow", 0.7, 1.0, 5)] {
        let own = film(camera);
        assert_eq!(own.len(), count, "{camera}: {own:?}");
        for (number, (time_s, x_m)) in own.iter().enumerate() {
            let (at, due_s) = (time_s / 0.5, first_s + number as f64 * step_s);
            let [from, to] = [0, 1].map(|next| front[at as usize + next].1);
            assert!((time_s - due_s).abs() < 1e-9 && (from + (to - from) * at.fract() - x_m).abs() < 1e-9, "{camera}");
        }
    }
    cosfly(&["export", folder, "--format", "ros2", "--out", "bags"]).within(street.path()).run_ok();
    let late = filmed_by("[stages.frames.cameras.late]\noffset_s = 0.5");
    let printed = cosfly(&["run", "recipe.toml"]).within(late.path()).run();
    assert!(printed.code == Some(3) && printed.stderr.contains("recipe-parameter"), "{}", printed.stderr);
}

#[test]
fn texts_of_flights_that_no_camera_films_frame_by_frame_are_judged_by_what_is_known() {
    let street =
        filmed_by("[stages.frames.cameras.front]\nevery = 2\n[stages.frames.cameras.slow]\nevery = 3\noffset_s = 0.2");
    assert_eq!(ran(&street, &[], "frames"), 12);
    let dataset = street.dataset();
    assert_eq!(column(&dataset, "trajectories", "camera_every").concat().replace(['2', '3'], ""), "");
    let doctor = |more: &[&str]| {
        cosfly(&[&["doctor", dataset.to_str().expect("UTF-8")], more].concat()).within(street.path()).run().stdout
    };
    let own = doctor(&[]);
    assert!(!own.contains("caption-mismatch") && own.contains("100.0 % true"), "{own}");
    let line = r#"{"trajectory_id": "expert-p00000-front", "language": "en", "text": "TEXT"}"#;
    let text = "Follow the pedestrian from about 90 metres, with the camera 5 degrees down, for 90 seconds.";
    std::fs::write(street.path().join("texts.jsonl"), line.replace("TEXT", text)).expect("written");
    let given = doctor(&["--texts", "texts.jsonl"]);
    assert!(given.contains("caption-mismatch"), "{given}");
}

#[test]
fn cards_and_checks_know_what_a_wide_lens_sees() {
    let street = filmed_by(
        "[stages.frames.cameras.around]\nwidth = 128\nheight = 64\nlens = { model = \"equirectangular\" }\n\
         [stages.frames.cameras.dome]\nwidth = 96\nheight = 96\nfov_deg = 115.0\nlens = { model = \"fisheye\" }\n\
         gimbal = { pitch_range_deg = [-90, -90], yaw_range_deg = [0, 0] }",
    );
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let dataset = street.dataset();
    let folder = dataset.to_str().expect("UTF-8");
    let card = |folder: &std::path::Path| std::fs::read_to_string(folder.join("README.md")).expect("a card");
    assert!(card(&dataset).contains("along the ray of the pixel") && !card(&dataset).contains("pinhole without"));
    cosfly(&["export", folder, "--format", "v7", "--out", "v7"]).within(street.path()).run_ok();
    let exported = card(&street.path().join("v7"));
    assert!(exported.contains("360.0° wide") && exported.contains("179.9° wide"), "{exported}");
    for data in [folder, "v7"] {
        let found = cosfly(&["doctor", data]).within(street.path()).run().stdout;
        let is_off = ["depth-mismatch", "pose-mismatch"].iter().any(|name| found.contains(name));
        assert!(!is_off && found.contains("episodes with"), "{found}");
    }
}

#[test]
fn cameras_that_cannot_be_are_refused_with_their_key() {
    for (lines, words) in [
        ("[stages.frames.cameras.Down]\nwidth = 64", "lower-case letter"),
        ("[stages.frames.cameras.down]\nbase_line_m = 0.0", "`cameras.down.base_line_m` is `0"),
        ("[stages.frames.cameras.a]\nbase_line_m = 0.1\n[stages.frames.cameras.a_left]", "makes a film of this name"),
        ("[stages.frames.cameras.down]\noffset_s = -0.1", "`cameras.down.offset_s`"),
        ("[stages.frames.cameras.down]\nevery = 0", "`cameras.down.every` is `0`"),
        ("channels = [\"rgb\", \"depth\", \"semantic\", \"instance\", \"disparity\"]", "no camera is one"),
        ("channels = [\"rgb\", \"depth\", \"semantic\", \"instance\", \"depth_stereo\"]", "`depth_stereo` is of a"),
        ("gimbal = { position_in_body_m = [0.0, 0.0, 40.0] }", "position_in_body_m"),
        ("lens = { model = \"fisheye\" }\nfov_deg = 140.0", "no picture in the corners"),
        ("[stages.frames.cameras.down]\nwidth = 8", "`cameras.down.width` is `8`"),
        ("[stages.frames.cameras.down]\nlens = { k1 = -0.9 }", "take a `fov_deg` of 38 or less"),
        ("paired_weathers = true\n[stages.frames.cameras.down]", "both name the films of a flight"),
    ] {
        let printed = cosfly(&["run", "recipe.toml"]).within(filmed_by(lines).path()).run();
        let said = printed.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(printed.code == Some(3) && said.contains(words), "{lines}: {}", printed.stderr);
    }
}

#[test]
fn paired_weathers_show_every_flight_in_each_and_another_one_renders_no_old_one_anew() {
    let street = street("paired_weathers = true\nweathers = [\"ClearNoon\", \"HardRainNoon\"]");
    assert_eq!(ran(&street, &[], "frames"), 12);
    let dataset = street.dataset();
    let printed = cosfly(&["verify", dataset.to_str().expect("UTF-8")]).within(street.path()).run_ok();
    assert!(printed.stdout.contains("12"), "{}", printed.stdout);
    for name in ["expert-p00000-ClearNoon", "perturbed-p00002-HardRainNoon"] {
        let town = std::fs::read_dir(dataset.join("mcap")).expect("logs").next().expect("a town").expect("readable");
        assert!(town.path().join(format!("000/{name}.mcap")).is_file(), "{name}");
    }
    let three = ["--set", "stages.frames.weathers=[\"ClearNoon\", \"HardRainNoon\", \"ClearNight\"]"];
    assert_eq!(ran(&street, &three, "frames"), 6, "only the new weather");
    let why = cosfly(&["why", "recipe.toml", "frames/expert-p00001-HardRainNoon"]).within(street.path()).run_ok();
    assert!(why.stdout.contains("cached") || why.stdout.contains("nothing changed"), "{}", why.stdout);
}

#[test]
fn a_season_is_drawn_and_stated_in_the_table() {
    let street = street("season = \"winter\"");
    assert_eq!(ran(&street, &[], "frames"), 6);
    let dataset = street.dataset();
    cosfly(&["verify", dataset.to_str().expect("UTF-8")]).within(street.path()).run_ok();
    assert_eq!(column(&dataset, "trajectories", "season"), vec!["\"winter\""; 6]);
    let summer = ["--set", "stages.frames.season=\"summer\""];
    assert_eq!(ran(&street, &summer, "frames"), 6);
    assert_eq!(column(&dataset, "trajectories", "season"), vec!["\"summer\""; 6]);
}

#[test]
fn drawn_cameras_with_lens_blur_and_noise_pass_every_check_of_the_dataset() {
    let street = street(
        "fov_range_deg = [60.0, 100.0]\n\
         gimbal = { pitch_range_deg = [-6.0, 6.0], yaw_range_deg = [-12.0, 12.0] }\n\
         lens = { k1 = -0.12, k2 = 0.01 }\n\
         motion_blur = { shutter_s = 0.04, samples = 3 }\n\
         rolling_shutter = { readout_s = 0.03, strips = 4 }\n\
         noise = { gaussian = 2.0, shot = 3.0 }\n\
         weather = { sun_altitude_angle = [-10.0, 60.0], cloudiness = [0.0, 80.0] }",
    );
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let dataset = street.dataset();
    cosfly(&["verify", dataset.to_str().expect("UTF-8")]).within(street.path()).run_ok();
}

#[test]
fn boxes_of_a_camera_on_a_tilting_drone_are_those_of_its_rolling_shutter() {
    let street = street(
        "fov_deg = 70.0\n\
         gimbal = { pitch_range_deg = [-60.0, -50.0], levelled = false, position_in_body_m = [0.1, 0.0, -0.2] }\n\
         rolling_shutter = { readout_s = 0.06, strips = 6 }",
    );
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let dataset = street.dataset();
    cosfly(&["verify", dataset.to_str().expect("UTF-8")]).within(street.path()).run_ok();
}

#[test]
fn channels_on_request_are_logged_checked_shown_and_exported_where_a_recipe_asks_for_them() {
    let flows = "\"flow_back\", \"flow_back_valid\", \"flow_forward\", \"flow_forward_valid\", \"depth_sensor\", \"mask_amodal\"";
    let list = format!("[\"normals\", \"rgb\", \"depth\", \"semantic\", \"instance\", \"mask\", {flows}]");
    let street = street(&format!("channels = {list}"));
    cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run_ok();
    let dataset = street.dataset();
    let folder = dataset.to_str().expect("UTF-8");
    cosfly(&["verify", folder]).within(street.path()).run_ok();
    cosfly(&["preview", folder]).within(street.path()).run_ok();
    let card = std::fs::read_to_string(dataset.join("README.md")).expect("a card");
    assert!(card.contains("Channel `normals`: unit normals") && card.contains("Channel `mask`: 1 where"), "{card}");
    assert!(card.contains("Channel `flow_forward`: optical flow") && card.contains("Channel `depth_sensor`"), "{card}");
    cosfly(&["export", folder, "--format", "imagefolder", "--out", "pictures"]).within(street.path()).run_ok();
    let card = std::fs::read_to_string(street.path().join("pictures/README.md")).expect("a card");
    assert!(card.contains("`normals`: unit normals"), "{card}");
}

#[test]
fn impossible_cameras_and_renderers_are_refused_with_their_place() {
    for (lines, place, way_out) in [
        ("fov_range_deg = [100.0, 60.0]", "fov_range_deg", "lower value first"),
        ("fov_range_deg = [60.0, 170.0]", "fov_range_deg", "5 to 150"),
        ("gimbal = { yaw_range_deg = [0.0, 400.0] }", "yaw_range_deg", "-180 to 180"),
        ("lens = { k1 = -0.9 }", "lens", "nearer to 0"),
        ("motion_blur = { shutter_s = 3.0 }", "shutter_s", "0.5"),
        ("rolling_shutter = { strips = 1 }", "strips", "at least `2`"),
        ("weather = { cloudiness = [0.0, 180.0] }", "cloudiness", "0 to 100"),
        ("weather = { clouds = [0.0, 80.0] }", "clouds", "cloudiness"),
        ("season = \"spring\"", "season", "winter"),
        ("backend = \"gpu\"", "backend", "leave `backend` out"),
        ("backend = \"carla\"", "backend", "carla-job"),
        ("channels = [\"rgb\", \"depth\"]", "channels", "semantic"),
        ("channels = [\"rgb\", \"normal\"]", "channels", "normals"),
        (
            "lens = { k1 = -0.1 }\nchannels = [\"rgb\", \"depth\", \"semantic\", \"instance\", \"depth_sensor\"]",
            "channels",
            "rectified",
        ),
        ("weathers = [\"ClearNoon\", \"ClearNoon\"]\npaired_weathers = true", "weathers", "once"),
    ] {
        let street = street(lines);
        let printed = cosfly(&["run", "recipe.toml", "--quiet"]).within(street.path()).run();
        assert_eq!(printed.code, Some(3), "{lines}: {}", printed.stderr);
        assert!(printed.stderr.contains(place) && printed.stderr.contains(way_out), "{lines}: {}", printed.stderr);
        assert!(!street.dataset().exists());
    }
}
