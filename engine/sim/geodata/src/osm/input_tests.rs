//! Files with repeated, deleted, missing and out-of-order elements, several stated areas, and packed bombs.

use super::pbf::{DenseInfo, DenseNodes, PrimitiveBlock, PrimitiveGroup, StringTable};
use super::tests::{RING, blob, gzip, osm, raw, read, way, zlib};
use cosfly_domain::{ObstacleKind, Town, WalkableKind};
use cosfly_frames::{DVec2, real};
use cosfly_town::polygons::contains;
use prost::Message;

const SQUARE: [(i64, i32, i32); 4] = [(1, 0, 0), (2, 2, 0), (3, 2, 2), (4, 0, 2)];

/// Heights of the tops of all boxes of buildings, metres.
fn tops_m(town: &Town) -> Vec<f64> {
    let own = town.obstacles.iter().filter(|one| one.kind == ObstacleKind::Building);
    own.map(|one| one.shape.bounds_in_world().1.z).collect()
}

fn house(id: i64, height: &str) -> String {
    way(id, &RING, &[("building", "yes"), ("height", height)])
}

const BOUNDS: &str = "<bounds minlat=\"-0.002\" minlon=\"-0.002\" maxlat=\"0.002\" maxlon=\"0.002\"/>";

#[test]
fn areas_of_several_downloads_count_together() {
    let nodes = [&SQUARE[..], &[(11, -19, -9), (12, 19, -9)]].concat();
    let street = [("highway", "residential"), ("sidewalk", "both")];
    let text = osm(&nodes, &(house(8, "5") + &way(9, &[11, 12], &street)));
    let one = read(text.as_bytes()).unwrap().0;
    let half = |from: &str, to: &str| {
        format!("<bounds minlat=\"-0.002\" minlon=\"{from}\" maxlat=\"0.002\" maxlon=\"{to}\" origin=\"x\"/>")
    };
    for areas in [
        half("-0.002", "0.0001") + &half("0.0001", "0.002"),
        half("0.0001", "0.002") + &half("-0.002", "0.0001"),
        half("-0.002", "-0.0015") + &half("0.0015", "0.002") + &half("-0.0015", "0.0015"),
        // A part in which there is nothing, and an area of another place.
        half("-0.0018", "0.002")
            + &half("-0.002", "-0.0018")
            + "<bounds minlat=\"50\" minlon=\"8\" maxlat=\"50.1\" maxlon=\"8.1\"/>",
        "<bound box=\"-0.002,-0.002,0.002,0.002\" origin=\"osmosis\"/>".to_owned(),
    ] {
        let (town, warnings) = read(text.replace(BOUNDS, &areas).as_bytes()).unwrap();
        assert_eq!(town, one, "{areas}");
        assert_eq!(warnings, Vec::<String>::new());
    }
    // Two downloads with a gap between them: both keep their things, and so does the gap.
    let apart = half("-0.002", "-0.001") + &half("0.001", "0.002");
    assert_eq!(read(text.replace(BOUNDS, &apart).as_bytes()).unwrap().0, one);
    let far =
        text.replace("lon=\"0.0019\"", "lon=\"7\"").replace(BOUNDS, &(half("-0.002", "0.002") + &half("6.9", "7.1")));
    let error = read(far.as_bytes()).unwrap_err();
    assert!(error.message.contains("degrees across") && error.hints[0].contains("states 2 areas"), "{error:?}");
}

#[test]
fn bounds_that_are_no_area_or_hold_nothing_are_told_of() {
    let nodes = [(11, -18, 0), (12, 18, 0)];
    let street = osm(&nodes, &way(1, &[11, 12], &[("highway", "residential")]));
    let warned = |bounds: &str| {
        let text = street.replacen(BOUNDS, bounds, 1);
        let (_, warnings) = read(text.as_bytes()).unwrap();
        warnings.iter().any(|warning| warning.starts_with("1 bounds of the file are no area"))
    };
    let stated = |south: &str, north: &str| {
        format!("<bounds minlat=\"{south}\" minlon=\"-0.01\" maxlat=\"{north}\" maxlon=\"0.01\"/>")
    };
    assert!(!warned("") && !warned(&stated("-0.01", "0.01")));
    for (south, north) in [("0.01", "-0.01"), ("nan", "0.01"), ("948", "950"), ("", "0.01"), ("10", "10.1")] {
        assert!(warned(&stated(south, north)), "{south} to {north}");
    }
}

