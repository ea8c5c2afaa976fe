//! Towns of several files: things stand where they are in the world, and what earlier files have is replaced.

use cosfly_domain::{Obstacle, ObstacleKind, Town};
use cosfly_frames::{DVec2, DVec3, Seed};
use cosfly_geodata::reference::GeoReference;
use cosfly_maps::combine::{FurtherSource, Part};
use cosfly_maps::{MapConfig, read_town_of};
use cosfly_town::MapError;
use serde_json::json;

const STREET: &str = include_str!("../src/formats/opendrive/every_feature.xodr");
/// Projection of the street's file in these tests.
const LOCAL: &str = "+proj=tmerc +lat_0=48 +lon_0=11 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m";

fn street() -> String {
    assert!(STREET.contains("+proj=tmerc"));
    STREET.replacen("+proj=tmerc", LOCAL, 1)
}

fn read(first: &str, further: serde_json::Value, second: &str) -> Result<Town, (usize, MapError)> {
    let further: FurtherSource = serde_json::from_value(further).unwrap();
    let config = MapConfig { more: vec![further], ..MapConfig::default() };
    let files = [first.as_bytes(), second.as_bytes()];
    let (town, _) = read_town_of(&files, &config, Seed::of_item(1, "town", "town"))?;
    town.assert_well_formed().unwrap();
    Ok(town)
}

fn of_kind(town: &Town, kind: ObstacleKind) -> Vec<&Obstacle> {
    town.obstacles.iter().filter(|obstacle| obstacle.kind == kind).collect()
}

const HOUSES: &str = r#"{
  "format": "cosfly-boxes/1",
  "boxes": [
    { "kind": "building", "center_m": [20, 14, 105], "size_m": [16, 10, 10], "yaw_deg": 0 },
    { "kind": "pole", "center_m": [0, 5, 102], "size_m": [0.2, 0.2, 4] }
  ],
  "walkable": [{ "kind": "plaza", "outline_m": [[-60, 0, 100], [60, 0, 100], [60, 30, 100], [-60, 30, 100]] }]
}"#;

#[test]
fn houses_of_a_given_place_replace_those_of_the_streets() {
    let alone =
        read_town_of(&[street().as_bytes()], &MapConfig::default(), Seed::of_item(1, "town", "town")).unwrap().0;
    let further =
        json!({ "source": "houses.json", "shift_m": [100.0, 50.0, 0.0], "turn_deg": 90.0, "heights": "file" });
    let town = read(&street(), further, HOUSES).unwrap();
    let houses = of_kind(&town, ObstacleKind::Building);
    assert_eq!(houses.len(), 1);
    // Turned by 90 degrees, (20, 14) is (-14, 20); y of the world points south.
    let origin = town.origin.offset_m;
    let expected = DVec3::new(86.0, -70.0, 105.0) - origin;
    assert!(houses[0].shape.center_in_world.distance(expected) < 1e-9, "{:?}", houses[0].shape);
    assert!(cosfly_frames::real::cos(houses[0].shape.yaw_rad).abs() < 1e-9);
    // Other things stay, those of the second file are not taken, and ids are of one thing each.
    let others = |town: &Town| town.obstacles.iter().filter(|it| it.kind == ObstacleKind::Lamp).count();
    assert_eq!(others(&town), others(&alone));
    assert_eq!(of_kind(&town, ObstacleKind::Pole).len(), of_kind(&alone, ObstacleKind::Pole).len());
    assert!(town.obstacles.iter().filter(|it| it.object_id == houses[0].object_id).count() == 1);
    assert_eq!(town.walkable, alone.walkable);
}

#[test]
fn things_stand_on_the_ground_of_the_first_file() {
    let further =
        json!({ "source": "houses.json", "shift_m": [0, 0, 0], "take": ["buildings", "furniture"], "replace": false });
    let town = read(HOUSES, further, &HOUSES.replace("105", "5").replace("102", "7")).unwrap();
    for (kind, half_m) in [(ObstacleKind::Building, 5.0), (ObstacleKind::Pole, 2.0)] {
        let [first, second] = of_kind(&town, kind)[..] else { panic!("one of each file") };
        assert!((second.shape.center_in_world.z - 100.0 - half_m).abs() < 0.3, "{:?}", second.shape);
        assert_ne!(first.object_id, second.object_id);
    }
}

#[test]
fn projections_tell_the_place() {
    let corner = |lat: f64, lon: f64| [lat, lon];
    let corners =
        [corner(48.0010, 11.0010), corner(48.0010, 11.0012), corner(48.0012, 11.0012), corner(48.0012, 11.0010)];
    let nodes: Vec<String> = corners
        .iter()
        .enumerate()
        .map(|(at, [lat, lon])| format!("<node id=\"{}\" lat=\"{lat}\" lon=\"{lon}\" version=\"1\"/>", at + 1))
        .collect();
    let refs: String = [1, 2, 3, 4, 1].iter().map(|id| format!("<nd ref=\"{id}\"/>")).collect();
    let osm = format!(
        "<?xml version=\"1.0\"?><osm version=\"0.6\">{}<way id=\"9\" version=\"1\">{refs}<tag k=\"building\" v=\"yes\"/><tag k=\"height\" v=\"12\"/></way></osm>",
        nodes.join("")
    );
    let town = read(&street(), json!({ "source": "houses.osm" }), &osm).unwrap();
    let houses = of_kind(&town, ObstacleKind::Building);
    assert!(!houses.is_empty());
    let middle = GeoReference::parse(LOCAL).unwrap().project([11.0011, 48.0011]);
    let expected = DVec2::new(middle.x, -middle.y) - town.origin.offset_m.truncate();
    let [low, high] = houses.iter().fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[low, high], house| {
        let (a, b) = house.shape.bounds_in_world();
        [low.min(a.truncate()), high.max(b.truncate())]
    });
    assert!((0.5 * (low + high)).distance(expected) < 0.3, "{low} {high} {expected}");
    assert!((houses[0].shape.half_extents_m.z - 6.0).abs() < 1e-6);
}

#[test]
fn files_without_a_common_projection_need_a_place() {
    let (at, error) = read(&street(), json!({ "source": "houses.json" }), HOUSES).unwrap_err();
    assert_eq!(at, 1);
    assert!(
        error.message.contains("`houses.json`") && error.hints.iter().any(|hint| hint.contains("shift_m")),
        "{error}"
    );
    let (at, error) = read(&street(), json!({ "source": "houses.json", "shift_m": [0, 0, 0] }), "hello").unwrap_err();
    assert_eq!((at, error.message.as_str()), (1, "the file is of no known map format"));
    let wrong: Result<FurtherSource, _> = serde_json::from_value(json!({ "source": "a", "take": ["houses"] }));
    assert!(wrong.is_err());
    assert_eq!(serde_json::from_value::<FurtherSource>(json!({ "source": "a" })).unwrap().take, [Part::Buildings]);
}
