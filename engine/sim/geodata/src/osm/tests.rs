//! Whole files: one content in three containers, hostile files, rules that need a town.

use super::pbf::{
    self, Blob, BlobHeader, DenseNodes, HeaderBlock, HeaderBounds, PackedRelation, PackedWay, PrimitiveBlock,
};
use super::pbf::{PrimitiveGroup, StringTable};
use super::{OpenStreetMap, OsmOptions};
use cosfly_domain::{ObstacleKind, SemanticLabel, Town, WalkableKind};
use cosfly_frames::{DVec2, Seed};
use cosfly_town::polygons::contains;
use cosfly_town::{MapError, MapFormat};
use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use prost::Message;
use std::collections::BTreeMap;
use std::io::Write;

pub(super) fn read(bytes: &[u8]) -> Result<(Town, Vec<String>), MapError> {
    let (mut town, warnings) = OpenStreetMap::read(bytes, &OsmOptions::default())?;
    town.update_bounds();
    town.assert_well_formed().expect("a town that was read is well formed");
    Ok((town, warnings))
}

/// A file of some elements around (0, 0) degrees; nodes are given in ten-thousandths of a degree, about 11 m.
pub(super) fn osm(nodes: &[(i64, i32, i32)], rest: &str) -> String {
    let place = |value: i32| f64::from(value) * 1e-4;
    let nodes: String = nodes
        .iter()
        .map(|(id, x, y)| format!("<node id=\"{id}\" lon=\"{:.4}\" lat=\"{:.4}\"/>\n", place(*x), place(*y)))
        .collect();
    let bounds = "<bounds minlat=\"-0.002\" minlon=\"-0.002\" maxlat=\"0.002\" maxlon=\"0.002\"/>";
    format!("<osm version=\"0.6\">{bounds}\n{nodes}{rest}</osm>")
}

pub(super) fn way(id: i64, nodes: &[i64], tags: &[(&str, &str)]) -> String {
    let nodes: String = nodes.iter().map(|node| format!("<nd ref=\"{node}\"/>")).collect();
    let tags: String = tags.iter().map(|(key, value)| format!("<tag k=\"{key}\" v=\"{value}\"/>")).collect();
    format!("<way id=\"{id}\">{nodes}{tags}</way>\n")
}

const SQUARE: [(i64, i32, i32); 4] = [(1, 0, 0), (2, 2, 0), (3, 2, 2), (4, 0, 2)];
pub(super) const RING: [i64; 5] = [1, 2, 3, 4, 1];

