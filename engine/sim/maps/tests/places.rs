//! Where things are in the world: offsets of headers, further files, parts of towns, towns in two places.

use cosfly_domain::{ObstacleKind, Town, WalkableKind};
use cosfly_frames::{DVec2, Seed};
use cosfly_geodata::reference::GeoReference;
use cosfly_maps::{MapConfig, PlanRectangle, read_town_of};
use cosfly_town::MapError;
use serde_json::{Value, json};

const UTM: &str = "+proj=utm +zone=33 +datum=WGS84 +units=m +no_defs";
/// A place in Berlin: longitude, latitude; and its coordinates in UTM by PROJ 9.
const PLACE_DEG: [f64; 2] = [13.4364, 52.4769];
const PLACE_M: DVec2 = DVec2::new(393805.802, 5815231.897);

/// A street of 120 m to the east, its middle at a place of the file, with pavements and lanes.
fn street_at(header: &str, [x, y]: [f64; 2], heading_rad: f64) -> String {
    let lane = |id: i32, kind: &str, width: f64| {
        format!("<lane id=\"{id}\" type=\"{kind}\"><width sOffset=\"0\" a=\"{width}\" b=\"0\" c=\"0\" d=\"0\"/></lane>")
    };
    let side = |sign: i32| lane(sign, "driving", 4.0) + &lane(2 * sign, "sidewalk", 3.0);
    let (sin, cos) = cosfly_frames::real::sin_cos(heading_rad);
    let (x, y) = (x - 60.0 * cos, y - 60.0 * sin);
    format!(
        "<?xml version=\"1.0\"?><OpenDRIVE><header name=\"street\">{header}</header><road id=\"1\" length=\"120\">\
         <planView><geometry s=\"0\" x=\"{x}\" y=\"{y}\" hdg=\"{heading_rad}\" length=\"120\"><line/></geometry></planView>\
         <lanes><laneSection s=\"0\"><left>{}</left><center><lane id=\"0\" type=\"none\"/></center><right>{}</right>\
         </laneSection></lanes></road></OpenDRIVE>",
        side(1),
        side(-1)
    )
}

fn reference(offset: &str) -> String {
    format!("<geoReference><![CDATA[{UTM}]]></geoReference>{offset}")
}

/// A house of 20 x 12 m, its south side some metres north of a place, as OpenStreetMap has it.
fn house_north_of([lon, lat]: [f64; 2], north_m: f64) -> String {
    let here = GeoReference::parse(UTM).unwrap();
    let middle = here.project([lon, lat]);
    let corners = [(-10.0, 0.0), (10.0, 0.0), (10.0, 12.0), (-10.0, 12.0)].map(|(x, y)| {
        let [lon, lat] = here.unproject(middle + DVec2::new(x, y + north_m)).unwrap();
        (lon, lat)
    });
    let nodes: String = (1..)
        .zip(corners)
        .map(|(id, (lon, lat))| format!("<node id=\"{id}\" lat=\"{lat:.9}\" lon=\"{lon:.9}\"/>"))
        .collect();
    let refs: String = [1, 2, 3, 4, 1].iter().map(|id| format!("<nd ref=\"{id}\"/>")).collect();
    format!(
        "<osm version=\"0.6\">{nodes}<way id=\"1\">{refs}<tag k=\"building\" v=\"yes\"/><tag k=\"height\" v=\"9\"/></way></osm>"
    )
}

fn read(files: &[&str], config: Value) -> Result<(Town, Vec<String>), (usize, MapError)> {
    let config = MapConfig { name: Some("streets".into()), ..serde_json::from_value(config).unwrap() };
    let files: Vec<&[u8]> = files.iter().map(|file| file.as_bytes()).collect();
    let (town, warnings) = read_town_of(&files, &config, Seed::of_item(1, "town", "town"))?;
    cosfly_town::assert_well_formed(&town).unwrap();
    Ok((town, warnings))
}

/// Middle of all houses in plan, world frame.
fn middle_of_houses(town: &Town) -> DVec2 {
    let houses = town.obstacles.iter().filter(|one| one.kind == ObstacleKind::Building);
    let corners = houses.flat_map(|one| one.shape.corners_in_world()).map(|corner| corner.truncate());
    let bounds = PlanRectangle::around(corners).unwrap();
    0.5 * (bounds.low + bounds.high)
}

