//! CityJSON: every feature of a file reaches the town, and bad input is refused or left out and counted.

use cosfly_domain::{ObstacleKind, SemanticLabel, Town, WalkableKind};
use cosfly_frames::DVec3;
use cosfly_geodata::cityjson::{CityJson, CityJsonOptions};
use cosfly_town::{MapError, MapFormat};

/// A house of two parts, a shed without a height of its own, a street, a square, relief, a hedge, a wall, a pond, a tree.
const PLACE: &str = include_str!("../src/cityjson/every_feature.city.json");
/// Two features in a sequence.
const SEQUENCE: &str = include_str!("sequence.city.jsonl");

fn read(text: &str) -> Result<(Town, Vec<String>), MapError> {
    let (mut town, warnings) = CityJson::read(text.as_bytes(), &CityJsonOptions::default())?;
    town.update_bounds();
    cosfly_town::assert_well_formed(&town).expect("a town that was read is well formed");
    Ok((town, warnings))
}

/// The place with one piece of its text replaced.
fn with(from: &str, to: &str) -> String {
    assert!(PLACE.contains(from), "`{from}` is in the test file");
    PLACE.replacen(from, to, 1)
}

/// Lowest and highest point of each thing of a kind, metres, in the order of the file's names.
fn heights_m(town: &Town, kind: ObstacleKind) -> Vec<(f64, f64)> {
    let mut ids: Vec<u32> = town.obstacles.iter().filter(|one| one.kind == kind).map(|one| one.object_id).collect();
    ids.sort_unstable();
    ids.dedup();
    let of_thing = |id: u32| {
        let boxes = town.obstacles.iter().filter(move |one| one.object_id == id && one.kind == kind);
        let ends = boxes.map(|one| (one.shape.bounds_in_world().0.z, one.shape.bounds_in_world().1.z));
        ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).expect("a thing has boxes")
    };
    ids.into_iter().map(of_thing).collect()
}

fn is_solid(town: &Town, point: DVec3) -> bool {
    town.obstacles.iter().any(|one| {
        let away = point - one.shape.center_in_world;
        let local = cosfly_frames::DVec2::from_angle(-one.shape.yaw_rad).rotate(away.truncate()).extend(away.z);
        local.abs().cmple(one.shape.half_extents_m).all()
    })
}

#[test]
fn a_file_with_every_feature_gives_every_part_of_a_town() {
    let (town, warnings) = read(PLACE).unwrap();
    assert_eq!(warnings, Vec::<String>::new());
    assert_eq!(town.origin.offset_m, DVec3::new(85020.0, -447503.0, 0.0));
    assert_eq!(town.origin.geo_reference.as_deref(), Some("https://www.opengis.net/def/crs/EPSG/0/7415"));
    // The house with its parts is one thing up to 12 m; the shed is 3.5 m high by its attribute.
    let buildings = heights_m(&town, ObstacleKind::Building);
    assert_eq!(buildings.len(), 2);
    for ((low_m, high_m), expected_m) in buildings.into_iter().zip([12.0, 4.5]) {
        assert!((low_m - 1.0).abs() < 1e-9 && (high_m - expected_m).abs() < 1e-9, "{low_m} to {high_m}");
    }
    for kind in [ObstacleKind::TreeTrunk, ObstacleKind::TreeCrown, ObstacleKind::Bush, ObstacleKind::Wall] {
        assert!(town.obstacles.iter().any(|one| one.kind == kind), "{kind:?}");
    }
    for kind in [WalkableKind::Sidewalk, WalkableKind::Crossing, WalkableKind::Plaza, WalkableKind::Road] {
        assert!(town.walkable.iter().any(|polygon| polygon.kind == kind && !polygon.synthetic), "{kind:?}");
    }
    for label in [SemanticLabel::Roads, SemanticLabel::SideWalks, SemanticLabel::Terrain, SemanticLabel::Water] {
        assert!(town.surfaces.iter().any(|mesh| mesh.label == label && !mesh.synthetic), "{label:?}");
    }
}

