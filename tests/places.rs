//! Maps that state their place in several parts, and maps that are too wide or lack something: what `cosfly map inspect` shows.

use crate::support::cosfly;
use serde_json::Value;
use std::path::Path;

/// A street of 120 m in UTM with an offset in its header, and a house of OpenStreetMap 12 m north of its middle.
const STREET: &str = r#"<?xml version="1.0"?>
<OpenDRIVE>
  <header revMajor="1" revMinor="5" name="offset">
    <geoReference><![CDATA[+proj=utm +zone=33 +datum=WGS84 +units=m +no_defs]]></geoReference>
    <offset x="393706" y="5815132" z="0" hdg="0"/>
  </header>
  <road length="120" id="1" junction="-1">
    <planView><geometry s="0" x="39.802" y="99.897" hdg="0" length="120"><line/></geometry></planView>
    <lanes><laneSection s="0">
      <left><lane id="2" type="sidewalk"><width sOffset="0" a="3"/></lane><lane id="1" type="driving"><width sOffset="0" a="4"/></lane></left>
      <center><lane id="0" type="none"/></center>
      <right><lane id="-1" type="driving"><width sOffset="0" a="4"/></lane><lane id="-2" type="sidewalk"><width sOffset="0" a="3"/></lane></right>
    </laneSection></lanes>
  </road>
</OpenDRIVE>
"#;
const HOUSE: &str = r#"<osm version="0.6">
 <node id="1" lat="52.47700590" lon="13.43624900"/><node id="2" lat="52.47700979" lon="13.43654336"/>
 <node id="3" lat="52.47711763" lon="13.43653953"/><node id="4" lat="52.47711374" lon="13.43624517"/>
 <way id="1"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="4"/><nd ref="1"/><tag k="building" v="yes"/><tag k="height" v="9"/></way>
</osm>
"#;

fn inspect(folder: &Path, arguments: &[&str]) -> Result<Value, String> {
    let printed = cosfly(&[&["map", "inspect", "--json"], arguments].concat()).within(folder).run();
    match printed.code {
        Some(0) => Ok(serde_json::from_str(&printed.stdout).expect("JSON")),
        // Where lines are broken is no matter of these tests.
        _ => Err(printed.stderr.split_whitespace().collect::<Vec<_>>().join(" ")),
    }
}

#[test]
fn a_house_of_a_further_file_stands_beside_the_street_whose_header_has_an_offset() {
    let folder = tempfile::tempdir().expect("scratch");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
    write("street.xodr", STREET);
    write("house.osm", HOUSE);
    let more = r#"more=[{source="house.osm"}]"#;
    let town = inspect(folder.path(), &["street.xodr", "--set", more]).unwrap();
    let size = |axis: usize| town["max_m"][axis].as_f64().unwrap() - town["min_m"][axis].as_f64().unwrap();
    // The street and the ground around it.
    assert!(size(0) < 260.0 && size(1) < 260.0, "{town}");
    assert_eq!(town["offset_m"], serde_json::json!([393706.0, -5815132.0, 0.0]));
    assert_eq!(
        (&town["obstacles"]["Building"]["objects"], &town["warnings"]),
        (&1.into(), &Value::from(Vec::<Value>::new()))
    );

    // Without the offset the house is another town's: both files, the distance and a way out are named.
    write(
        "street.xodr",
        &STREET.replace("<offset", "<!-- offset").replace("hdg=\"0\"/>\n  </header>", "-->\n  </header>"),
    );
    let refusal = inspect(folder.path(), &["street.xodr", "--set", more]).unwrap_err();
    for words in ["`house.osm`", "street.xodr", "5828", "km away", "shift_m"] {
        assert!(refusal.contains(words), "`{words}` in {refusal}");
    }
    let more = r#"more=[{source="house.osm", shift_m=[99.8, 117.9, 0]}]"#;
    assert!(inspect(folder.path(), &["street.xodr", "--set", more]).is_ok());
}

/// People and cars on a slope, and a flight behind one of each.
const SLOPE: &str = r#"
name = "slope"
[stages.town]
use = "map"
source = "slope.json"
[stages.street]
use = "traffic"
inputs.town = "town"
frames = 40
people.count = 60
vehicles.count = 12
follow = { count = 2, kinds = ["pedestrian", "runner"] }
people.kinds.runner = 0.3
[stages.expert]
use = "plan"
inputs = { town = "town", walks = "street" }
[stages.frames]
use = "render"
inputs = { town = "town", trajectories = "expert", others = "street" }
width = 96
height = 64
[stages.dataset]
use = "dataset"
inputs = { town = "town", frames = "frames" }
name = "slope"
title = "slope"
description = "slope"
"#;

#[test]
fn the_steepest_hillside_is_walked_flown_filmed_and_verified_and_a_steeper_one_is_refused() {
    let folder = tempfile::tempdir().expect("scratch");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
    let slope = |percent: u32| {
        let town = format!(r#"{{"size_m": 220, "steepest_percent": {percent}}}"#);
        write(
            "slope.json",
            &format!(r#"{{"format": "cosfly-generated/1", "seed": 9, "place": "hillside", "town": {town}}}"#),
        );
    };
    write("slope.toml", SLOPE);
    slope(16);
    let town = inspect(folder.path(), &["slope.json"]).unwrap();
    let rise_m = town["max_m"][2].as_f64().unwrap() - town["min_m"][2].as_f64().unwrap();
    assert!(rise_m > 30.0, "{rise_m} m");
    for arguments in [["run", "slope.toml", "--out", "out"].as_slice(), &["verify", "out"]] {
        let printed = cosfly(arguments).within(folder.path()).run();
        assert_eq!(printed.code, Some(0), "{}", printed.stderr);
        assert!(!printed.stderr.contains("rejected: expert"), "{}", printed.stderr);
    }
    slope(30);
    let refusal = inspect(folder.path(), &["slope.json"]).unwrap_err();
    assert!(refusal.contains("`town.steepest_percent` of the place `hillside` is 30, out of its range"), "{refusal}");
    assert!(refusal.contains("it must be 3 to 16"), "{refusal}");
}

#[test]
fn a_map_shows_what_it_lacks_and_bounds_cut_it() {
    let folder = tempfile::tempdir().expect("scratch");
    std::fs::write(folder.path().join("street.xodr"), STREET).expect("written");
    let town = inspect(folder.path(), &["street.xodr"]).unwrap();
    assert!(town["advice"][0].as_str().unwrap().contains("`fill.buildings = true`"), "{town}");
    let filled = inspect(folder.path(), &["street.xodr", "--set", "fill.buildings=true"]).unwrap();
    assert_eq!(filled["advice"], Value::from(Vec::<Value>::new()));

    let cut = inspect(folder.path(), &["street.xodr", "--set", "bounds_m=[60, -120, 120, -80]"]).unwrap();
    let area_m2 = |name: &str| cut["walkable"]["Sidewalk"][name].as_f64().unwrap();
    assert!((area_m2("area_m2") - area_m2("synthetic_area_m2") - 2.0 * 3.0 * 60.0).abs() < 1.0, "{cut}");
    for (bounds, expected) in [
        ("bounds_m=[0, 0, -5, 5]", "smallest x and y, then largest x and y"),
        ("bounds_m=[0, 0, 1e23, 5]", "it must be at most `1000000000` in magnitude"),
        ("bounds_m=[5000, 5000, 6000, 6000]", "nothing of the town lies within"),
    ] {
        let refusal = inspect(folder.path(), &["street.xodr", "--set", bounds]).unwrap_err();
        assert!(refusal.contains(expected), "`{expected}` in {refusal}");
    }
}
