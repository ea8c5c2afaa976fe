//! OpenDRIVE: every feature of a file reaches the town, and bad input is refused at its place.

use cosfly_domain::{ObstacleKind, SemanticLabel, SurfaceMesh, Town, WalkableKind};
use cosfly_frames::{DVec3, Seed};
use cosfly_maps::formats::opendrive::{OpenDriveOptions, RoadMap, Roofs};
use cosfly_maps::{MapConfig, read_town};
use cosfly_town::{FormatOptions, GroundIndex, MapError};

/// A road of every curve, with every kind of profile, object and signal.
const STREET: &str = include_str!("../src/formats/opendrive/every_feature.xodr");

fn read(text: &str) -> Result<Town, MapError> {
    read_bytes(text.as_bytes())
}

fn read_bytes(bytes: &[u8]) -> Result<Town, MapError> {
    read_with_roofs(bytes, Roofs::Flat)
}

fn read_with_roofs(bytes: &[u8], roofs: Roofs) -> Result<Town, MapError> {
    let options = OpenDriveOptions { shoulders_as_sidewalks: true, roofs, ..OpenDriveOptions::default() };
    read_bytes_with(bytes, &options)
}

fn read_with(text: &str, options: &OpenDriveOptions) -> Result<Town, MapError> {
    read_bytes_with(text.as_bytes(), options)
}

fn read_bytes_with(bytes: &[u8], options: &OpenDriveOptions) -> Result<Town, MapError> {
    let config = MapConfig { options: FormatOptions::of(options), ..MapConfig::default() };
    let (town, _) = read_town(bytes, &config, Seed::of_item(1, "town", "town"))?;
    town.assert_well_formed().expect("a town that was read is well formed");
    Ok(town)
}

/// The street with one piece of its text replaced.
fn with(from: &str, to: &str) -> String {
    assert!(STREET.contains(from), "`{from}` is in the test file");
    STREET.replacen(from, to, 1)
}

fn check_refused(text: &str, expected: &str, line: Option<u32>) {
    let error = read(text).expect_err(expected);
    assert!(error.to_string().contains(expected), "`{error}` says `{expected}`");
    if let Some(line) = line {
        let place = error.place.as_ref().unwrap_or_else(|| panic!("`{error}` has a place"));
        assert_eq!(place.line, line, "{error}");
        assert!(place.byte_span.end <= text.len() + 1, "{error}");
    }
}

fn line_of(text: &str, what: &str) -> Option<u32> {
    text.lines().position(|line| line.contains(what)).map(|line| line as u32 + 1)
}

#[test]
fn a_file_with_every_feature_gives_every_part_of_a_town() {
    let town = read(STREET).unwrap();
    let kinds = |kind| town.obstacles.iter().filter(|obstacle| obstacle.kind == kind).count();
    use ObstacleKind as Kind;
    for (kind, expected) in [
        (Kind::Building, 3),
        (Kind::TreeTrunk, 2),
        (Kind::TreeCrown, 2 * 4),
        (Kind::Lamp, 6),
        (Kind::TrafficLight, 1),
        (Kind::TrafficSign, 2),
        (Kind::Pole, 3),
    ] {
        assert_eq!(kinds(kind), expected, "{kind:?}");
    }
    assert!(kinds(Kind::Wall) >= 2 && kinds(Kind::Fence) >= 1);
    for label in [SemanticLabel::Roads, SemanticLabel::SideWalks, SemanticLabel::RoadLine, SemanticLabel::Terrain] {
        assert!(town.surfaces.iter().any(|mesh| mesh.label == label && !mesh.triangles.is_empty()), "{label:?}");
    }
    for kind in [WalkableKind::Sidewalk, WalkableKind::Crossing, WalkableKind::Shoulder] {
        assert!(town.walkable.iter().any(|polygon| polygon.kind == kind), "{kind:?}");
    }
    assert_eq!((town.name.as_str(), town.origin.geo_reference.as_deref()), ("every feature", Some("+proj=tmerc")));
}