/// Degrees of a place of the world.
fn degrees(town: &Town, at: DVec2) -> DVec2 {
    let in_map = at + town.origin.offset_m.truncate();
    let reference = GeoReference::parse(town.origin.geo_reference.as_ref().unwrap()).unwrap();
    DVec2::from_array(reference.unproject(DVec2::new(in_map.x, -in_map.y)).unwrap())
}

const OFFSET_M: DVec2 = DVec2::new(393706.0, 5815132.0);

#[test]
fn the_offset_of_a_header_is_part_of_the_place_on_earth() {
    let local = PLACE_M - OFFSET_M;
    let offset = "<offset x=\"393706\" y=\"5815132\" z=\"40\" hdg=\"0\"/>";
    let street = street_at(&reference(offset), local.to_array(), 0.0);
    let house = house_north_of(PLACE_DEG, 12.0);
    let (town, warnings) = read(&[&street, &house], json!({ "more": [{ "source": "house.osm" }] })).unwrap();
    assert_eq!(warnings, Vec::<String>::new());
    // The town keeps the coordinates of its file; the offset is in its origin.
    let middle = middle_of_houses(&town);
    assert!(middle.distance(DVec2::new(local.x, -local.y - 18.0)) < 0.05, "{middle}");
    let size = town.max_in_world - town.min_in_world;
    assert!(size.x < 300.0 && size.y < 200.0, "{size}");
    assert_eq!(town.origin.offset_m.to_array(), [393706.0, -5815132.0, 40.0]);
    assert!(degrees(&town, DVec2::new(local.x, -local.y)).distance(DVec2::from_array(PLACE_DEG)) < 1e-7);
}

#[test]
fn a_file_with_an_offset_and_one_without_are_at_the_same_place() {
    let turn_rad = 0.3;
    let (sin, cos) = cosfly_frames::real::sin_cos(-turn_rad);
    let local = PLACE_M - OFFSET_M;
    // Coordinates of the file are turned by `hdg` before the offset is added.
    let turned = [cos * local.x - sin * local.y, sin * local.x + cos * local.y];
    let offset = format!("<offset x=\"393706\" y=\"5815132\" z=\"0\" hdg=\"{turn_rad}\"/>");
    let house = house_north_of(PLACE_DEG, 12.0);
    let further = json!({ "more": [{ "source": "house.osm" }] });
    let by_offset = street_at(&reference(&offset), turned, -turn_rad);
    let plain = street_at(&reference(""), PLACE_M.to_array(), 0.0);
    let (by_offset, _) = read(&[&by_offset, &house], further.clone()).unwrap();
    let (plain, _) = read(&[&plain, &house], further).unwrap();
    let on_earth = |town: &Town| degrees(town, middle_of_houses(town));
    assert!(on_earth(&by_offset).distance(on_earth(&plain)) < 1e-8);
    for town in [&by_offset, &plain] {
        let pavements =
            town.walkable.iter().filter(|polygon| polygon.kind == WalkableKind::Sidewalk && !polygon.synthetic);
        let pavements = pavements.flat_map(|polygon| &polygon.outline_in_world);
        let bounds = PlanRectangle::around(pavements.map(|corner| corner.truncate())).unwrap();
        let middle = degrees(town, 0.5 * (bounds.low + bounds.high));
        assert!(middle.distance(DVec2::from_array(PLACE_DEG)) < 1e-7, "{middle} {bounds:?} {:?}", town.origin);
        // To the east: turned back by `hdg`.
        assert!((bounds.high - bounds.low).distance(DVec2::new(120.0, 14.0)) < 1e-6, "{bounds:?}");
    }
}