#[test]
fn gables_are_solid_below_the_ridge_and_courtyards_are_open() {
    let (town, _) = read(PLACE).unwrap();
    // Map coordinates from the file's corner: x east, y north, metres above the corner.
    let is_solid = |x: f64, y: f64, z: f64| is_solid(&town, DVec3::new(x - 20.0, 3.0 - y, z + 1.0));
    assert!(is_solid(6.0, 4.0, 8.9) && is_solid(6.0, 1.0, 6.7));
    assert!(!is_solid(6.0, 0.6, 8.5) && !is_solid(6.0, 7.4, 8.5) && !is_solid(6.0, 4.0, 9.1));
    assert!(is_solid(16.0, 8.0, 10.9) && is_solid(32.0, 8.0, 1.0) && !is_solid(24.0, 8.0, 1.0));
}

#[test]
fn trees_are_templates_at_their_place_and_scale() {
    let (town, _) = read(PLACE).unwrap();
    let trunk = town.obstacles.iter().find(|one| one.kind == ObstacleKind::TreeTrunk).unwrap();
    let (low, _) = trunk.shape.bounds_in_world();
    assert!((trunk.shape.center_in_world.truncate() - cosfly_frames::DVec2::new(30.0, -1.0)).length() < 0.2);
    let top_m = heights_m(&town, ObstacleKind::TreeCrown)[0].1;
    // The template is 4 m high, the instance twice that.
    assert!((low.z - 1.0).abs() < 1e-9 && (top_m - 9.0).abs() < 1e-9, "{low} {top_m}");
}

/// A stand of plants that rises to two points of 8 m, 20 m apart.
const STAND: &str = r#"{
  "type": "CityJSON", "version": "2.0",
  "transform": { "scale": [1.0, 1.0, 1.0], "translate": [0.0, 0.0, 0.0] },
  "CityObjects": { "stand": { "type": "PlantCover", "geometry": [{ "type": "MultiSurface", "lod": "2", "boundaries": [
    [[0, 1, 4]], [[1, 2, 4]], [[2, 3, 4]], [[3, 0, 4]], [[5, 6, 9]], [[6, 7, 9]], [[7, 8, 9]], [[8, 5, 9]]
  ] }] } },
  "vertices": [
    [0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 1, 8],
    [20, 0, 0], [22, 0, 0], [22, 2, 0], [20, 2, 0], [21, 1, 8]
  ]
}"#;

#[test]
fn every_tree_of_a_stand_is_an_object_of_its_own() {
    let (town, _) = read(STAND).unwrap();
    let of_kind = |kind| {
        let boxes = town.obstacles.iter().filter(move |one| one.kind == kind);
        boxes.map(|one| (one.shape.center_in_world.x.round(), one.object_id)).collect::<Vec<_>>()
    };
    let crowns = of_kind(ObstacleKind::TreeCrown);
    assert_eq!(crowns.len(), 2);
    assert_ne!(crowns[0].1, crowns[1].1);
    assert_eq!(of_kind(ObstacleKind::TreeTrunk), crowns);
}

#[test]
fn attributes_that_are_not_believed_are_told_of_with_what_is_taken() {
    let shed = |attributes: &str| read(&with("\"measuredHeight\": 3.5", attributes)).unwrap();
    let tops_m = |town: &Town| heights_m(town, ObstacleKind::Building).into_iter().map(|(_, top_m)| top_m - 1.0);
    let (town, warnings) = shed("\"measuredHeight\": \"tall\", \"storeysAboveGround\": 2");
    assert!(tops_m(&town).any(|top_m| (top_m - 6.0).abs() < 1e-9));
    let line = "1 buildings have a `measuredHeight` that is no height of 0.5 to 1500 m and counts as missing; the first one is \
                `tall` of `shed`";
    assert_eq!(warnings, [line]);
    for (attributes, told) in [
        ("\"height\": -3", "`height` that is no height of 0.5 to 1500 m and counts as missing; the first one is `-3`"),
        ("\"height\": [9]", "the first one is `[9]` of `shed`"),
        ("\"storeysAboveGround\": 9999", "`storeysAboveGround` that is no number of storeys up to 500"),
    ] {
        let (town, warnings) = shed(attributes);
        assert_eq!(tops_m(&town).count(), 1, "the shed is left out");
        assert!(warnings.len() == 2 && warnings[0].contains("without a believable `measuredHeight`"), "{warnings:?}");
        assert!(warnings[1].contains(told), "{warnings:?}");
    }
    let (_, warnings) = read(&with("\"lod\": \"2.2\"", "\"lod\": \"fine\"")).unwrap();
    assert!(
        warnings[0].starts_with("1 shapes have a `lod` that is no number and counts as 0; the first one is `fine`")
    );
    let flat = with("[2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2,", "[0.01, 0, 0, 0, 0, 0.01, 0, 0, 0, 0, 0.01,");
    let attributes = "\"SolitaryVegetationObject\", \"attributes\": {\"height\": \"x\", \"crownDiameter\": -1},";
    let (_, warnings) = read(&flat.replacen("\"SolitaryVegetationObject\",", attributes, 1)).unwrap();
    for (name, value) in [("crownDiameter", "-1"), ("height", "x")] {
        let line = format!(
            "1 trees have a `{name}` that is no number above 0 and counts as missing; the first one is `{value}`"
        );
        assert!(warnings.iter().any(|warning| warning.starts_with(&line)), "{warnings:?}");
    }
}