fn tops_m(town: &Town) -> Vec<f64> {
    let buildings = town.obstacles.iter().filter(|obstacle| obstacle.kind == ObstacleKind::Building);
    buildings.map(|one| one.shape.center_in_world.z + one.shape.half_extents_m.z).collect()
}

#[test]
fn roofs_are_guessed_in_georeferenced_maps_and_said() {
    let highest = |text: &str, roofs| {
        let town = read_with_roofs(text.as_bytes(), roofs).unwrap();
        let is_noted = town.synthetic.notes.iter().any(|note| note.contains("roofs of 1 buildings are guessed"));
        // The building with an outline is 9 m high, the other one 15 m.
        let tops = tops_m(&town).into_iter().filter(|top_m| *top_m < 14.0).fold(0.0, f64::max);
        (is_noted, tops)
    };
    let anonymous = with("<geoReference><![CDATA[+proj=tmerc]]></geoReference>", "");
    let (flat, flat_m) = highest(STREET, Roofs::Flat);
    assert_eq!((flat, highest(&anonymous, Roofs::Auto).0), (false, false));
    for (text, roofs) in [(STREET, Roofs::Auto), (STREET, Roofs::Pitched), (&*anonymous, Roofs::Pitched)] {
        let (is_noted, top_m) = highest(text, roofs);
        // Wings of about 4 m.
        assert!(is_noted && (1.5..2.5).contains(&(top_m - flat_m)), "{top_m} beside {flat_m}");
    }
}

#[test]
fn courtyards_of_outlines_stay_open() {
    let yard = r#"<outline id="1" outer="false"><cornerLocal u="-5" v="-3" z="0" height="9"/><cornerLocal u="-1" v="-3" z="0" height="9"/>
        <cornerLocal u="-1" v="2" z="0" height="9"/><cornerLocal u="-5" v="2" z="0" height="9"/></outline></object>"#;
    let plain = read(STREET).unwrap();
    let open = read(&with("</outline></object>", &format!("</outline>{yard}"))).unwrap();
    let volume = |town: &Town| -> f64 {
        let buildings = town.obstacles.iter().filter(|obstacle| obstacle.kind == ObstacleKind::Building);
        buildings.map(|one| 8.0 * one.shape.half_extents_m.element_product()).sum()
    };
    let missing_m3 = volume(&plain) - volume(&open);
    assert!((missing_m3 / (4.0 * 5.0 * 9.0) - 1.0).abs() < 0.3, "{missing_m3}");
}

#[test]
fn trees_keep_the_crowns_of_the_file() {
    let town = read(STREET).unwrap();
    let crowns: Vec<_> = town.obstacles.iter().filter(|obstacle| obstacle.kind == ObstacleKind::TreeCrown).collect();
    let reach_m = |one: &&cosfly_domain::Obstacle| one.shape.half_extents_m.truncate().length();
    let widest_m = crowns[..4].iter().map(reach_m).fold(0.0, f64::max);
    assert!(widest_m > 0.9 * 2.5 && widest_m < 1.42 * 2.5, "radius 2.5 m: {widest_m}");
    assert!((2.0 * crowns[0].shape.half_extents_m.z - 5.0).abs() < 1e-9, "height 8 m, crown from 3 m");
    assert!(town.synthetic.notes.iter().any(|note| note.contains("crowns of 1 trees are assumed")));
}

#[test]
fn curves_follow_each_other_without_gaps() {
    let (map, warnings) = RoadMap::read(STREET.as_bytes()).unwrap();
    assert_eq!(warnings, Vec::<String>::new());
    let road = &map.network.roads[0];
    for pair in road.plan.windows(2) {
        let end = pair[0].at(pair[1].start_s_m);
        assert!(end.position_in_map.distance(pair[1].start.position_in_map) < 1e-3, "s = {}", pair[1].start_s_m);
    }
}