/// The example as PBF, through the reader's own elements.
fn example_as_pbf(pack: impl Fn(&[u8]) -> Blob) -> Vec<u8> {
    let text = core::str::from_utf8(OpenStreetMap::EXAMPLE).unwrap();
    let document = roxmltree::Document::parse(text).unwrap();
    let mut strings = vec![Vec::new()];
    let mut numbers = BTreeMap::new();
    let mut number = |text: &str| {
        *numbers.entry(text.to_owned()).or_insert_with(|| {
            strings.push(text.as_bytes().to_vec());
            strings.len() as u32 - 1
        })
    };
    let id = |node: roxmltree::Node<'_, '_>, name: &str| node.attribute(name).unwrap().parse::<i64>().unwrap();
    let nano = |node: roxmltree::Node<'_, '_>, name: &str| {
        (node.attribute(name).unwrap().parse::<f64>().unwrap() * 1e7).round() as i64
    };
    let children = |node: roxmltree::Node<'_, '_>, name: &'static str| {
        node.children().filter(move |child| child.has_tag_name(name)).map(|child| child.id()).collect::<Vec<_>>()
    };
    let differences = |values: &[i64]| -> Vec<i64> {
        values.iter().enumerate().map(|(i, value)| if i == 0 { *value } else { value - values[i - 1] }).collect()
    };
    let root = document.root_element();
    let mut dense = DenseNodes::default();
    let (mut ids, mut lats, mut lons) = (vec![], vec![], vec![]);
    let mut group = PrimitiveGroup::default();
    let mut header = HeaderBlock { required_features: vec!["OsmSchema-V0.6".into()], ..HeaderBlock::default() };
    for element in root.children().filter(roxmltree::Node::is_element) {
        let mut keys_and_values = vec![];
        for tag in children(element, "tag") {
            let tag = document.get_node(tag).unwrap();
            keys_and_values.push((number(tag.attribute("k").unwrap()), number(tag.attribute("v").unwrap())));
        }
        let (keys, values): (Vec<u32>, Vec<u32>) = keys_and_values.into_iter().unzip();
        match element.tag_name().name() {
            "bounds" => {
                let nano = |name: &str| 100 * nano(element, name);
                let (left, right) = (nano("minlon"), nano("maxlon"));
                header.bounds = Some(HeaderBounds { left, right, top: nano("maxlat"), bottom: nano("minlat") });
            }
            "node" => {
                ids.push(id(element, "id"));
                lats.push(nano(element, "lat"));
                lons.push(nano(element, "lon"));
                let both = keys.iter().zip(&values).flat_map(|(key, value)| [*key as i32, *value as i32]);
                dense.keys_and_values.extend(both.chain([0]));
            }
            "way" => {
                let nodes: Vec<i64> =
                    children(element, "nd").iter().map(|nd| id(document.get_node(*nd).unwrap(), "ref")).collect();
                let nodes = differences(&nodes);
                group.ways.push(PackedWay { id: id(element, "id"), keys, values, nodes, ..PackedWay::default() });
            }
            _ => {
                let members: Vec<_> =
                    children(element, "member").iter().map(|member| document.get_node(*member).unwrap()).collect();
                let ids: Vec<i64> = members.iter().map(|member| id(*member, "ref")).collect();
                let roles = members.iter().map(|member| number(member.attribute("role").unwrap()) as i32).collect();
                let kinds = members.iter().map(|_| 1).collect();
                let id = id(element, "id");
                let members = differences(&ids);
                let relation = PackedRelation { id, keys, values, roles, members, kinds, ..PackedRelation::default() };
                group.relations.push(relation);
            }
        }
    }
    (dense.ids, dense.lats, dense.lons) = (differences(&ids), differences(&lats), differences(&lons));
    let nodes = PrimitiveGroup { dense: Some(dense), ..PrimitiveGroup::default() };
    let block =
        PrimitiveBlock { strings: Some(StringTable { strings }), groups: vec![nodes, group], ..Default::default() };
    [blob("OSMHeader", &pack(&header.encode_to_vec())), blob("OSMData", &pack(&block.encode_to_vec()))].concat()
}

pub(super) fn blob(kind: &str, blob: &Blob) -> Vec<u8> {
    let content = blob.encode_to_vec();
    let header = BlobHeader { kind: kind.into(), size: content.len() as i32 }.encode_to_vec();
    [&(header.len() as u32).to_be_bytes()[..], &header, &content].concat()
}

pub(super) fn raw(content: &[u8]) -> Blob {
    Blob { raw: Some(content.to_vec()), zlib: None }
}

pub(super) fn zlib(content: &[u8]) -> Blob {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::best());
    packer.write_all(content).unwrap();
    Blob { raw: None, zlib: Some(packer.finish().unwrap()) }
}

pub(super) fn gzip(content: &[u8]) -> Vec<u8> {
    let mut packer = GzEncoder::new(Vec::new(), Compression::best());
    packer.write_all(content).unwrap();
    packer.finish().unwrap()
}

#[test]
fn one_content_gives_one_town_in_every_container() {
    let (town, warnings) = read(OpenStreetMap::EXAMPLE).unwrap();
    assert_eq!(warnings, Vec::<String>::new());
    for (name, bytes) in
        [("gzip", gzip(OpenStreetMap::EXAMPLE)), ("raw", example_as_pbf(raw)), ("zlib", example_as_pbf(zlib))]
    {
        assert!(OpenStreetMap::recognises(&bytes[..bytes.len().min(600)]), "{name}");
        assert_eq!(read(&bytes).unwrap().0, town, "{name}");
    }
}

