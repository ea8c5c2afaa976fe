//! Advice of the stage `map` and of refusals: each piece is carried out here, and helps.

use cosfly_domain::{ObstacleKind, SemanticLabel, Town, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3, Seed};
use cosfly_maps::advice::{advice, busiest_part};
use cosfly_maps::{MapConfig, read_town_of, recognise};
use cosfly_town::{GroundIndex, MapError};
use serde_json::{Value, json};

/// A street with a house, of OpenDRIVE; and one without, with a projection.
const HOUSE: &str = include_str!("../src/formats/opendrive/every_feature.xodr");
const LOCAL: &str = "+proj=tmerc +lat_0=48 +lon_0=11 +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m";

fn street() -> String {
    let (head, rest) = HOUSE.split_once("<objects>").unwrap();
    let (_, tail) = rest.split_once("</objects>").unwrap();
    format!("{head}{tail}").replacen("+proj=tmerc", LOCAL, 1)
}

fn read(files: &[&[u8]], config: &Value) -> Result<(Town, Vec<String>, MapConfig), MapError> {
    let options = config.get("options").and_then(Value::as_object).cloned().unwrap_or_default();
    let mut own = config.clone();
    own.as_object_mut().unwrap().remove("options");
    let config = MapConfig { options: options.into(), ..serde_json::from_value(own).unwrap() };
    let (town, warnings) =
        read_town_of(files, &config, Seed::of_item(1, "town", "town")).map_err(|(_, error)| error)?;
    cosfly_town::assert_well_formed(&town).unwrap();
    Ok((town, warnings, config))
}

fn houses(town: &Town) -> usize {
    town.obstacles.iter().filter(|one| one.kind == ObstacleKind::Building).count()
}

/// Houses of 20 m beside a place of degrees, without streets, as an extract of OpenStreetMap.
fn houses_of_osm() -> String {
    let mut text = "<osm version=\"0.6\">".to_owned();
    for (house, at) in (1..5).zip([0.0, 0.0006, 0.0012, 0.0018]) {
        let corners = [(0.0, 0.0), (0.0003, 0.0), (0.0003, 0.0002), (0.0, 0.0002)];
        for (corner, (lon, lat)) in (0..).zip(corners) {
            let (lon, lat) = (11.0 + at + lon, 48.0007 + lat);
            text += &format!("<node id=\"{}\" lat=\"{lat:.7}\" lon=\"{lon:.7}\"/>", 10 * house + corner);
        }
    }
    for house in 1..5 {
        let refs: String =
            [0, 1, 2, 3, 0].iter().map(|corner| format!("<nd ref=\"{}\"/>", 10 * house + corner)).collect();
        text += &format!("<way id=\"{house}\">{refs}<tag k=\"building\" v=\"yes\"/></way>");
    }
    text + "</osm>"
}

#[test]
fn a_town_without_houses_gets_them_by_fill_or_by_a_further_file() {
    let street = street();
    let (town, _, config) = read(&[street.as_bytes()], &json!({})).unwrap();
    let said = advice(&town, &config);
    assert!(houses(&town) == 0 && said.len() == 1, "{said:?}");
    assert!(
        said[0].contains("`fill.buildings = true`") && said[0].contains("`more = [{ source = \"FILE\" }]`"),
        "{said:?}"
    );

    let (town, _, config) = read(&[street.as_bytes()], &json!({ "fill": { "buildings": true } })).unwrap();
    assert!(houses(&town) > 0 && advice(&town, &config).is_empty());
    let more = json!({ "more": [{ "source": "FILE" }] });
    let (town, _, config) = read(&[street.as_bytes(), houses_of_osm().as_bytes()], &more).unwrap();
    assert!(houses(&town) > 0 && advice(&town, &config).is_empty());
}