#[test]
fn trees_of_absurd_size_are_told_of() {
    let top_m = |text: &str| {
        let (town, warnings) = read(text).unwrap();
        let top_m = heights_m(&town, ObstacleKind::TreeCrown)[0].1 - 1.0;
        (top_m, warnings.iter().any(|warning| warning.contains("1 trees are lower") && warning.contains("`tree`")))
    };
    let scaled = |factor: &str| {
        top_m(&with("[2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2,", &format!("[2, 0, 0, 0, 0, 2, 0, 0, 0, 0, {factor},")))
    };
    assert_eq!(scaled("20"), (80.0, false));
    assert_eq!(scaled("200"), (120.0, true));
    let stated = |height: &str| {
        let text = with("[2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2,", "[2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0.01,");
        let attributes = format!("\"SolitaryVegetationObject\", \"attributes\": {{\"height\": {height}}},");
        top_m(&text.replacen("\"SolitaryVegetationObject\",", &attributes, 1))
    };
    assert_eq!(stated("15"), (15.0, false));
    assert_eq!(stated("9000"), (8.0, true), "the usual height");
}

#[test]
fn feet_become_metres() {
    let text = PLACE.replace("EPSG/0/7415", "EPSG/0/2263");
    let (town, _) = read(&text).unwrap();
    let heights = heights_m(&town, ObstacleKind::Building);
    assert!((heights[0].1 - heights[0].0 - 11.0 * 1200.0 / 3937.0).abs() < 1e-6, "{heights:?}");
    // A plan in feet with heights in metres: the two parts of the system have units of their own.
    let compound =
        "crs-compound?1=https://www.opengis.net/def/crs/EPSG/0/2263&2=https://www.opengis.net/def/crs/EPSG/0/5703";
    let (town, warnings) = read(&with("EPSG/0/7415", compound)).unwrap();
    let heights = heights_m(&town, ObstacleKind::Building);
    assert!((heights[0].1 - heights[0].0 - 11.0).abs() < 1e-6, "{heights:?}");
    assert!(warnings.iter().any(|warning| warning.contains("divide those of the map by 0.3048")), "{warnings:?}");
    let degrees = with("EPSG/0/7415", "EPSG/0/4979")
        .replace("[85000, 447500, 1]", "[8, 47, 1]")
        .replace("0.01, 0.01, 0.01", "1e-6, 1e-6, 0.01");
    assert!(read(&degrees).unwrap_err().message.contains("degrees"));
}