#[test]
fn the_example_has_every_kind_of_thing() {
    let (town, _) = read(OpenStreetMap::EXAMPLE).unwrap();
    let has = |kind| town.obstacles.iter().any(|one| one.kind == kind);
    for kind in [
        ObstacleKind::Building,
        ObstacleKind::TreeTrunk,
        ObstacleKind::TreeCrown,
        ObstacleKind::Lamp,
        ObstacleKind::Pole,
        ObstacleKind::Wall,
        ObstacleKind::Bush,
    ] {
        assert!(has(kind), "{kind:?}");
    }
    for kind in [WalkableKind::Sidewalk, WalkableKind::Crossing, WalkableKind::Plaza] {
        assert!(town.walkable.iter().any(|area| area.kind == kind), "{kind:?}");
    }
    // Three houses, a block around a yard, a tower of two parts.
    let mut houses: Vec<u32> =
        town.obstacles.iter().filter(|one| one.kind == ObstacleKind::Building).map(|one| one.object_id).collect();
    houses.dedup();
    assert_eq!(houses.len(), 5);
    let tops = |id: u32| {
        let own = town.obstacles.iter().filter(|one| one.object_id == id && one.kind == ObstacleKind::Building);
        own.map(|one| one.shape.bounds_in_world().1.z).fold(0.0, f64::max)
    };
    let mut found: Vec<f64> = houses.iter().map(|id| (tops(*id) * 100.0).round() / 100.0).collect();
    found.sort_by(f64::total_cmp);
    assert_eq!(found, [3.0, 9.0, 15.0, 16.2, 40.0]);
}

#[test]
fn missing_nodes_are_counted_and_whole_pieces_kept() {
    let nodes = [&SQUARE[..], &[(11, -9, -9), (12, -5, -9), (14, 5, -9), (15, 9, -9)]].concat();
    let rest = way(7, &[1, 2, 99, 4, 1], &[("building", "yes")])
        + &way(8, &RING, &[("building", "yes"), ("height", "5")])
        + &way(9, &[11, 12, 13, 14, 15], &[("highway", "footway")]);
    let (town, warnings) = read(osm(&nodes, &rest).as_bytes()).unwrap();
    assert_eq!(town.obstacles.len(), 1);
    assert_eq!(town.walkable.len(), 2, "two pieces on both sides of the missing node");
    assert!(
        warnings[0].starts_with("2 ways lack nodes in the file") && warnings[0].contains("way 7, way 9"),
        "{warnings:?}"
    );
    assert!(warnings[1].starts_with("1 areas lack nodes") && warnings[1].contains("way 7"), "{warnings:?}");
}

#[test]
fn a_file_without_paths_gets_pavements_and_one_without_streets_open_ground() {
    let house = way(8, &RING, &[("building", "yes")]);
    let street = way(9, &[11, 12], &[("highway", "residential")]);
    let ends = [&SQUARE[..], &[(11, -9, -9), (12, 9, -9)]].concat();
    let (town, _) = read(osm(&ends, &(house.clone() + &street)).as_bytes()).unwrap();
    assert_eq!(town.walkable.iter().filter(|area| area.synthetic && area.kind == WalkableKind::Sidewalk).count(), 2);
    let (town, _) = read(osm(&SQUARE, &house).as_bytes()).unwrap();
    assert!(!town.walkable.is_empty());
    assert!(town.walkable.iter().all(|area| area.synthetic && area.kind == WalkableKind::Plaza));
    assert!(town.synthetic.notes.iter().any(|note| note.contains("open ground around the buildings")));
}

#[test]
fn parts_replace_the_outline_that_they_fill_and_not_one_that_they_do_not() {
    let heights = |part: &[i64], extra: &[(i64, i32, i32)]| {
        let nodes = [&SQUARE[..], extra].concat();
        let rest = way(8, &RING, &[("building", "yes"), ("height", "30")])
            + &way(9, part, &[("building:part", "yes"), ("height", "12")]);
        let (town, _) = read(osm(&nodes, &rest).as_bytes()).unwrap();
        let tops: Vec<f64> = town.obstacles.iter().map(|one| one.shape.bounds_in_world().1.z).collect();
        assert!(town.obstacles.iter().all(|one| one.object_id == town.obstacles[0].object_id));
        tops
    };
    assert_eq!(heights(&RING, &[]), [12.0]);
    assert_eq!(heights(&[1, 5, 4, 1], &[(5, 1, 1)]).iter().copied().fold(0.0, f64::max), 30.0);
}