#[test]
fn a_town_without_streets_gets_them_of_a_further_file() {
    let (street, alone) = (street(), houses_of_osm());
    let (town, _, config) = read(&[alone.as_bytes()], &json!({})).unwrap();
    let said = advice(&town, &config);
    assert!(said.len() == 1 && said[0].contains("take = [\"ground\"] }]`"), "{said:?}");
    let more = json!({ "more": [{ "source": "FILE", "take": ["ground"] }] });
    let (town, _, config) = read(&[alone.as_bytes(), street.as_bytes()], &more).unwrap();
    assert!(town.walkable.iter().any(|polygon| polygon.kind == WalkableKind::Sidewalk) && houses(&town) > 0);
    assert_eq!(advice(&town, &config), Vec::<String>::new());

    // Where the first file has no projection, the advice has a place for the other one.
    let boxes = r#"{ "format": "cosfly-boxes/1",
        "boxes": [{ "kind": "building", "center_m": [20, 14, 5], "size_m": [16, 10, 10] }],
        "walkable": [{ "kind": "plaza", "outline_m": [[-60, -30, 0], [60, -30, 0], [60, 0, 0], [-60, 0, 0]] }] }"#;
    let (town, _, config) = read(&[boxes.as_bytes()], &json!({})).unwrap();
    let said = advice(&town, &config);
    assert!(said.len() == 1 && said[0].contains("shift_m = [X, Y, Z] }]`"), "{said:?}");
    let more = json!({ "more": [{ "source": "FILE", "take": ["ground"], "shift_m": [-60, -30, 0] }] });
    let (town, _, config) = read(&[boxes.as_bytes(), street.as_bytes()], &more).unwrap();
    assert_eq!(advice(&town, &config), Vec::<String>::new());
}

/// Houses of 50 x 12 m, three in each of four rows with 13 m between them, as CityJSON.
fn rows_of_houses() -> String {
    let (mut vertices, mut objects) = (vec![], vec![]);
    for house in 0..12 {
        let [x, y] = [63 * (house % 3), 25 * (house / 3)];
        vertices.extend([[x, y, 0], [x + 50, y, 0], [x + 50, y + 12, 0], [x, y + 12, 0]]);
        let corners = [0, 1, 2, 3].map(|corner| 4 * house + corner);
        objects.push((
            format!("house {house}"),
            json!({ "type": "Building", "attributes": { "measuredHeight": 9 },
                "geometry": [{ "type": "MultiSurface", "lod": "0", "boundaries": [[corners]] }] }),
        ));
    }
    json!({ "type": "CityJSON", "version": "2.0", "transform": { "scale": [1, 1, 1], "translate": [0, 0, 0] },
        "CityObjects": objects.into_iter().collect::<serde_json::Map<_, _>>(), "vertices": vertices })
    .to_string()
}

#[test]
fn a_town_of_houses_alone_gets_invented_streets_that_keep_off_the_houses() {
    let text = rows_of_houses();
    let (plain, ..) = read(&[text.as_bytes()], &json!({ "streets": "file" })).unwrap();
    let invented = json!({ "streets": "invented" });
    let (town, warnings, config) = read(&[text.as_bytes()], &json!({})).unwrap();
    assert!(plain.lanes.is_empty() && warnings.is_empty(), "{warnings:?}");
    let said = advice(&town, &config);
    assert!(
        said.len() == 1 && said[0].contains("are invented") && said[0].contains("`streets = \"file\"`"),
        "{said:?}"
    );
    assert!(town.synthetic.notes.iter().any(|note| note.contains("streets of 0.")), "{:?}", town.synthetic.notes);

    // Two streets along the rows and two across, at least, with ways through all four junctions.
    assert!(town.lanes.iter().filter(|lane| !lane.in_junction).count() >= 8, "{} lanes", town.lanes.len());
    let ways = town.lanes.iter().filter(|lane| lane.in_junction);
    assert!(ways.clone().count() >= 20 && ways.clone().all(|way| way.successors.len() == 1));
    assert!(town.lanes.iter().any(|lane| !lane.crossings.is_empty()), "people cross");
    let ground = GroundIndex::new(&town);
    let clear_m = |at: DVec3| {
        let away = |house: &cosfly_domain::Obstacle| {
            let aside = (at - house.shape.center_in_world).truncate().abs() - house.shape.half_extents_m.truncate();
            aside.max(DVec2::ZERO).length()
        };
        town.obstacles.iter().map(away).fold(f64::INFINITY, f64::min)
    };
    for lane in &town.lanes {
        for at in &lane.middle_in_world {
            assert!(clear_m(*at) >= 0.5 * lane.width_m, "a lane at {at} in a house");
            let seen = ground.ground_below(at.with_z(3.0), 0.0).unwrap();
            assert_eq!(seen.label, SemanticLabel::Roads, "{at}: no land shows through the street");
        }
    }
    let is_pavement = |polygon: &&WalkablePolygon| polygon.kind == WalkableKind::Sidewalk;
    let pavements: Vec<&WalkablePolygon> = town.walkable.iter().filter(is_pavement).collect();
    assert!(!pavements.is_empty() && pavements.iter().all(|polygon| polygon.synthetic));
    assert!(pavements.iter().flat_map(|it| &it.outline_in_world).all(|at| clear_m(*at) > 0.0));

    let (again, ..) = read(&[text.as_bytes()], &invented).unwrap();
    assert_eq!(again, town);
    let (_, warnings, _) = read(&[street().as_bytes()], &invented).unwrap();
    assert!(warnings.iter().any(|warning| warning.contains("the town has streets or pavements")), "{warnings:?}");
    let (_, warnings, _) = read(&[houses_of_osm().as_bytes()], &invented).unwrap();
    assert!(warnings.iter().any(|warning| warning.contains("no ground of 8 to 30 m")), "{warnings:?}");
}