#[test]
fn of_elements_that_are_there_again_the_highest_version_counts() {
    let versioned = |text: String, version: &str| text.replacen("<way ", &format!("<way version=\"{version}\" "), 1);
    let (first, second) = (versioned(house(8, "5"), "1"), versioned(house(8, "12"), "2"));
    for rest in [first.clone() + &second, second.clone() + &first, first.clone() + &first + &second + &second] {
        let (town, warnings) = read(osm(&SQUARE, &rest).as_bytes()).unwrap();
        assert_eq!(tops_m(&town), [12.0]);
        assert!(warnings[0].contains("more than once") && warnings[0].contains("way 8"), "{warnings:?}");
    }
    // The same again is nothing to speak of; without versions the first one counts.
    let (town, warnings) = read(osm(&SQUARE, &(second.clone() + &second)).as_bytes()).unwrap();
    assert_eq!((tops_m(&town), warnings), (vec![12.0], Vec::new()));
    let (town, warnings) = read(osm(&SQUARE, &(house(8, "7") + &house(8, "9"))).as_bytes()).unwrap();
    assert_eq!((tops_m(&town), warnings.len()), (vec![7.0], 1));
    // So do a node with other tags, and a key with another value.
    let lamp = |tag: &str| format!("<node id=\"20\" lat=\"0.0015\" lon=\"0.001\">{tag}</node>");
    let (bare, tagged) = (lamp(""), lamp("<tag k=\"highway\" v=\"street_lamp\"/>"));
    for (rest, count) in [(tagged.clone() + &bare, 1), (bare.clone() + &tagged, 0), (tagged.clone() + &tagged, 1)] {
        let (town, warnings) = read(osm(&SQUARE, &(house(8, "5") + &rest)).as_bytes()).unwrap();
        assert_eq!(town.obstacles.iter().filter(|one| one.kind == ObstacleKind::Lamp).count(), count);
        let is_told = warnings.iter().any(|warning| warning.contains("more than once") && warning.contains("node 20"));
        assert_eq!(is_told, rest.contains(&bare), "{warnings:?}");
    }
    let bench = lamp("<tag k=\"amenity\" v=\"bench\"/><tag k=\"direction\" v=\"E\"/>");
    let (town, _) = read(osm(&SQUARE, &(house(8, "5") + &bench)).as_bytes()).unwrap();
    let bench = town.obstacles.iter().find(|one| one.kind == ObstacleKind::Bench).expect("a bench stands there");
    let (sin, cos) = real::sin_cos(bench.shape.yaw_rad);
    assert!((sin - 1.0).abs() < 1e-9 && cos.abs() < 1e-9, "its back, towards its second axis, is in the west");
    let twice = house(8, "5").replace("</way>", "<tag k=\"height\" v=\"9\"/></way>");
    let (town, warnings) = read(osm(&SQUARE, &twice).as_bytes()).unwrap();
    assert_eq!(
        (tops_m(&town), warnings),
        (vec![5.0], vec!["1 elements state a key twice; the first value counts (way 8)".to_owned()])
    );
    // A node that moved takes its tags along.
    let tree = |version: u8, lon: &str, tag: &str| {
        format!("<node id=\"20\" version=\"{version}\" lat=\"0.0015\" lon=\"{lon}\">{tag}</node>")
    };
    let (old, new) = (tree(1, "0.001", "<tag k=\"natural\" v=\"tree\"/>"), tree(2, "-0.001", ""));
    for rest in [old.clone() + &new, new + &old] {
        let (town, _) = read(osm(&SQUARE, &(house(8, "5") + &rest)).as_bytes()).unwrap();
        assert!(town.obstacles.iter().all(|one| one.kind == ObstacleKind::Building));
    }
}