#[test]
fn far_maps_move_to_the_origin_by_whole_metres() {
    let (map, _) = RoadMap::read(STREET.as_bytes()).unwrap();
    let far = STREET.replace("x=\"", "x=\"678");
    let (moved, _) = RoadMap::read(far.as_bytes()).unwrap();
    assert_eq!(map.world.offset_m.length(), 0.0);
    assert!(moved.world.offset_m.x > 1e4 && moved.world.offset_m.x.fract() == 0.0);
}

#[test]
fn bad_numbers_are_refused_with_value_rule_and_line() {
    for (from, to, expected) in [
        ("length=\"40\"><line", "length=\"NaN\"><line", "`length` is `NaN`; it must be a finite number"),
        ("length=\"40\"><line", "length=\"-40\"><line", "`length` is `-40`; it must lie between 0 and 1000000 m"),
        ("length=\"40\"><line", "length=\"1e300\"><line", "it must lie between"),
        ("length=\"40\"><line", "><line", "`geometry` has no `length`"),
        ("hdg=\"0\" length=\"40\"", "hdg=\"inf\" length=\"40\"", "`hdg` is `inf`; it must be a finite number"),
        ("hdg=\"0\" length=\"40\"", "hdg=\"zero\" length=\"40\"", "`hdg` is `zero`; it must be a number"),
        ("curvature=\"0.02\"", "curvature=\"1e9\"", "`curvature` is `1e9`"),
        ("<width sOffset=\"0\" a=\"3.5\"", "<width sOffset=\"0\" a=\"3.5e6\"", "`a` is `3.5e6`; it must lie between"),
        ("type=\"building\" s=\"10\"", "type=\"building\" s=\"nan\"", "`s` is `nan`"),
        ("pRange=\"normalized\"", "pRange=\"metres\"", "`pRange` is `metres`; it must be"),
        ("<line/>", "<wiggle/>", "`wiggle` is not a known shape"),
        ("<lane id=\"1\"", "<lane id=\"one\"", "`id` is `one`; a lane's id is a whole number"),
    ] {
        let text = with(from, to);
        let line = line_of(&text, to);
        check_refused(&text, expected, line);
    }
}

#[test]
fn errors_name_the_element_and_what_it_belongs_to() {
    let text = with("<width sOffset=\"0\" a=\"3.5\"", "<width sOffset=\"0\" a=\"x\"");
    let error = read(&text).unwrap_err();
    let place = error.place.unwrap();
    assert_eq!(place.element, "<width> of lane `1` of road `main street`");
    assert_eq!(&text[place.byte_span], "x");
}

#[test]
fn widths_that_grow_beyond_all_bounds_are_refused() {
    let text = with("<width sOffset=\"0\" a=\"3.5\" b=\"0\"", "<width sOffset=\"0\" a=\"3.5\" b=\"1e6\"");
    check_refused(&text, "a lane is at most 1000 m wide", line_of(&text, "<road "));
}

#[test]
fn wrong_files_say_what_is_wrong() {
    for (bytes, expected) in [
        (&b""[..], "the file is empty"),
        (b"hello", "the file is of no known map format"),
        (b"<?xml version='1.0'?><OpenDRIVE/>", "the file has no road"),
        (b"<OpenDRIVE><road id='1' length='5'/></OpenDRIVE>", "the road has no `<planView>`"),
        (b"<!DOCTYPE a [<!ENTITY b 'c'>]><OpenDRIVE/>", "broken XML"),
        (b"\xff\xfe<\0O\0p\0e\0n\0D\0R\0I\0V\0E\0>\0", "UTF-16"),
        (b"<OpenDRIVE>\xff\xff</OpenDRIVE>", "byte 0xff is not UTF-8 text"),
    ] {
        let error = read_bytes(bytes).expect_err(expected);
        assert!(error.to_string().contains(expected), "`{error}` says `{expected}`");
    }
}

