//! Thousands of buildings over many kilometres, and a tower of 540 m: every building is there, as high as its file says.

mod wide_town;

use cosfly_domain::{ObstacleKind, Town};
use cosfly_frames::Seed;
use cosfly_maps::{MapConfig, read_town};
use std::collections::BTreeMap;
use std::time::Instant;
use wide_town::{TOWER_M, WideTown};

fn read(name: &str, text: &str) -> Town {
    let start = Instant::now();
    let (town, warnings) = read_town(text.as_bytes(), &MapConfig::default(), Seed::of_item(1, "town", "town")).unwrap();
    println!("{name}: {} boxes in {:.2} s", town.obstacles.len(), start.elapsed().as_secs_f64());
    let (first, others) = warnings.split_first().expect("a wide town has a warning");
    assert!(first.contains("19.7 km long") && first.contains("instead of 4 m"), "{name}: {warnings:?}");
    assert!(others.iter().all(|one| one.starts_with("no streets are invented")), "{name}: {warnings:?}");
    town
}

/// Heights of the buildings' tops, sorted.
fn tops_m(town: &Town) -> Vec<f64> {
    let mut tops: BTreeMap<u32, f64> = BTreeMap::new();
    for one in town.obstacles.iter().filter(|one| one.kind == ObstacleKind::Building) {
        let top = tops.entry(one.object_id).or_insert(f64::NEG_INFINITY);
        *top = top.max(one.shape.bounds_in_world().1.z);
    }
    let mut tops: Vec<f64> = tops.into_values().collect();
    tops.sort_by(f64::total_cmp);
    tops
}

#[test]
fn nine_thousand_buildings_keep_their_heights() {
    let region = WideTown::new(90);
    let mut expected: Vec<f64> = region.houses.iter().map(|house| house.eaves_m + house.rise_m).collect();
    expected.sort_by(f64::total_cmp);
    for (name, text, ground_m) in [("OpenStreetMap", region.osm(), 0.0), ("CityJSON", region.city_json(), 500.0)] {
        let town = read(name, &text);
        let size = town.max_in_world - town.min_in_world;
        assert!(size.min_element() > TOWER_M && size.x > 8_000.0 && size.y > 19_000.0, "{name}: {size}");
        let found = tops_m(&town);
        assert_eq!(found.len(), 9_001, "{name}");
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found - ground_m - expected).abs() < 0.01, "{name}: {found} for {expected}");
        }
        assert!(town.walkable.len() > 500, "{name}");
    }
}