#[test]
fn what_is_deleted_is_gone_in_whatever_order() {
    let other = way(9, &[1, 3], &[("highway", "footway")]);
    let of_version =
        |version: u8, more: &str| house(8, "5").replacen("<way ", &format!("<way version=\"{version}\" {more} "), 1);
    let gone = ["visible=\"false\"", "visible=\"true\" action=\"delete\""];
    for gone in gone {
        let (alive, dead, back) = (of_version(1, ""), of_version(2, gone), of_version(4, "visible=\"true\""));
        for (rest, count) in [
            (alive.clone() + &dead, 0),
            (dead.clone() + &alive, 0),
            (dead.clone(), 0),
            (dead.clone() + &back + &alive, 1),
            (back + &dead, 1),
        ] {
            let (town, _) = read(osm(&SQUARE, &(rest + &other)).as_bytes()).unwrap();
            assert_eq!(town.obstacles.len(), count, "{gone}");
        }
    }
    // The same of packed nodes: node 3 was deleted, so that the path lacks it.
    let dense = DenseNodes {
        ids: vec![1, 1, 1, 0],
        info: Some(DenseInfo { versions: vec![1, 1, 1, 2], visibles: vec![true, true, true, false] }),
        lats: vec![0, 0, 4000, 0],
        lons: vec![0, 8000, 0, 0],
        keys_and_values: vec![],
    };
    let strings = ["", "highway", "footway"].map(|text| text.as_bytes().to_vec()).to_vec();
    let path =
        super::pbf::PackedWay { id: 7, keys: vec![1], values: vec![2], nodes: vec![1, 1, 1], ..Default::default() };
    let group = PrimitiveGroup { dense: Some(dense), ways: vec![path], ..PrimitiveGroup::default() };
    let block = PrimitiveBlock { strings: Some(StringTable { strings }), groups: vec![group], ..Default::default() };
    let file = [blob("OSMHeader", &raw(&[])), blob("OSMData", &raw(&block.encode_to_vec()))].concat();
    let (town, warnings) = read(&file).unwrap();
    assert_eq!(town.walkable.len(), 1);
    assert!(warnings.iter().any(|line| line.contains("1 ways lack nodes")), "{warnings:?}");
}

#[test]
fn ways_may_come_before_their_nodes() {
    let text = osm(&SQUARE, &house(8, "5"));
    let turned = text.replace(&house(8, "5"), "").replace(BOUNDS, &(house(8, "5") + BOUNDS));
    assert_eq!(read(turned.as_bytes()).unwrap(), read(text.as_bytes()).unwrap());
}

#[test]
fn a_member_that_is_listed_twice_counts_once() {
    let member = |id: i64, role: &str| format!("<member type=\"way\" ref=\"{id}\" role=\"{role}\"/>");
    let relation = |members: &[String]| {
        format!(
            "<relation id=\"20\">{}<tag k=\"type\" v=\"multipolygon\"/><tag k=\"building\" v=\"yes\"/></relation>",
            members.concat()
        )
    };
    let ways = way(10, &[1, 2, 3], &[]) + &way(11, &[3, 4, 1], &[]);
    let once = read(osm(&SQUARE, &(ways.clone() + &relation(&[member(10, "outer"), member(11, "outer")]))).as_bytes())
        .unwrap();
    assert_eq!(once.0.obstacles.len(), 1);
    let twice = relation(&[member(10, "outer"), member(10, "outer"), member(11, "outer"), member(11, "outer")]);
    assert_eq!(read(osm(&SQUARE, &(ways + &twice)).as_bytes()).unwrap(), once);
}

#[test]
fn a_building_that_does_not_close_is_told_of_and_one_that_ends_at_a_twin_of_its_node_closes() {
    let nodes = [&SQUARE[..], &[(5, 0, 0)]].concat();
    let line = |nodes: &[i64]| way(8, nodes, &[("building", "yes"), ("height", "6")]);
    let (town, warnings) = read(osm(&nodes, &line(&[1, 2, 3, 4, 5])).as_bytes()).unwrap();
    assert_eq!((tops_m(&town), warnings), (vec![6.0], Vec::new()));
    let (town, warnings) =
        read(osm(&nodes, &(line(&[1, 2, 3, 4]) + &way(9, &[1, 3], &[("highway", "footway")]))).as_bytes()).unwrap();
    assert!(town.obstacles.is_empty());
    assert!(warnings[0].starts_with("1 buildings do not close") && warnings[0].contains("way 8"), "{warnings:?}");
    let error = read(osm(&SQUARE, "<way id=\"4\"><nd/></way>").as_bytes()).unwrap_err();
    assert!(error.message.contains("`<nd>` of way 4 has no `ref`"), "{error}");
}

