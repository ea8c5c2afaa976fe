//! Boxes with labels of a CARLA server: kinds, plants, enclosed rotations, what is left out.

use cosfly_domain::{ObstacleKind, Town};
use cosfly_frames::{DVec2, DVec3, Seed};
use cosfly_maps::{MapConfig, read_town};
use cosfly_town::MapError;

/// A town of one box on a square.
fn read(one: &str) -> Result<(Town, Vec<String>), MapError> {
    let text = format!(
        r#"{{"format": "cosfly-boxes/1", "boxes": [{{{one}, "center_m": [30, 20, 6], "size_m": [8, 6, 10]}}],
        "walkable": [{{"kind": "plaza", "outline_m": [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]]}}]}}"#
    );
    read_town(text.as_bytes(), &MapConfig::default(), Seed::of_item(1, "town", "town"))
}

#[test]
fn labels_become_kinds() {
    for (label, kind) in [
        ("Buildings", ObstacleKind::Building),
        ("Walls", ObstacleKind::Wall),
        ("Fences", ObstacleKind::Fence),
        ("Poles", ObstacleKind::Pole),
        ("TrafficLight", ObstacleKind::TrafficLight),
        ("TrafficSigns", ObstacleKind::TrafficSign),
        ("GuardRail", ObstacleKind::GuardRail),
        ("Bridge", ObstacleKind::Bridge),
        ("Truck", ObstacleKind::Car),
        ("Other", ObstacleKind::Static),
    ] {
        let (town, warnings) = read(&format!("\"label\": \"{label}\"")).unwrap();
        assert_eq!(town.obstacles.iter().map(|one| one.kind).collect::<Vec<_>>(), [kind], "{label}");
        assert!(warnings.is_empty(), "{label}: {warnings:?}");
    }
}

#[test]
fn ground_is_left_out_and_counted() {
    for label in ["Roads", "Sky", "NONE", "Water"] {
        let (town, warnings) = read(&format!("\"label\": \"{label}\"")).unwrap();
        assert!(town.obstacles.is_empty(), "{label}");
        assert_eq!(warnings, ["1 boxes of ground, sky or people are left out"], "{label}");
    }
}

#[test]
fn high_plants_are_trees_within_their_box_and_said_to_be_assumed() {
    let (town, _) = read("\"label\": \"Vegetation\"").unwrap();
    let count = |kind| town.obstacles.iter().filter(|one| one.kind == kind).count();
    assert_eq!((count(ObstacleKind::TreeTrunk), count(ObstacleKind::TreeCrown)), (1, 4));
    assert!(town.obstacles.iter().all(|one| one.object_id == town.obstacles[0].object_id));
    let ends = town.obstacles.iter().map(|one| one.shape.bounds_in_world());
    let (low, high) = ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap();
    assert!((low.z - 1.0).abs() < 1e-9 && (high.z - 11.0).abs() < 1e-9, "{low} to {high}");
    assert!(low.x > 26.0 - 1e-9 && high.x < 34.0 + 1e-9, "{low} to {high}");
    assert!(
        town.synthetic.notes.iter().any(|note| note.contains("1 boxes of vegetation")),
        "{:?}",
        town.synthetic.notes
    );
}

#[test]
fn pitched_and_rolled_boxes_are_enclosed() {
    for (yaw_deg, pitch_deg, roll_deg) in
        [(0.0, 0.0, 0.0), (40.0, 90.0, 0.0), (-70.0, 12.0, -31.0), (200.0, -35.0, 80.0_f64)]
    {
        let text = format!(
            "\"label\": \"Buildings\", \"yaw_deg\": {yaw_deg}, \"pitch_deg\": {pitch_deg}, \"roll_deg\": {roll_deg}"
        );
        let (town, _) = read(&text).unwrap();
        let shape = &town.obstacles[0].shape;
        let [yaw, pitch, roll] = [yaw_deg, pitch_deg, roll_deg].map(f64::to_radians);
        // Corners of the turned box, axis by axis; the map's y is turned over.
        let mut reach = DVec3::ZERO;
        for corner in 0..8 {
            let sign = |bit: i32| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let v = DVec3::new(4.0 * sign(0), 3.0 * sign(1), 5.0 * sign(2));
            let rolled = DVec2::from_angle(roll).rotate(DVec2::new(v.y, v.z));
            let pitched = DVec2::from_angle(pitch).rotate(DVec2::new(v.x, rolled.y));
            reach = reach.max(DVec3::new(pitched.x, rolled.x, pitched.y).abs());
        }
        assert!((shape.half_extents_m - reach).abs().max_element() < 1e-9, "{:?} {reach}", shape.half_extents_m);
        assert!(cosfly_frames::real::sin(shape.yaw_rad + yaw).abs() < 1e-9);
    }
}

#[test]
fn a_box_has_a_kind_or_a_label() {
    for (one, expected) in [
        ("\"kind\": \"car\", \"label\": \"Car\"", "either `kind` or `label`"),
        ("\"yaw_deg\": 3", "either `kind` or `label`"),
        ("\"label\": \"Castle\"", "unknown variant `Castle`"),
        ("\"label\": \"Car\", \"pitch_deg\": 1e9", "must lie between"),
    ] {
        let error = read(one).unwrap_err();
        assert!(error.message.contains(expected), "{error}");
    }
}

#[test]
fn boxes_and_ground_that_are_there_again_are_counted_and_kept() {
    let one = |more: &str| format!("{{\"kind\": \"wall\", \"center_m\": [1, 2, 3], \"size_m\": [4, 5, 6]{more}}}");
    let ground = "{\"kind\": \"plaza\", \"outline_m\": [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]]}";
    let read = |boxes: &[String], walkable: &[&str]| {
        let (boxes, walkable) = (boxes.join(","), walkable.join(","));
        let text = format!("{{\"format\": \"cosfly-boxes/1\", \"boxes\": [{boxes}], \"walkable\": [{walkable}]}}");
        let seed = cosfly_frames::Seed::of_item(1, "town", "town");
        cosfly_maps::read_town(text.as_bytes(), &cosfly_maps::MapConfig::default(), seed).unwrap()
    };
    let differ = [one(""), one(", \"yaw_deg\": 1"), one(", \"roll_deg\": 1"), one("").replace("wall", "fence")];
    assert_eq!(read(&differ, &[ground]).1, Vec::<String>::new());
    let again = [one(", \"yaw_deg\": 1"), one(""), one(", \"yaw_deg\": -0.0"), one(", \"object\": 7")];
    let (town, warnings) = read(&again, &[ground, ground]);
    assert_eq!((town.obstacles.len(), town.walkable.len()), (4, 2));
    assert!(warnings[0].starts_with("2 entries of `boxes` are there again, the first one `boxes[2]` as `boxes[1]`"));
    assert!(warnings[1].starts_with("1 entries of `walkable` are there again, the first one `walkable[1]`"));
    assert!(warnings.len() == 2 && warnings.iter().all(|warning| warning.contains("all are kept")), "{warnings:?}");
}