#[test]
fn pavements_go_on_over_side_streets_and_round_corners() {
    let ends = [(11, -9, 0), (12, 9, 0), (13, 0, -9), (14, 0, 9), (15, 0, 0)];
    let both = [("highway", "residential"), ("sidewalk", "both")];
    let rest: String = [11, 12, 13, 14].iter().map(|end| way(*end, &[*end, 15], &both)).collect();
    let (town, _) = read(osm(&ends, &rest).as_bytes()).unwrap();
    let count = |kind| town.walkable.iter().filter(|area| area.kind == kind).count();
    assert_eq!((count(WalkableKind::Crossing), count(WalkableKind::Sidewalk)), (4, 8));
    // Each pavement meets another one at the corner: the middle of the corner lies on two.
    let corner = 5.5 / 2.0 + 1.0;
    for (x, y) in [(corner, corner), (-corner, corner), (corner, -corner), (-corner, -corner)] {
        let there = town.walkable.iter().filter(|area| contains(&area.plan(), DVec2::new(x, y)));
        assert_eq!(there.filter(|area| area.kind == WalkableKind::Sidewalk).count(), 2, "{x} {y}");
    }
    assert!(town.synthetic.notes.iter().any(|note| note.starts_with("4 unmarked crossings")));
}

#[test]
fn a_path_over_a_street_is_a_crossing_there_and_a_tunnel_is_left_out() {
    let nodes = [(11, -9, 0), (12, 9, 0), (13, 0, -9), (14, 0, 9), (15, 0, 0), (16, 5, -9), (17, 5, 9)];
    let rest = way(1, &[11, 15, 12], &[("highway", "secondary"), ("width", "10")])
        + &way(2, &[13, 15, 14], &[("highway", "footway")])
        + &way(3, &[16, 17], &[("highway", "footway"), ("tunnel", "yes")]);
    let (town, _) = read(osm(&nodes, &rest).as_bytes()).unwrap();
    let kinds: Vec<WalkableKind> = town.walkable.iter().map(|area| area.kind).collect();
    assert_eq!(kinds, [WalkableKind::Sidewalk, WalkableKind::Crossing, WalkableKind::Sidewalk]);
    let across = town.walkable[1].plan().iter().map(|corner| corner.y.abs()).fold(0.0, f64::max);
    assert!((across - 5.0).abs() < 1.0, "{across}");
}

#[test]
fn the_sea_is_water_right_of_the_coast() {
    let nodes = [&SQUARE[..], &[(21, -90, -5), (22, 90, -5)]].concat();
    let house = way(8, &RING, &[("building", "yes")]);
    // To the west: the land lies on the left, in the south.
    let (town, warnings) =
        read(osm(&nodes, &(house.clone() + &way(9, &[22, 21], &[("natural", "coastline")]))).as_bytes()).unwrap();
    let water = town.surfaces.iter().find(|mesh| mesh.label == SemanticLabel::Water).unwrap();
    let south = water.vertices_in_world.iter().map(|vertex| vertex.y).fold(f64::NEG_INFINITY, f64::max);
    assert!((south - 5e-4 * 110_574.0).abs() < 0.1 && warnings.is_empty(), "{south} {warnings:?}");
    let ends = [&SQUARE[..], &[(21, -9, -5), (22, 9, -5)]].concat();
    let (_, warnings) =
        read(osm(&ends, &(house + &way(9, &[22, 21], &[("natural", "coastline")]))).as_bytes()).unwrap();
    assert!(warnings[0].contains("coastline ends"), "{warnings:?}");
}