#[test]
fn barriers_begin_where_they_are_said_to_and_nothing_from_a_roof_stands_on_the_ground() {
    let fence = |tags: &[(&str, &str)]| {
        let tags = [&[("barrier", "fence")], tags].concat();
        let nodes = [&SQUARE[..], &[(11, -9, -9), (12, 9, -9)]].concat();
        let rest = way(8, &[1, 2], &tags) + &way(9, &[11, 12], &[("highway", "footway")]);
        let (town, warnings) = read(osm(&nodes, &rest).as_bytes()).unwrap();
        let spans: Vec<(f64, f64)> = town
            .obstacles
            .iter()
            .map(|one| one.shape.bounds_in_world())
            .map(|(low, high)| ((low.z * 1e6).round() / 1e6, (high.z * 1e6).round() / 1e6))
            .collect();
        (spans, warnings)
    };
    for (tags, span) in [
        (&[("height", "35"), ("min_height", "34")][..], (34.0, 35.0)),
        (&[("min_height", "34")], (34.0, 35.5)),
        (&[("height", "1.2"), ("min_height", "34")], (34.0, 35.5)),
        (&[("height", "2")], (0.0, 2.0)),
        (&[("min_level", "3"), ("height", "12")], (9.0, 12.0)),
        (&[("building:min_level", "3")], (9.0, 10.5)),
        (&[("level", "4"), ("min_height", "12")], (12.0, 13.5)),
        (&[("layer", "1")], (0.0, 1.5)),
        (&[("level", "0;1")], (0.0, 1.5)),
    ] {
        let (spans, warnings) = fence(tags);
        assert_eq!(spans, [span], "{tags:?}");
        let is_told = tags[0] == ("height", "1.2");
        assert_eq!(warnings.len(), usize::from(is_told), "{tags:?}: {warnings:?}");
    }
    let (spans, warnings) = fence(&[("height", "1e23"), ("min_height", "-3")]);
    assert_eq!(spans, [(0.0, 1.5)]);
    assert!(warnings[0].contains("`height` that is no length of 0.2 to 300 m, such as `1e23`"), "{warnings:?}");
    assert!(warnings[1].contains("`min_height` that is no length of 0 to 1000 m, such as `-3`"), "{warnings:?}");
    for tags in [("location", "roof"), ("location", "rooftop"), ("level", "2"), ("level", "3-5")] {
        let (spans, warnings) = fence(&[tags]);
        assert!(spans.is_empty(), "{tags:?}");
        assert!(warnings[0].starts_with("1 things stand on roofs") && warnings[0].contains("way 8"), "{warnings:?}");
    }
    for tags in [("location", "underground"), ("level", "-1"), ("layer", "-2"), ("indoor", "yes")] {
        assert_eq!(fence(&[tags]), (Vec::new(), Vec::new()), "{tags:?}");
    }
}

/// Kinds of the ground at a place of the file, ten-thousandths of a degree east and north.
fn ground_at(town: &Town, (x, y): (f64, f64)) -> Vec<WalkableKind> {
    let at = DVec2::new(11.132 * x, -11.0574 * y);
    town.walkable.iter().filter(|area| contains(&area.plan(), at)).map(|area| area.kind).collect()
}