#[test]
fn a_town_too_wide_for_walks_is_cut_by_the_bounds_that_are_proposed() {
    // Paths of 30 km that cross near the origin.
    let nodes = [(1, 48.0, 10.8), (2, 48.0, 11.2), (3, 47.87, 11.0), (4, 48.13, 11.0)];
    let nodes: String =
        nodes.iter().map(|(id, lat, lon)| format!("<node id=\"{id}\" lat=\"{lat}\" lon=\"{lon}\"/>")).collect();
    let way = |id: u32, [from, to]: [u32; 2]| {
        format!("<way id=\"{id}\"><nd ref=\"{from}\"/><nd ref=\"{to}\"/><tag k=\"highway\" v=\"footway\"/></way>")
    };
    let text = format!("<osm version=\"0.6\">{nodes}{}{}</osm>", way(1, [1, 2]), way(2, [3, 4]));
    let (town, _, config) = read(&[text.as_bytes()], &json!({})).unwrap();
    let said = advice(&town, &config);
    let wide = said.iter().find(|it| it.contains("square kilometres")).unwrap_or_else(|| panic!("{said:?}"));
    let numbers = wide.split("bounds_m = [").nth(1).and_then(|rest| rest.split(']').next()).unwrap();
    let numbers: Vec<f64> = numbers.split(", ").map(|number| number.parse().unwrap()).collect();
    let (part, _, config) = read(&[text.as_bytes()], &json!({ "bounds_m": numbers })).unwrap();
    assert!(!advice(&part, &config).iter().any(|it| it.contains("square kilometres")));
    assert!((part.max_in_world - part.min_in_world).truncate().max_element() < 4_200.0);
    assert_eq!(busiest_part(&Town::default()), None);
}

fn refused(bytes: &[u8], words: &str) -> String {
    let error = recognise(bytes).unwrap_err();
    assert_eq!(error.message, "the file is of no known map format");
    let hint = error.hints.iter().find(|hint| hint.contains(words));
    hint.unwrap_or_else(|| panic!("`{words}` in {:?}", error.hints)).clone()
}

/// Points on level ground and on a house of 8 x 8 x 6 m, one each half metre.
fn points() -> Vec<[f32; 3]> {
    let steps = |from: i32, to: i32| (from..to).map(|step| 0.5 * step as f32 + 0.25);
    let ground = steps(-60, 60).flat_map(|x| steps(-60, 60).map(move |y| (x, y)));
    ground.map(|(x, y)| [x, y, if x.abs() < 4.0 && y.abs() < 4.0 { 6.0 } else { 0.01 }]).collect()
}

#[test]
fn scans_and_tables_of_points_become_clouds_by_the_head_that_is_named() {
    let bytes: Vec<u8> =
        points().iter().flat_map(|[x, y, z]| [*x, *y, *z, 0.3].map(f32::to_le_bytes)).flatten().collect();
    let hint = refused(&bytes, "as KITTI has them");
    for words in ["format binary_little_endian 1.0", "element vertex N", "property float"] {
        assert!(hint.contains(words), "{hint}");
    }
    let names = ["x", "y", "z", "intensity"];
    let properties: String = names.iter().map(|name| format!("property float {name}\n")).collect();
    let count = bytes.len() / 16;
    let head = format!("ply\nformat binary_little_endian 1.0\nelement vertex {count}\n{properties}end_header\n");
    let (town, ..) = read(&[&[head.as_bytes(), &bytes].concat()], &json!({})).unwrap();
    assert!(houses(&town) > 0 && !town.walkable.is_empty());

    let rows: String = points().iter().map(|[x, y, z]| format!("{x:.2} {y:.2} {z:.2} 17\n")).collect();
    assert!(refused(rows.as_bytes(), "table of points").contains("format ascii 1.0"));
    let properties: String = names.iter().map(|name| format!("property double {name}\n")).collect();
    let head = format!("ply\nformat ascii 1.0\nelement vertex {count}\n{properties}end_header\n");
    let (town, ..) = read(&[format!("{head}{rows}").as_bytes()], &json!({})).unwrap();
    assert!(houses(&town) > 0 && !town.walkable.is_empty());
}