#[test]
fn a_shift_is_between_the_coordinates_that_the_files_have() {
    let offset = "<offset x=\"393706\" y=\"5815132\" z=\"40\" hdg=\"0\"/>";
    let street = street_at(&reference(offset), [100.0, 100.0], 0.0);
    let boxes = r#"{ "format": "cosfly-boxes/1", "boxes": [{ "kind": "building", "center_m": [0, 0, 5], "size_m": [9, 9, 10] }],
        "walkable": [{ "kind": "plaza", "outline_m": [[20, 0, 0], [40, 0, 0], [40, 20, 0], [20, 20, 0]] }] }"#;
    let more = json!({ "more": [{ "source": "boxes.json", "shift_m": [110, 130, 0] }] });
    let (town, _) = read(&[&street, boxes], more).unwrap();
    assert!(middle_of_houses(&town).distance(DVec2::new(110.0, -130.0)) < 1e-9);
}

#[test]
fn things_of_another_place_are_refused_and_the_advice_helps() {
    let plain = street_at(&reference(""), PLACE_M.to_array(), 0.0);
    let far = house_north_of([PLACE_DEG[0] + 0.1, PLACE_DEG[1]], 12.0);
    let further = |extra: Value| {
        let mut more = json!({ "source": "house.osm" });
        more.as_object_mut().unwrap().extend(extra.as_object().unwrap().clone());
        json!({ "more": [more] })
    };
    let (at, error) = read(&[&plain, &far], further(json!({}))).unwrap_err();
    assert_eq!(at, 1);
    for words in ["`house.osm`", "`streets`", "6.7 km"] {
        assert!(error.message.contains(words), "{words}: {error}");
    }
    assert!(error.hints.iter().any(|hint| hint.contains("shift_m")), "{:?}", error.hints);
    // The origin of an extract is its middle: `shift_m` puts it beside the street.
    let shift = [PLACE_M.x, PLACE_M.y + 18.0, 0.0];
    let (town, warnings) = read(&[&plain, &far], further(json!({ "shift_m": shift }))).unwrap();
    assert_eq!(warnings, Vec::<String>::new());
    assert!(degrees(&town, middle_of_houses(&town)).distance(DVec2::from_array(PLACE_DEG)) < 3e-4);
}

#[test]
fn far_things_of_a_file_that_is_near_are_refused_and_bounds_help() {
    let plain = street_at(&reference(""), PLACE_M.to_array(), 0.0);
    let (near, far) = (house_north_of(PLACE_DEG, 12.0), house_north_of([PLACE_DEG[0] + 0.3, PLACE_DEG[1]], 0.0));
    let (nodes, ways) = far.trim_start_matches("<osm version=\"0.6\">").split_once("<way").unwrap();
    let other = |text: &str| {
        (1..5).fold(text.to_owned(), |text, id| text.replace(&format!("=\"{id}\""), &format!("=\"9{id}\"")))
    };
    let ways = format!("<way{}", ways.replace("</osm>", ""));
    let both = near.replace("</osm>", "").replace("<way", &format!("{}<way", other(nodes))) + &other(&ways) + "</osm>";
    let more = json!({ "more": [{ "source": "houses.osm" }] });
    let (_, error) = read(&[&plain, &both], more.clone()).unwrap_err();
    assert!(error.message.contains("20.") && error.message.contains("km away"), "{error}");
    let numbers = error.hints[0].split(['[', ']']).nth(1).unwrap();
    let numbers: Vec<f64> = numbers.split(", ").map(|number| number.parse().unwrap()).collect();
    let mut more = more;
    more["bounds_m"] = json!(numbers);
    let (town, _) = read(&[&plain, &both], more).unwrap();
    let houses = town.obstacles.iter().filter(|one| one.kind == ObstacleKind::Building).count();
    assert!(houses > 0 && degrees(&town, middle_of_houses(&town)).distance(DVec2::from_array(PLACE_DEG)) < 3e-4);
}

#[test]
fn a_further_file_that_gives_nothing_or_stands_beside_is_said() {
    let plain = street_at(&reference(""), PLACE_M.to_array(), 0.0);
    let house = house_north_of(PLACE_DEG, 500.0);
    let warnings = |take: &str| {
        let more = json!({ "more": [{ "source": "house.osm", "take": [take] }] });
        read(&[&plain, &house], more).unwrap().1
    };
    assert!(warnings("buildings").iter().any(|it| it.contains("the nearest is 4")), "{:?}", warnings("buildings"));
    assert!(warnings("plants").iter().any(|it| it.contains("none of the parts")), "{:?}", warnings("plants"));
}