#[test]
fn paths_cross_streets_or_end_at_their_kerbs() {
    // A street from west to east, 10 m wide: half a unit of the file is 5.5 m.
    let nodes = [
        (11, -18, 0),
        (12, 18, 0),
        (20, -10, 0),
        (21, -10, 9),
        (30, 0, 0),
        (31, 0, 9),
        (32, 0, -9),
        (40, 10, 0),
        (41, 10, 9),
        (42, 10, -9),
    ];
    let street = way(1, &[11, 20, 30, 40, 12], &[("highway", "residential"), ("width", "10")]);
    let ends = way(2, &[21, 20], &[("highway", "footway")]);
    let leads_over = way(3, &[31, 30, 32], &[("highway", "pedestrian")]);
    let in_two = way(4, &[41, 40], &[("highway", "footway")]) + &way(5, &[40, 42], &[("highway", "footway")]);
    let (town, _) = read(osm(&nodes, &(street.clone() + &ends + &leads_over + &in_two)).as_bytes()).unwrap();
    assert_eq!(ground_at(&town, (-10.0, 0.2)), [], "the path ends at the kerb");
    assert_eq!(ground_at(&town, (-10.0, 0.6)), [WalkableKind::Sidewalk]);
    assert_eq!(ground_at(&town, (-10.0, -0.6)), []);
    assert_eq!(ground_at(&town, (0.0, 0.1)), [WalkableKind::Crossing], "the street is not cut");
    assert_eq!(ground_at(&town, (0.0, 0.7)), [WalkableKind::Plaza]);
    assert_eq!(ground_at(&town, (10.0, 0.1)), [WalkableKind::Crossing], "two paths that meet on the street");
    assert_eq!(ground_at(&town, (10.0, -0.1)), [WalkableKind::Crossing]);
    // A crossing that the file states leads to the other side.
    let stated = osm(&nodes, &(street + &ends)).replace(
        "<node id=\"20\" lon=\"-0.0010\" lat=\"0.0000\"/>",
        "<node id=\"20\" lon=\"-0.0010\" lat=\"0.0000\"><tag k=\"highway\" v=\"crossing\"/></node>",
    );
    let (town, _) = read(stated.as_bytes()).unwrap();
    for y in [0.3, -0.3, -0.5] {
        assert!(ground_at(&town, (-10.0, y)).contains(&WalkableKind::Crossing), "{y}");
    }
}

#[test]
fn areas_for_people_are_cut_by_carriageways_and_joined_by_crossings() {
    // A square of 220 m by 130 m; a street, 10 m wide, leads through its middle from west to east.
    let nodes = [(11, -18, 0), (12, 18, 0), (21, -10, -6), (22, 10, -6), (23, 10, 6), (24, -10, 6)];
    let square = |tags: &[(&str, &str)]| way(2, &[21, 22, 23, 24, 21], tags);
    let street = |class: &str| way(1, &[11, 12], &[("highway", class), ("width", "10")]);
    let plaza = square(&[("highway", "pedestrian"), ("area", "yes")]);
    let (town, _) = read(osm(&nodes, &(street("residential") + &plaza)).as_bytes()).unwrap();
    for x in [-9.0, -5.0, 5.0, 9.0] {
        assert_eq!(ground_at(&town, (x, 0.2)), [], "{x}: the carriageway");
        assert_eq!(ground_at(&town, (x, 0.6)), [WalkableKind::Plaza], "{x}: north of it");
        assert_eq!(ground_at(&town, (x, -5.0)), [WalkableKind::Plaza], "{x}: south of it");
    }
    assert_eq!(ground_at(&town, (0.0, 0.1)), [WalkableKind::Crossing], "people cross in the middle");
    let area_m2: f64 = town
        .walkable
        .iter()
        .filter(|one| one.kind == WalkableKind::Plaza)
        .map(|one| 0.5 * cosfly_town::polygons::twice_area_m2(&one.plan()).abs())
        .sum();
    assert!((area_m2 - 222.6 * (132.7 - 10.0)).abs() < 40.0, "{area_m2}");
    assert!(town.synthetic.notes.iter().any(|note| note.starts_with("1 areas for people are cut")));
    // A street that people share, an area that crosses the street, and an island in it stay whole.
    for (class, tags) in [
        ("living_street", &[("highway", "pedestrian"), ("area", "yes")][..]),
        ("residential", &[("area:highway", "crossing")]),
        ("residential", &[("area:highway", "traffic_island")]),
    ] {
        let (town, _) = read(osm(&nodes, &(street(class) + &square(tags))).as_bytes()).unwrap();
        assert!(!ground_at(&town, (5.0, 0.2)).is_empty(), "{class} {tags:?}");
        assert!(!town.synthetic.notes.iter().any(|note| note.contains("are cut where")));
    }
}