#[test]
fn other_formats_are_told_by_their_content() {
    refused(b"<?xml version=\"1.0\"?>\n<net version=\"1.20\">\n<location netOffset=\"0,0\"/>", "netconvert -s FILE");
    refused(b"b3dm\x01\0\0\0", "cosfly map tiles");
    refused(b"{\"asset\":{\"version\":\"1.1\"},\"geometricError\":70,\"root\":{}}", "cosfly map tiles");
    refused(b"solid cube\n facet normal 0 0 1\n  outer loop\n", "GLB or OBJ");
    let mut facets = [b"exported".as_slice(), &[0; 72], &2_u32.to_le_bytes()].concat();
    for _ in 0..2 {
        let numbers = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 4.0, 0.0_f32];
        facets.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        facets.extend([0, 0]);
    }
    refused(&facets, "STL");
    // A place, three lengths, a colour, a turn of length one.
    let numbers = [1.5, -200.0, 3.0, 0.01, 0.2, 0.0_f32].map(f32::to_le_bytes).concat();
    let splat = [&numbers[..], &[200, 90, 4, 255, 128 + 73, 128 - 73, 128 + 74, 128]].concat();
    refused(&splat.repeat(40), "splats.source");
    refused(b"NGSP\x04\0\0\0", "splats.source");
    // Neither is told of a text, nor of any bytes.
    for bytes in [&b"hello"[..], b"1 2\n3 4\n", &[7; 200]] {
        let error = recognise(bytes).unwrap_err();
        assert_eq!(error.hints.len(), 1, "{:?}", error.hints);
    }
}

#[test]
fn scenes_in_centimetres_are_read_once_their_unit_is_given() {
    // Ground of 400 m with a house of 10 m in the middle; heights are along y, as OBJ has them.
    let mut text = "o sidewalk\n".to_owned();
    for [x, z] in [[-200.0, -200.0], [200.0, -200.0], [200.0, 200.0], [-200.0, 200.0]] {
        text += &format!("v {} 0 {}\n", 100.0 * x, 100.0 * z);
    }
    text += "f 1 2 3 4\no building\n";
    for y in [0.0, 10.0] {
        for [x, z] in [[-5.0, -5.0], [5.0, -5.0], [5.0, 5.0], [-5.0, 5.0]] {
            text += &format!("v {} {} {}\n", 100.0 * x, 100.0 * y, 100.0 * z);
        }
    }
    text += "f 5 6 7 8\nf 9 10 11 12\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12\n";
    let error = read(&[text.as_bytes()], &json!({})).unwrap_err();
    assert!(error.hints.iter().any(|hint| hint.contains("with `options.unit_m`: 0.01 for centimetres")), "{error:?}");
    let (town, ..) = read(&[text.as_bytes()], &json!({ "options": { "unit_m": 0.01 } })).unwrap();
    assert!(houses(&town) > 0 && !town.walkable.is_empty());

    let cloud = |unit: f32| {
        let bytes: Vec<u8> = points().iter().flatten().flat_map(|value| (unit * value).to_le_bytes()).collect();
        let properties: String = ["x", "y", "z"].iter().map(|name| format!("property float {name}\n")).collect();
        let head = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {}\n{properties}end_header\n",
            points().len()
        );
        [head.as_bytes(), &bytes].concat()
    };
    let error = read(&[&cloud(1e3)], &json!({})).unwrap_err();
    assert!(error.hints.iter().any(|hint| hint.contains("the length of its unit with `options.unit_m`")), "{error:?}");
    let (town, ..) = read(&[&cloud(1e3)], &json!({ "options": { "unit_m": 0.001 } })).unwrap();
    assert!(houses(&town) > 0);
}