/// A map of boxes with two pavements, the second one some metres to the east.
fn two_pavements(apart_m: f64) -> String {
    let pavement = |x: f64| {
        format!(
            r#"{{ "kind": "sidewalk", "outline_m": [[{x}, 0, 0], [{}, 0, 0], [{}, 4, 0], [{x}, 4, 0]] }}"#,
            x + 60.0,
            x + 60.0
        )
    };
    format!(r#"{{ "format": "cosfly-boxes/1", "walkable": [{}, {}] }}"#, pavement(0.0), pavement(apart_m))
}

fn bounds_in(text: &str) -> Value {
    let numbers = text.split("bounds_m = [").nth(1).and_then(|rest| rest.split(']').next()).unwrap();
    Value::from(numbers.split(", ").map(|number| number.parse::<f64>().unwrap()).collect::<Vec<_>>())
}

#[test]
fn towns_in_two_places_are_said_and_bounds_help() {
    let (_, warnings) = read(&[&two_pavements(5_000.0)], json!({})).unwrap();
    let warning = warnings.iter().find(|warning| warning.contains("with nothing in them")).unwrap();
    assert!(warning.contains("4.9 km along x"), "{warning}");
    let (town, warnings) = read(&[&two_pavements(5_000.0)], json!({ "bounds_m": bounds_in(warning) })).unwrap();
    // The land was made before the part was cut out.
    assert!(matches!(&warnings[..], [one] if one.contains("cells of 6.5 m instead of 4 m")), "{warnings:?}");
    assert_eq!(town.walkable.len(), 1);

    // Two roads as far from each other as a slip of a digit puts them.
    let road = street_at("", [0.0, 0.0], 0.0);
    let (head, tail) = road.split_once("<road").unwrap();
    let far = tail.replace("id=\"1\"", "id=\"2\"").replacen("x=\"-60\"", "x=\"100000\"", 1);
    let both = format!("{head}<road{}<road{far}", tail.replace("</OpenDRIVE>", ""));
    let (_, error) = read(&[&both], json!({})).unwrap_err();
    assert!(error.message.contains("99.9 km along x"), "{error}");
    let (town, _) = read(&[&both], json!({ "bounds_m": bounds_in(&error.hints[0]) })).unwrap();
    assert!((town.max_in_world - town.min_in_world).x < 400.0);
}

#[test]
fn bounds_cut_every_format_and_nothing_within_is_an_error() {
    for format in cosfly_maps::FORMATS {
        let config = |bounds_m: Option<[f64; 4]>| MapConfig { bounds_m, ..MapConfig::default() };
        let seed = Seed::of_item(1, "town", "town");
        let (whole, _) = read_town_of(&[format.example()], &config(None), seed).unwrap();
        let mut walkable = whole.walkable.iter().flat_map(|polygon| &polygon.outline_in_world);
        let at = walkable.next().unwrap().truncate();
        let bounds = PlanRectangle { low: at - 12.0, high: at + 12.0 };
        let numbers = [bounds.low.x, bounds.low.y, bounds.high.x, bounds.high.y];
        let (part, _) = read_town_of(&[format.example()], &config(Some(numbers)), seed).unwrap();
        cosfly_town::assert_well_formed(&part).unwrap();
        let corners = part.walkable.iter().flat_map(|polygon| &polygon.outline_in_world);
        assert!(corners.clone().count() > 2, "{format:?}");
        assert!(corners.clone().all(|corner| bounds.distance_m(corner.truncate()) < 1e-6), "{format:?}");
        assert!(part.obstacles.len() <= whole.obstacles.len(), "{format:?}");
        let nowhere = [7e5, 7e5, 7.1e5, 7.1e5];
        let (_, error) = read_town_of(&[format.example()], &config(Some(nowhere)), seed).unwrap_err();
        assert!(error.message.contains("nothing of the town lies within"), "{format:?}: {error}");
        let whole = bounds_in(&error.hints[0]);
        let whole: [f64; 4] = serde_json::from_value(whole).unwrap();
        assert!(read_town_of(&[format.example()], &config(Some(whole)), seed).is_ok(), "{format:?}");
    }
}