#[test]
fn a_gate_and_a_path_open_a_wall() {
    let nodes = "<node id=\"22\" lon=\"0\" lat=\"0.0005\"><tag k=\"barrier\" v=\"gate\"/></node>";
    let line = [(21, -10, 5), (23, 5, 5), (24, 10, 5), (31, 5, 0), (32, 5, 9)];
    let rest = nodes.to_owned()
        + &way(8, &[21, 22, 23, 24], &[("barrier", "wall")])
        + &way(9, &[31, 23, 32], &[("highway", "footway")]);
    let (town, _) = read(osm(&line, &rest).as_bytes()).unwrap();
    let walls: Vec<f64> = town.obstacles.iter().map(|one| 2.0 * one.shape.half_extents_m.x).collect();
    assert_eq!(walls.len(), 3, "{walls:?}");
    let length: f64 = walls.iter().sum();
    assert!((length - (0.002 * 111_319.49 - 6.0)).abs() < 0.01, "{length}");
}

#[test]
fn what_is_not_there_or_below_the_ground_is_no_building() {
    for (tags, expected) in [
        ([("building", "yes"), ("level", "0")], 1),
        ([("building", "yes"), ("level", "-2")], 0),
        ([("building", "yes"), ("layer", "-1")], 0),
        ([("building", "demolished"), ("height", "9")], 0),
        ([("building", "construction"), ("height", "9")], 1),
    ] {
        let street = way(9, &[1, 3], &[("highway", "footway")]);
        let (town, _) = read(osm(&SQUARE, &(way(8, &RING, &tags) + &street)).as_bytes()).unwrap();
        assert_eq!(town.obstacles.len(), expected, "{tags:?}");
    }
}

#[test]
fn bounds_that_hold_no_node_are_those_of_another_place() {
    let text = osm(&SQUARE, &way(8, &RING, &[("building", "yes")])).replace(" lon=\"0", " lon=\"10");
    let (town, _) = read(text.as_bytes()).unwrap();
    assert_eq!(town.obstacles.len(), 1);
}

#[test]
fn hostile_files_are_refused_with_a_reason() {
    let check = |bytes: &[u8], expected: &str| {
        let error = read(bytes).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    };
    check(osm(&[], "").as_bytes(), "no houses");
    check(b"<osm version=\"0.6\"></osm>", "no nodes with a place");
    check(b"<osm><node id=\"x\" lat=\"1\" lon=\"1\"/></osm>", "`id` is `x`");
    check(b"<osm><node lat=\"1\" lon=\"1\"/></osm>", "has no `id`");
    check(b"<osm><way id=\"1\">", "ends before");
    check(&gzip(&[b"<osm>".as_slice(), &[b' '; 3 << 20]].concat()), "longer than");
    let wide = b"<osm><bounds minlat=\"0\" minlon=\"0\" maxlat=\"60\" maxlon=\"60\"/><node id=\"1\" lat=\"1\" lon=\"1\"/></osm>";
    check(wide, "degrees across");
    let example = example_as_pbf(zlib);
    check(&example[..example.len() - 1], "the file ends");
    let bomb = zlib(&vec![0; 40 << 20]);
    check(&[&example[..], &blob("OSMData", &bomb)].concat(), "unpacks to more");
    check(&[&example[..], &[0xff; 8]].concat(), "has a header of");
    let newer = HeaderBlock { bounds: None, required_features: vec!["Telepathy".into()] };
    check(&blob("OSMHeader", &raw(&newer.encode_to_vec())), "the feature `Telepathy`");
    check(&blob("OSMHeader", &Blob::default()), "only zlib is");
}

#[test]
fn absurd_numbers_in_a_pbf_file_do_not_panic() {
    let dense = DenseNodes {
        ids: vec![i64::MAX, i64::MAX, 1],
        lats: vec![i64::MIN, i64::MAX, 3],
        lons: vec![i64::MAX, 1, 2],
        keys_and_values: vec![-5, 7, 0, 9],
        ..DenseNodes::default()
    };
    let (keys, nodes) = (vec![u32::MAX], vec![i64::MAX, i64::MAX]);
    let way = PackedWay { id: -1, keys, values: vec![3], nodes, ..PackedWay::default() };
    let relation =
        PackedRelation { id: 1, roles: vec![i32::MIN], members: vec![1], kinds: vec![77], ..PackedRelation::default() };
    let group = PrimitiveGroup { dense: Some(dense), ways: vec![way], relations: vec![relation], nodes: vec![] };
    let block =
        PrimitiveBlock { groups: vec![group], granularity: Some(i32::MIN), lat_offset: i64::MIN, ..Default::default() };
    let file = [blob("OSMHeader", &raw(&[])), blob("OSMData", &raw(&block.encode_to_vec()))].concat();
    assert!(pbf::recognises(&file));
    assert!(read(&file).is_err());
}

