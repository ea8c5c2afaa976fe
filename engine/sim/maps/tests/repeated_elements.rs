//! OpenDRIVE: elements that are there twice, out of order, missing or unknown are refused at their place, or said.

use cosfly_domain::Town;
use cosfly_maps::formats::opendrive::RoadMap;
use cosfly_town::MapError;

const STREET: &str = include_str!("../src/formats/opendrive/every_feature.xodr");

const TREE: &str = "<object id=\"30\" type=\"tree\" s=\"25\" t=\"-8.5\" zOffset=\"0\" radius=\"0.2\" height=\"10\"/>\n";

fn with(from: &str, to: &str) -> String {
    assert!(STREET.contains(from), "`{from}` is in the test file");
    STREET.replacen(from, to, 1)
}

fn read(text: &str) -> Result<(Town, Vec<String>), MapError> {
    use cosfly_frames::Seed;
    let config = cosfly_maps::MapConfig::default();
    cosfly_maps::read_town(text.as_bytes(), &config, Seed::of_item(1, "town", "town"))
}

#[test]
fn elements_that_may_be_there_once_are_refused_the_second_time() {
    let reference = "<geoReference><![CDATA[+proj=tmerc]]></geoReference>";
    for (from, to, name) in [
        ("<road name", "\n<header name=\"again\"/>\n<road name", "header"),
        (reference, &format!("{reference}\n{reference}"), "geoReference"),
        (reference, "<offset x=\"1\" y=\"2\"/>\n<offset x=\"3\" y=\"4\"/>", "offset"),
        ("<elevationProfile>", "\n<planView/>\n<elevationProfile>", "planView"),
        ("<lateralProfile>", "\n<elevationProfile/>\n<lateralProfile>", "elevationProfile"),
        ("<lanes>", "\n<lateralProfile/>\n<lanes>", "lateralProfile"),
        ("<objects>", "\n<lanes/>\n<objects>", "lanes"),
        ("<left>", "<left/>\n<left>", "left"),
        ("<center><lane id=\"0\" type=\"none\"/>", "<center/>\n<center><lane id=\"0\" type=\"none\"/>", "center"),
    ] {
        let text = with(from, to);
        let error = read(&text).unwrap_err();
        assert!(error.message.contains(&format!("a second `<{name}>`")), "{error}");
        let place = error.place.unwrap();
        let own = &text[place.byte_span.clone()];
        assert!(own.starts_with(&format!("<{name}")) && place.line > 1 && place.column > 0, "{own}");
        assert!(error.hints[0].contains("the first one in line"), "{:?}", error.hints);
    }
    let error = read(&with("<line/>", "<line/><arc curvature=\"0.1\"/>")).unwrap_err();
    assert!(error.message.contains("a second shape"), "{error}");
}