#[test]
fn streets_that_forbid_walking_and_the_sides_between_carriageways_get_no_invented_pavement() {
    let nodes = [(11, -18, 0), (12, 18, 0), (21, -18, 1), (22, 18, 1), (31, -18, 9), (32, 18, 9)];
    let one = [("highway", "secondary"), ("oneway", "yes"), ("width", "6")];
    let pair = way(1, &[11, 12], &one) + &way(2, &[22, 21], &one);
    let (town, _) = read(osm(&nodes, &pair).as_bytes()).unwrap();
    let pavements = town.walkable.iter().filter(|area| area.kind == WalkableKind::Sidewalk).count();
    assert_eq!(pavements, 2, "on the outer sides");
    assert_eq!(ground_at(&town, (0.0, 0.5)), []);
    let forbidden = way(3, &[31, 32], &[("highway", "secondary"), ("foot", "no")]);
    let (town, _) = read(osm(&nodes, &(pair + &forbidden)).as_bytes()).unwrap();
    assert_eq!(town.walkable.iter().filter(|area| area.kind == WalkableKind::Sidewalk).count(), pavements);
    // An alley of two one-way streets far apart has both.
    let lone = way(1, &[11, 12], &one) + &way(2, &[32, 31], &one);
    let (town, _) = read(osm(&nodes, &lone).as_bytes()).unwrap();
    assert_eq!(town.walkable.iter().filter(|area| area.kind == WalkableKind::Sidewalk).count(), 4);
}

fn refused(bytes: &[u8], expected: &str) {
    let error = read(bytes).unwrap_err().to_string();
    assert!(error.contains(expected), "{error}");
}

#[test]
fn packed_files_that_unpack_to_far_more_than_maps_do_are_refused() {
    let header = blob("OSMHeader", &raw(&[]));
    let data = |content: &[u8]| [&header[..], &blob("OSMData", &zlib(content))].concat();
    // Empty groups, and empty ways in one group: two bytes each in the file.
    refused(&data(&[0x12, 0].repeat(8_000_000)), "lists more than");
    let group = [0x1a, 0].repeat(2_000_000);
    let mut block = vec![0x12];
    prost::encoding::encode_varint(group.len() as u64, &mut block);
    refused(&data(&[block, group].concat()), "lists more than");
    let dense = DenseNodes {
        ids: vec![1; 5_000_000],
        lats: vec![0; 5_000_000],
        lons: vec![0; 5_000_000],
        ..DenseNodes::default()
    };
    let group = PrimitiveGroup { dense: Some(dense), ..PrimitiveGroup::default() };
    let block = PrimitiveBlock { groups: vec![group], ..PrimitiveBlock::default() };
    refused(&data(&block.encode_to_vec()), "more than a file of its size can have");
    let many = blob("OSMData", &zlib(&vec![0x80; 30 << 20]));
    assert!(read(&[&header[..], &many.repeat(12)].concat()).is_err());
    // Text: the same element again and again, and elements that nobody knows.
    let nodes = b"<node id=\"1\" lat=\"1\" lon=\"1\"/>".repeat(4_000_000);
    refused(&gzip(&[b"<osm>", &nodes[..], b"</osm>"].concat()), "more than a file of its size can have");
    let unknown = gzip(&b"<x y=\"zzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzz\"/>".repeat(500_000));
    refused(&[gzip(b"<osm>"), unknown.repeat(16)].concat(), "unpacks to more than");
}

#[test]
fn entities_of_a_file_are_not_expanded() {
    let bomb = "<!DOCTYPE osm [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">]>";
    let text = osm(&SQUARE, &way(8, &RING, &[("building", "&b;")]));
    refused((bomb.to_owned() + &text).as_bytes(), "attribute `v` is not readable");
    refused("<osm/><osm/>".as_bytes(), "a second `<osm>`");
}