#[test]
fn damaged_containers_give_an_error_or_a_well_formed_town() {
    let mut stream = Seed([0; 32]).stream("damage");
    for file in [example_as_pbf(raw), example_as_pbf(zlib), gzip(OpenStreetMap::EXAMPLE)] {
        for _ in 0..400 {
            let mut damaged = file.clone();
            for _ in 0..=stream.index(3) {
                let place = stream.index(damaged.len());
                damaged[place] = stream.index(256) as u8;
            }
            let _ = read(&damaged);
            let end = stream.index(file.len());
            let _ = read(&file[..end]);
        }
    }
}

#[test]
fn broken_rings_and_relations_in_circles_are_told_of_by_number() {
    let nodes = [&SQUARE[..], &[(5, 6, 0), (6, 8, 3), (7, 8, 0), (8, 6, 2)]].concat();
    let member = |kind: &str, id: i64, role: &str| format!("<member type=\"{kind}\" ref=\"{id}\" role=\"{role}\"/>");
    let group = |id: i64, kind: &str, members: &[String]| {
        let tags = format!("<tag k=\"type\" v=\"{kind}\"/><tag k=\"building\" v=\"yes\"/>");
        format!("<relation id=\"{id}\">{}{tags}</relation>", members.concat())
    };
    let rest = way(8, &RING, &[("building", "yes")])
        + &way(9, &[5, 6, 7, 8, 5], &[("building", "yes")])
        + &way(10, &[1, 2], &[])
        + &group(20, "building", &[member("relation", 21, "outline"), member("relation", 20, "part")])
        + &group(21, "multipolygon", &[member("relation", 20, "outer"), member("way", 10, "outer")]);
    let (town, warnings) = read(osm(&nodes, &rest).as_bytes()).unwrap();
    assert!(!town.obstacles.is_empty());
    assert!(warnings.iter().any(|line| line.contains("cross themselves") && line.contains("way 9")), "{warnings:?}");
    assert!(warnings.iter().any(|line| line.contains("areas lack") && line.contains("relation 21")), "{warnings:?}");
}

#[test]
fn a_ring_of_a_million_corners_is_left_out_with_its_number() {
    let mut file = String::from("<osm><bounds minlat=\"-0.02\" minlon=\"-0.02\" maxlat=\"0.02\" maxlon=\"0.02\"/>");
    let mut nodes = String::new();
    for id in 0..1_000_000 {
        let (x, y) = if id < 500_000 { (id, 0) } else { (999_999 - id, 1000 + id % 7) };
        file += &format!("<node id=\"{id}\" lon=\"{}e-8\" lat=\"{y}e-7\"/>", x * 2);
        nodes += &format!("<nd ref=\"{id}\"/>");
    }
    file += &format!("<way id=\"77\">{nodes}<nd ref=\"0\"/><tag k=\"building\" v=\"yes\"/></way>");
    file += "<way id=\"78\"><nd ref=\"0\"/><nd ref=\"499999\"/><tag k=\"highway\" v=\"footway\"/></way></osm>";
    let (town, warnings) = read(file.as_bytes()).unwrap();
    assert!(town.obstacles.is_empty());
    assert!(warnings[0].contains("too many corners") && warnings[0].contains("way 77"), "{warnings:?}");
}