#[test]
fn what_the_reader_copes_with_is_a_warning_with_its_line() {
    let road = STREET.find("<road name").unwrap();
    let (head, roads) = STREET.split_at(road);
    let twice = format!("{head}{}{roads}", roads.replace("</OpenDRIVE>", ""));
    let width = "<width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/>";
    for (text, expected) in [
        (twice, "has the same `id`; both are read"),
        (
            with(width, &format!("{width}<width sOffset=\"0\" a=\"2\" b=\"0\" c=\"0\" d=\"0\"/>")),
            "a second `<width>` at",
        ),
        (with("sOffset=\"0\" a=\"3.5\"", "sOffset=\"0\" a=\"-3.5\""), "widths below 0 count as 0"),
        (with("<lane id=\"2\" type=\"curb\"", "<lane id=\"7\" type=\"curb\""), "lane `2` is missing"),
        (with("<lane id=\"2\" type=\"curb\"", "<lane id=\"1\" type=\"curb\""), "a repeated id"),
        (
            with("<laneSection s=\"100\">", "<laneSection s=\"100\"><center/></laneSection><laneSection s=\"100\">"),
            "a second lane section at the same `s`",
        ),
        (with("<planView>", "<planViews/><planView>"), "`<planViews>` in `<road>` is no element that is read"),
        (with("<planView>", "<include file=\"more.xml\"/><planView>"), "the file `more.xml` is not followed"),
        (
            with("<object id=\"4\"", &format!("{TREE}{}<object id=\"4\"", TREE.replace("id=\"30\"", "id=\"31\""))),
            "the `<object>` of line 56 is there again; both are read",
        ),
        (with("sOffset=\"0\" inner=\"0.12\"", "sOffset=\"10\" inner=\"0.12\""), "a second `<height>` at the same"),
        (
            with("type=\"driving\"><width sOffset=\"0\" a=\"4\" b=\"0.01\" c=\"0\" d=\"0\"/>", "type=\"driving\">"),
            "it is 0 m wide",
        ),
        (
            with("<height sOffset=\"0\"", "<speed max=\"fast\"/><height sOffset=\"0\""),
            "no limit of 0.5 to 150 m/s; it counts as",
        ),
        (with("<height sOffset=\"0\"", "<speed max=\"999\" unit=\"mph\"/><height sOffset=\"0\""), "`max` is `999`"),
        (with("<height sOffset=\"0\"", "<speed max=\"9\" unit=\"kmh\"/><height sOffset=\"0\""), "m/s is assumed"),
        (
            with("<height sOffset=\"0\"", "<speed max=\"9\"/><speed max=\"8\"/><height sOffset=\"0\""),
            "a second `<speed>`",
        ),
        (
            with(
                "<planView>",
                "<type s=\"0\"><speed max=\"9\"/></type><type s=\"0\"><speed max=\"8\"/></type><planView>",
            ),
            "a second `<type>` at the same `s` has another limit",
        ),
        (with("width=\"8\" height=\"15\"", "width=\"-8\" height=\"15\""), "`width` is -8 m; a size below 0 counts as"),
        (
            with("height=\"0.6\" width=\"0.6\"", "height=\"60\" width=\"0.6\""),
            "`height` is 60 m; a plate or light is at most 5 m",
        ),
        (with("+proj=tmerc", "+proj=tmerc +units=us-ft"), "`+units=us-ft` is not read"),
        (
            with("</geoReference>", "</geoReference><userData code=\"geoOffset\" value=\"393706 5815132\"/>"),
            "is not applied",
        ),
    ] {
        let (_, warnings) = read(&text).unwrap();
        let said = warnings.iter().find(|warning| warning.contains(expected));
        let said = said.unwrap_or_else(|| panic!("`{expected}` in {warnings:?}"));
        assert!(said.starts_with("line "), "{said}");
    }
    // Limits in words and sizes that are unknown are nothing to say.
    for (from, to) in [
        ("<height sOffset=\"0\"", "<speed max=\"no limit\"/><speed sOffset=\"5\" max=\"8\"/><height sOffset=\"0\""),
        ("width=\"8\" height=\"15\"", "width=\"-1\" height=\"15\""),
    ] {
        assert_eq!(read(&with(from, to)).unwrap().1, Vec::<String>::new(), "{to}");
    }
    // The same record twice, and other programs' data, are nothing to say.
    let same = with(width, &format!("{width}{width}<userData code=\"colour\" value=\"3\"/>"));
    assert_eq!(read(&same).unwrap().1, Vec::<String>::new());
}

#[test]
fn geometries_in_any_order_are_the_same_road() {
    let geometries: Vec<&str> = STREET.lines().filter(|line| line.trim().starts_with("<geometry")).collect();
    let (first, second) = (geometries[0], geometries[1]);
    let swapped = STREET.replacen(first, "@", 1).replacen(second, first, 1).replacen('@', second, 1);
    let (expected, _) = RoadMap::read(STREET.as_bytes()).unwrap();
    let (found, warnings) = RoadMap::read(swapped.as_bytes()).unwrap();
    assert_eq!(found.network.roads[0].plan, expected.network.roads[0].plan);
    assert!(warnings.len() == 1 && warnings[0].contains("the geometries are sorted"), "{warnings:?}");
}

#[test]
fn a_reference_after_other_content_of_its_element_is_read() {
    let text = with("<![CDATA[+proj=tmerc]]>", "<userData code=\"a\"/>\n <![CDATA[+proj=tmerc]]>\n");
    assert_eq!(read(&text).unwrap().0.origin.geo_reference.as_deref(), Some("+proj=tmerc"));
}
