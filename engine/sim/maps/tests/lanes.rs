//! Lanes of vehicles: linked as the files' own links say, in the direction of traffic.

use cosfly_domain::{LaneKind, Town};
use cosfly_frames::Seed;
use cosfly_maps::{MapConfig, read_town};
use cosfly_places::grid::{GenerateConfig, generate_town};
use std::collections::BTreeMap;

#[path = "../../../../tests/shared.rs"]
mod shared;

fn town(bytes: &[u8]) -> Town {
    read_town(bytes, &MapConfig::default(), Seed([1; 32])).unwrap().0
}

/// Driven lanes that come together in each connecting road, by the links of the file: for each junction road the number of
/// its lanes that have a predecessor and a successor.
fn linked_lanes(text: &str) -> usize {
    let document = roxmltree::Document::parse(text).unwrap();
    let roads = document.root_element().children().filter(|node| node.has_tag_name("road"));
    let inner = roads.filter(|road| road.attribute("junction") != Some("-1"));
    let lanes = inner.flat_map(|road| road.descendants().filter(|node| node.has_tag_name("lane")));
    let driven = lanes.filter(|lane| lane.attribute("type") == Some("driving"));
    let has = |lane: &roxmltree::Node<'_, '_>, end: &str| lane.descendants().any(|node| node.has_tag_name(end));
    driven.filter(|lane| has(lane, "predecessor") && has(lane, "successor")).count()
}

#[test]
fn generated_towns_have_lanes_whose_followers_are_those_of_the_file() {
    for seed in 0..3 {
        let text = generate_town(&GenerateConfig::default(), seed);
        let town = town(text.as_bytes());
        let mut before = vec![0; town.lanes.len()];
        for lane in &town.lanes {
            assert_eq!(lane.kind, LaneKind::Driving);
            lane.successors.iter().for_each(|next| before[*next as usize] += 1);
        }
        let (mut inner, mut streets) = (0, 0);
        for (lane, before) in town.lanes.iter().zip(before) {
            if lane.in_junction {
                assert_eq!((lane.successors.len(), before), (1, 1), "a way through a junction joins two lanes");
                inner += 1;
            } else {
                assert!(!lane.successors.is_empty() && before > 0, "a street leads from junction to junction");
                assert!((lane.speed_limit_mps - 13.89).abs() < 1e-9 && lane.width_m > 3.0);
                assert_eq!(lane.crossings.len(), 2, "one crossing at either end");
                streets += 1;
            }
        }
        assert_eq!(inner, linked_lanes(&text));
        assert!(streets > 50, "{streets}");
    }
}

#[test]
fn traffic_keeps_to_the_right_and_to_the_left_where_the_file_says_so() {
    let text = generate_town(&GenerateConfig::default(), 1);
    let right = town(text.as_bytes());
    let left = town(text.replace("junction=\"", "rule=\"LHT\" junction=\"").as_bytes());
    let ends = |town: &Town| -> BTreeMap<[i64; 3], usize> {
        let key = |point: cosfly_frames::DVec3| (point * 100.0).round().to_array().map(|at| at as i64);
        town.lanes.iter().map(|lane| key(lane.middle_in_world[0])).fold(BTreeMap::new(), |mut all, key| {
            *all.entry(key).or_default() += 1;
            all
        })
    };
    assert_eq!(right.lanes.len(), left.lanes.len());
    for (one, other) in right.lanes.iter().zip(&left.lanes) {
        assert!(one.middle_in_world.iter().eq(other.middle_in_world.iter().rev()));
    }
    assert_ne!(ends(&right), ends(&left));
}

#[test]
fn lanes_of_real_files_lead_on() {
    let Some(folder) = shared::shared_input("") else { return };
    for (file, least) in
        [("carla_xodr/Town01.xodr", 0.99), ("carla_xodr/Town03_2019-04.xodr", 0.9), ("osm/krems.osm.gz", 0.7)]
    {
        let Ok(bytes) = std::fs::read(folder.join(file)) else { panic!("{file} is not there") };
        let town = town(&bytes);
        let led_on = town.lanes.iter().filter(|lane| !lane.successors.is_empty()).count() as f64;
        let share = led_on / town.lanes.len() as f64;
        println!(
            "{file}: {} lanes, {:.1} km, {share:.3} lead on",
            town.lanes.len(),
            town.lanes.iter().map(|it| it.length_m()).sum::<f64>() / 1e3
        );
        assert!(share >= least, "{file}: {share}");
    }
}