#[test]
fn numbers_that_are_not_believed_are_told_of_with_what_is_taken() {
    let nodes = [(11, -18, 0), (12, 18, 0), (21, -18, 5), (22, 18, 5), (31, 5, -9)];
    let read_street = |tags: &[(&str, &str)]| {
        let street = [&[("highway", "residential"), ("sidewalk", "both")], tags].concat();
        let rest = way(1, &[11, 12], &street) + &way(2, &[21, 22], &[("highway", "footway")]);
        read(osm(&nodes, &rest).as_bytes()).unwrap()
    };
    let (plain, none) = read_street(&[]);
    assert_eq!(none, Vec::<String>::new());
    for (key, value, told) in [
        ("width", "wide", "is no length of 2 to 60 m, such as `wide`; their lanes, of the usual width, make"),
        ("width", "0.5", "is no length of 2 to 60 m, such as `0.5`"),
        ("width", "", "is no length of 2 to 60 m, such as ``"),
        ("lanes", "many", "is no number of 1 to 12, such as `many`; they have the usual number of their kind"),
        ("lanes", "0", "is no number of 1 to 12, such as `0`"),
        ("lanes:forward", "-1", "is no number of 1 to 8, such as `-1`; half of all lanes lead there"),
        ("lanes:backward", "99", "is no number of 1 to 8, such as `99`; the other lanes lead there"),
        ("maxspeed", "fast", "is no speed of 1 to 100 m/s, such as `fast`; the usual limit counts"),
        ("maxspeed", "999", "is no speed of 1 to 100 m/s, such as `999`"),
        ("layer", "up", "is no number, such as `up`; it counts as missing"),
        ("level", "ground", "is no number, such as `ground`; it counts as missing"),
    ] {
        let (town, warnings) = read_street(&[(key, value)]);
        assert!(town == plain, "{key}={value}: the usual value is taken");
        let line = format!(" state a `{key}` that {told}");
        assert!(warnings.len() == 1 && warnings[0].contains(&line), "{key}={value}: {warnings:?}");
        assert!(warnings[0].starts_with("1 ") && warnings[0].ends_with("(way 1)"), "{warnings:?}");
    }
    for (tags, told) in [
        (
            [("lanes", "3"), ("lanes:forward", "4")],
            "`lanes:forward` that is no number below that of all lanes, such as `4`",
        ),
        ([("lanes", "2"), ("lanes:backward", "3")], "`lanes:backward` that is no number that all lanes leave room for"),
    ] {
        let (_, warnings) = read_street(&tags);
        assert!(warnings.len() == 1 && warnings[0].contains(told), "{warnings:?}");
    }
    assert_eq!(read_street(&[("lanes", "3"), ("lanes:forward", "2"), ("lanes:backward", "1")]).1, none);
    let (_, warnings) = read_street(&[("lanes", "10")]);
    assert!(warnings.len() == 1 && warnings[0].contains("is no number of 1 to 8, such as `10`; as many as fit"));
    for (key, value) in
        [("width", "7"), ("lanes", "2"), ("maxspeed", "DE:urban"), ("maxspeed", "none"), ("level", "0;1")]
    {
        assert_eq!(read_street(&[(key, value)]).1, none, "{key}={value}");
    }
    let path = |width: &str| way(2, &[21, 22], &[("highway", "footway"), ("width", width)]);
    let (_, warnings) =
        read(osm(&nodes, &(path("900") + &path("900").replace("id=\"2\"", "id=\"3\""))).as_bytes()).unwrap();
    let line = "2 paths state a `width` that is no length of 1.2 to 30 m, such as `900`; they have the usual width of their \
                kind (way 2, way 3)";
    assert_eq!(warnings, [line]);
    let tree = "<node id=\"40\" lat=\"0.0015\" lon=\"0.001\"><tag k=\"natural\" v=\"tree\"/>\
                <tag k=\"height\" v=\"0.5\"/><tag k=\"diameter_crown\" v=\"99\"/></node>";
    let row = way(4, &[11, 12], &[("natural", "tree_row"), ("height", "300")]);
    let (_, warnings) = read(osm(&nodes, &(path("2") + tree + &row)).as_bytes()).unwrap();
    let [crown, height] = &warnings[..] else { panic!("{warnings:?}") };
    assert!(
        crown.contains("`diameter_crown` that is no length of 0.5 to 30 m, such as `99`")
            && crown.contains("(node 40)")
    );
    assert!(height.contains("`height` that is no length of 1 to 80 m") && height.contains("(node 40, way 4)"));
}