#[test]
fn sequences_are_read_feature_by_feature() {
    let (town, warnings) = read(SEQUENCE).unwrap();
    assert_eq!(warnings, Vec::<String>::new());
    assert_eq!(heights_m(&town, ObstacleKind::Building), [(0.0, 5.0), (0.0, 9.0)]);
    assert!(town.walkable.iter().all(|polygon| polygon.kind == WalkableKind::Plaza && polygon.synthetic));
    assert!(town.synthetic.notes.iter().any(|note| note.contains("plazas")), "{:?}", town.synthetic.notes);
    assert!(town.synthetic.notes.iter().any(|note| note.contains("storey counts")), "{:?}", town.synthetic.notes);
    let lines: Vec<&str> = SEQUENCE.lines().collect();
    let system = "\"CityJSONFeature\",\"metadata\":{\"referenceSystem\":\"EPSG:25832\"},";
    let error = read(&SEQUENCE.replacen("\"CityJSONFeature\",\"id\":\"b\",", system, 1)).unwrap_err();
    assert!(error.message.contains("feature 2 has another `metadata.referenceSystem`"), "{error}");
    for transform in ["[0.001,0,0.001]", "[1e23,1,1]"] {
        let error = read(&SEQUENCE.replacen("[0.001,0.001,0.001]", transform, 1)).unwrap_err();
        assert!(error.message.contains("`transform.scale` has"), "{error}");
    }
    let error = read(lines[1]).unwrap_err();
    assert!(error.message.contains("must be `CityJSON`"), "{error}");
}

#[test]
fn what_is_broken_is_left_out_and_counted_with_its_name() {
    for (text, expected) in [
        (with("[[4, 5, 9, 8]]", "[[4, 5, 9, 8000]]"), "1 faces with fewer than three corners"),
        (with("[[4, 5, 9, 8]]", "[[4, 5]]"), "the first one of `wing`"),
        (with("\"measuredHeight\": 3.5", "\"measuredHeight\": \"tall\""), "1 flat buildings without"),
        (with("\"type\": \"WaterBody\"", "\"type\": \"+Duckpond\""), "1 objects of kinds that are not read"),
        (with("\"template\": 0", "\"template\": 7"), "1 faces"),
    ] {
        let (_, warnings) = read(&text).unwrap();
        assert!(warnings.iter().any(|warning| warning.contains(expected)), "{expected}: {warnings:?}");
    }
}

#[test]
fn members_may_come_in_any_order_and_unused_vertices_anywhere() {
    use serde_json::Value;
    let (town, _) = read(PLACE).unwrap();
    let mut place: Value = serde_json::from_str(PLACE).unwrap();
    place["vertices"].as_array_mut().unwrap().push(serde_json::json!([-40_000_000, 0, 0]));
    let (far, _) = read(&place.to_string()).unwrap();
    assert_eq!((town.obstacles, town.walkable), (far.obstacles, far.walkable));
    let long = format!("[{}]", vec!["[1, 2, 3]"; 1000].join(", "));
    for first in
        [format!("\"vertices\": {long}"), "\"transform\": {\"scale\": [1, 1, 1], \"translate\": [0, 0, 0]}".into()]
    {
        let text = format!("{{{first}, \"more\": {long}, \"type\": \"CityJSON\"}}");
        assert!(CityJson::recognises(&text.as_bytes()[..4096]), "{first}");
    }
}

#[test]
fn a_house_of_walls_and_slabs_is_one_building() {
    let (parts, _) = read(&PLACE.replace("\"BuildingPart\"", "\"BuildingConstructiveElement\"")).unwrap();
    let (low_m, high_m) = heights_m(&parts, ObstacleKind::Building)[0];
    assert!((low_m - 1.0).abs() < 1e-9 && (high_m - 12.0).abs() < 1e-9, "{low_m} to {high_m}");
}

#[test]
fn wrong_files_say_what_is_wrong() {
    for (text, expected) in [
        (with("\"2.0\"", "\"0.9\""), "versions 1.0 to 2.0 are read"),
        (with("[[0, 1, 2, 3]]", "[[0, 1, -2, 3]]"), "the index of a vertex"),
        (with("[0.01, 0.01, 0.01]", "[1e7, 1e7, 1]"), "m across; at most 100000 m are read"),
        (PLACE[..PLACE.len() / 2].to_owned(), "EOF"),
        ("{\"type\": \"CityJSON\", \"version\": \"2.0\", \"CityObjects\": {}, \"vertices\": []}".into(), "has a shape"),
        (
            "{\"type\": \"CityJSON\", \"version\": \"2.0\", \"CityObjects\": {}, \"vertices\": [[0, 0, 0]]}".into(),
            "has a shape",
        ),
        (
            with("[0.01, 0.01, 0.01]", "[1e-7, 1e-7, 0.01]").replace("[85000, 447500, 1]", "[139.76, 35.68, 1]"),
            "seem to be degrees",
        ),
    ] {
        let error = read(&text).unwrap_err();
        assert!(error.message.contains(expected), "{expected}: {error}");
    }
    let deep = with("[[[0, 1, 2, 3]]]", &("[".repeat(5000) + &"]".repeat(5000)));
    assert!(read(&deep).is_err());
}