#[test]
fn a_truncated_file_gives_the_place_and_says_that_it_is_cut_off() {
    for share in [0.2, 0.5, 0.77, 0.99] {
        let end = (STREET.len() as f64 * share) as usize;
        let error = read(&STREET[..end]).unwrap_err();
        assert!(error.message.starts_with("broken XML"), "{error}");
        let place = error.place.expect("a truncated file has a place");
        assert!(place.line > 1 && place.byte_span.start <= end, "{place:?}");
        assert!(error.hints.iter().any(|hint| hint.contains("cut off")), "{:?} at {share}", error.hints);
    }
}

#[test]
fn a_town_without_pavements_is_walked_on_its_shoulders() {
    let text = STREET.replace("type=\"sidewalk\"", "type=\"none\"");
    let assumed = read_with(&text, &OpenDriveOptions::default()).unwrap();
    assert!(assumed.walkable.iter().any(|polygon| polygon.kind == WalkableKind::Shoulder));
    assert!(assumed.synthetic.notes.iter().any(|note| note.contains("use the road shoulders")));
    // Who asked for shoulders gets the same ground without a note.
    let asked = read_with(&text, &OpenDriveOptions { shoulders_as_sidewalks: true, ..OpenDriveOptions::default() });
    let asked = asked.unwrap();
    assert_eq!(asked.walkable, assumed.walkable);
    assert!(!asked.synthetic.notes.iter().any(|note| note.contains("shoulders")));
    // A town that has pavements does not open its shoulders by itself.
    let whole = read_with(STREET, &OpenDriveOptions::default()).unwrap();
    assert!(whole.walkable.iter().all(|polygon| polygon.kind != WalkableKind::Shoulder));
    check_refused_where_nothing_is_assumed(&text);
}

#[test]
fn a_town_without_pavements_and_shoulders_gets_pavements_beside_its_carriageways() {
    let text = STREET.replace("type=\"sidewalk\"", "type=\"none\"").replace("type=\"shoulder\"", "type=\"none\"");
    let town = read_with(&text, &OpenDriveOptions::default()).unwrap();
    assert!(town.synthetic.notes.iter().any(|note| note.contains("beside the carriageways")));
    assert!(town.walkable.iter().all(|polygon| polygon.synthetic || polygon.kind == WalkableKind::Crossing));
    // The pavements lie on the ground, which is synthetic as they are, and never on a carriageway.
    let is_pavement = |mesh: &SurfaceMesh| mesh.label == SemanticLabel::SideWalks && mesh.synthetic;
    let pavements = GroundIndex::of_surfaces(&town.surfaces, is_pavement);
    let roads = GroundIndex::of_surfaces(&town.surfaces, |mesh| mesh.label == SemanticLabel::Roads);
    let verges: Vec<_> = town.walkable.iter().filter(|area| area.kind == WalkableKind::Sidewalk).collect();
    assert!(verges.len() > 20, "{}", verges.len());
    for area in verges {
        let corners = &area.outline_in_world;
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let ground = pavements.ground_near(middle).expect("a pavement has a surface");
        assert!((ground.height_m - middle.z).abs() < 0.1, "{} at {middle}", ground.height_m);
        assert!(roads.ground_near(middle).is_none(), "a road at {middle}");
    }
    check_refused_where_nothing_is_assumed(&text);
}

#[test]
fn a_town_without_carriageways_too_is_refused() {
    let kinds = ["sidewalk", "shoulder", "driving", "biking", "parking"];
    let text =
        kinds.iter().fold(STREET.to_owned(), |text, kind| text.replace(&format!("type=\"{kind}\""), "type=\"none\""));
    let refused = read_with(&text, &OpenDriveOptions::default()).unwrap_err();
    assert!(refused.message.contains("no walkable ground"), "{refused}");
    assert!(refused.hints[0].contains("no carriageway"), "{:?}", refused.hints);
}

fn check_refused_where_nothing_is_assumed(text: &str) {
    let options = OpenDriveOptions { assume_ground: false, ..OpenDriveOptions::default() };
    let refused = read_with(text, &options).unwrap_err();
    assert!(refused.message.contains("no walkable ground"), "{refused}");
    assert!(refused.hints[0].contains("assume_ground"), "{:?}", refused.hints);
}