#[test]
fn streets_have_lanes_on_the_right_that_turn_at_junctions() {
    // Two streets that meet, the second a one-way street; a node is about 11 m per unit.
    let nodes = [(1, -12, 0), (2, 0, 0), (3, 12, 0), (4, 0, 12), (5, 14, 14), (6, 16, 14)];
    let street = [("highway", "residential"), ("maxspeed", "30")];
    let rest = way(10, &[1, 2, 3], &street)
        + &way(11, &[2, 4], &[("highway", "residential"), ("oneway", "yes")])
        + &way(12, &[5, 6], &[("highway", "service")]);
    for left_hand_traffic in [false, true] {
        let options = OsmOptions { left_hand_traffic, ..OsmOptions::default() };
        let (mut town, _) = OpenStreetMap::read(osm(&nodes, &rest).as_bytes(), &options).unwrap();
        town.link_lanes();
        town.update_bounds();
        town.assert_well_formed().unwrap();
        let streets: Vec<_> = town.lanes.iter().filter(|lane| !lane.in_junction).collect();
        assert_eq!(streets.len(), 5, "two pieces both ways, and one way north");
        for lane in &streets {
            let [from, to] = [lane.middle_in_world[0], lane.middle_in_world[lane.middle_in_world.len() - 1]];
            let along = (to - from).truncate().normalize();
            if along.x.abs() > 0.9 {
                // y grows to the south: right of a way to the east is south.
                let right_m = from.y * along.x;
                assert!(right_m * if left_hand_traffic { -1.0 } else { 1.0 } > 1.0, "{from} {to}");
                assert!((lane.speed_limit_mps - 30.0 / 3.6).abs() < 1e-9);
            }
            let leaves = to.truncate().length() > from.truncate().length();
            assert_eq!(lane.successors.len(), if leaves { 0 } else { 2 }, "straight on, and into the one-way street");
        }
        let ways = town.lanes.iter().filter(|lane| lane.in_junction);
        assert_eq!(ways.map(|lane| lane.successors.len()).collect::<Vec<_>>(), [1; 4]);
    }
}

#[test]
fn bare_streets_are_said_and_the_option_that_is_named_helps() {
    // A street of 220 m, and a park path elsewhere that is ground enough.
    let nodes = [(1, -10, 0), (2, 10, 0), (3, -15, 15), (4, 15, 15)];
    let rest = |sidewalk: &str| {
        way(10, &[1, 2], &[("highway", "residential"), ("sidewalk", sidewalk)])
            + &way(11, &[3, 4], &[("highway", "footway"), ("width", "4")])
    };
    let said = |sidewalk: &str, assume_pavements: bool| {
        let options = OsmOptions { assume_pavements, ..OsmOptions::default() };
        let text = osm(&nodes, &rest(sidewalk).replace("<tag k=\"sidewalk\" v=\"\"/>", ""));
        let (town, warnings) = OpenStreetMap::read(text.as_bytes(), &options).unwrap();
        let pavements = town.walkable.iter().filter(|polygon| polygon.synthetic).count();
        (warnings.into_iter().find(|warning| warning.contains("assume_pavements = true")), pavements)
    };
    let (warning, before) = said("", false);
    assert!(warning.as_ref().is_some_and(|it| it.starts_with("0.2 of 0.2 km of streets")), "{warning:?}");
    let (warning, after) = said("", true);
    assert!(warning.is_none() && before == 0 && after > 0, "{warning:?} {after}");
    // Where the option would not help, nothing is said.
    assert_eq!(said("no", false).0, None);
    assert_eq!(said("both", false).0, None);
}

#[test]
fn maps_of_lanelet2_are_told_from_extracts() {
    let nodes = [(1, 0, 0), (2, 10, 0), (3, 0, 1), (4, 10, 1)];
    let rest = way(10, &[1, 2], &[("type", "line_thin")])
        + &way(11, &[3, 4], &[("type", "line_thin")])
        + "<relation id=\"1\"><member type=\"way\" ref=\"10\" role=\"left\"/><member type=\"way\" ref=\"11\" role=\"right\"/>\
           <tag k=\"type\" v=\"lanelet\"/><tag k=\"subtype\" v=\"road\"/></relation>";
    let error = read(osm(&nodes, &rest).as_bytes()).unwrap_err();
    assert!(error.message.contains("Lanelet2 map of 1 lanelets") && error.hints[0].contains("OpenDRIVE"), "{error}");
    let street = rest + &way(12, &[1, 4], &[("highway", "residential")]);
    assert!(read(osm(&nodes, &street).as_bytes()).is_ok());
}