#[test]
fn circles_of_parents_and_rings_that_cross_themselves_are_read() {
    let (town, _) = read(&with("\"children\": [\"wing\", \"hall\"]", "\"parents\": [\"wing\"]")).unwrap();
    assert!(!town.obstacles.is_empty());
    let (town, _) = read(&with("[[26, 27, 28, 29]]", "[[26, 28, 27, 29]]")).unwrap();
    assert_eq!(heights_m(&town, ObstacleKind::Building).len(), 2);
}

#[test]
fn a_ring_of_a_million_corners_takes_bounded_time() {
    let count = 1_000_000;
    let corner = |i: i32| format!("[{},{},0]", 3000 + (i * 7) % 1000, i % 3001);
    let corners: Vec<String> = (0..count).map(corner).collect();
    let ring: Vec<String> = (0..count).map(|i| i.to_string()).collect();
    let text = format!(
        "{{\"type\": \"CityJSON\", \"version\": \"1.1\", \"transform\": {{\"scale\": [0.01, 0.01, 0.01], \"translate\": [0, 0, 0]}}, \
         \"CityObjects\": {{\"a\": {{\"type\": \"Building\", \"attributes\": {{\"measuredHeight\": 9}}, \"geometry\": \
         [{{\"type\": \"MultiSurface\", \"lod\": 0, \"boundaries\": [[[{}]]]}}]}}}}, \"vertices\": [{}]}}",
        ring.join(","),
        corners.join(",")
    );
    let (town, _) = read(&text).unwrap();
    let count = town.obstacles.len();
    assert!((1..=64).contains(&count), "{count} boxes");
}

#[test]
fn names_that_are_there_twice_are_refused_or_counted() {
    let twice = with("\"CityObjects\": {", "\"CityObjects\": { \"shed\": { \"type\": \"Road\" },");
    let error = read(&twice).unwrap_err();
    assert!(error.message.contains("`CityObjects` has `shed` twice") && error.place.is_some(), "{error}");
    let lines: Vec<&str> = SEQUENCE.lines().collect();
    let (town, warnings) = read(&[lines.clone(), vec![lines[1]]].concat().join("\n")).unwrap();
    assert_eq!(heights_m(&town, ObstacleKind::Building), [(0.0, 5.0), (0.0, 9.0)]);
    assert!(warnings[0].contains("again under the same name"), "{warnings:?}");
}

#[test]
fn transforms_are_those_of_their_document() {
    let (town, _) = read(SEQUENCE).unwrap();
    let lines: Vec<&str> = SEQUENCE.lines().collect();
    let transform = "\"transform\":{\"scale\":[2.0,2.0,2.0],\"translate\":[0.0,0.0,0.0]},";
    let own =
        lines[1].replacen("\"type\":\"CityJSONFeature\",", &format!("\"type\":\"CityJSONFeature\",{transform}"), 1);
    assert_ne!(own, lines[1]);
    let (twice, _) = read(&[&[lines[0], &own], &lines[2..]].concat().join("\n")).unwrap();
    assert_ne!(heights_m(&twice, ObstacleKind::Building), heights_m(&town, ObstacleKind::Building));
    for scale in ["[0, 0.01, 0.01]", "[0.01, -0.01, 0.01]", "[0.01, 0.01, 1e23]"] {
        let error = read(&with("[0.01, 0.01, 0.01]", scale)).unwrap_err();
        assert!(error.message.contains("`transform.scale` has"), "{scale}: {error}");
    }
}

#[test]
fn heights_that_no_building_has_are_left_out_with_a_word() {
    for height in ["1e4", "1e23", "-3", "0"] {
        let (_, warnings) = read(&with("\"measuredHeight\": 3.5", &format!("\"measuredHeight\": {height}"))).unwrap();
        assert!(warnings[0].contains("believable"), "{height}: {warnings:?}");
    }
}
