//! Walks on real towns: CARLA's own and a surveyed city. Skipped where the shared data is absent.

use cosfly_domain::{Town, WalkableKind};
use cosfly_frames::{DVec2, DVec3, Seed};
use cosfly_maps::{MapConfig, read_town};
use cosfly_pedestrians::{PedestrianConfig, PedestrianPath, WalkableGrid, walk};
use shared::shared_input;
use std::path::{Path, PathBuf};

#[path = "../../../../tests/shared.rs"]
mod shared;

/// Distance in plan from a point to the nearest obstacle that a body would meet there.
fn free_m(town: &Town, walked: &PedestrianPath, frame: usize) -> f64 {
    let feet = walked.track.states[frame].feet_in_world;
    let meets = |shape: &cosfly_domain::OrientedBox| {
        let (low, high) = shape.bounds_in_world();
        low.z < feet.z + walked.track.height_m && high.z > feet.z + 0.1
    };
    let solid = town.obstacles.iter().filter(|thing| meets(&thing.shape));
    solid.fold(f64::INFINITY, |least, thing| {
        let offset = feet.truncate() - thing.shape.center_in_world.truncate();
        let (sin, cos) = cosfly_frames::real::sin_cos(thing.shape.yaw_rad);
        let own = DVec2::new(cos * offset.x + sin * offset.y, cos * offset.y - sin * offset.x);
        least.min((own.abs() - thing.shape.half_extents_m.truncate()).max(DVec2::ZERO).length())
    })
}

/// Walks of one town: on its ground, off its things, and most of them somewhere.
fn check_town(name: &str, path: Option<PathBuf>, config: &MapConfig) {
    const WALKS: u32 = 20;
    let Some(path) = path else { return };
    let bytes = std::fs::read(path).expect("the map can be read");
    let town = read_town(&bytes, config, Seed::of_item(1, "town", "town")).unwrap().0;
    let config = PedestrianConfig::default();
    let grid = WalkableGrid::build(&town, &config).unwrap();
    let (mut ended, mut crossed, mut way_m) = (0, 0, 0.0);
    for item in 0..WALKS {
        let walked = walk(&grid, &config, Seed::of_item(7, "walkers", &format!("p{item}"))).unwrap();
        assert_eq!(walked.track.len(), 200);
        for (frame, state) in walked.track.states.iter().enumerate() {
            let feet = state.feet_in_world;
            assert!(feet.is_finite());
            assert!(grid.ground().at(feet.truncate(), feet.z).is_some(), "{name}: p{item} frame {frame} at {feet}");
            let free = free_m(&town, &walked, frame);
            assert!(free >= walked.track.radius_m - 1e-9, "{name}: p{item} frame {frame} at {feet}: {free} m");
        }
        ended += usize::from(walked.standing[170..].iter().all(|standing| *standing));
        let on_road = |kind: &WalkableKind| matches!(kind, WalkableKind::Crossing | WalkableKind::Road);
        crossed += usize::from(walked.ground.iter().any(on_road));
        way_m += walked.track.length_m() / f64::from(WALKS);
    }
    println!(
        "{name}: {} polygons, {} things, {} cells, {} pieces; mean way {way_m:.0} m, {crossed} of {WALKS} cross a road",
        town.walkable.len(),
        town.obstacles.len(),
        grid.len(),
        grid.piece_extents_m().len(),
    );
    assert!(ended == 0 && way_m > 100.0, "{name}: {ended} walks end standing, mean way {way_m} m");
}

#[test]
fn carla_towns_are_walked() {
    for file in ["Town01.xodr", "Town03_2019-04.xodr", "Town04.xodr", "Town07.xodr"] {
        check_town(file, shared_input(&format!("carla_xodr/{file}")), &MapConfig::default());
    }
}

#[test]
fn filled_towns_are_walked_between_their_trees() {
    let mut config = MapConfig::default();
    (config.fill.buildings, config.fill.trees) = (true, true);
    check_town("Town01.xodr, filled", shared_input("carla_xodr/Town01.xodr"), &config);
}

#[test]
fn a_surveyed_city_is_walked() {
    let name = "Ingolstadt_CityHall.xodr";
    check_town(name, shared_input(&format!("xodr_city/{name}")), &MapConfig::default());
}

#[test]
fn our_own_town_is_walked() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../recipes/towns/downtown.xodr");
    check_town("downtown.xodr", Some(path), &MapConfig::default());
}

#[test]
fn a_town_without_pavements_is_walked_on_its_shoulders() {
    check_town("Town06.xodr, shoulders", shared_input("carla_xodr/Town06.xodr"), &MapConfig::default());
}

#[test]
fn who_walks_on_invented_streets_of_a_point_cloud_does_not_sink_into_drawn_ground() {
    let name = "lidar/test_semis_2021_0382_6565_LA93_IGN69_cropped.laz";
    let Some(path) = shared_input(name) else { return };
    let invented = MapConfig { streets: Some(cosfly_maps::Streets::Invented), ..MapConfig::default() };
    let town = read_town(&std::fs::read(path).unwrap(), &invented, Seed::of_item(1, "town", "town")).unwrap().0;
    let (drawn, config) = (cosfly_town::GroundIndex::new(&town), PedestrianConfig::default());
    let grid = WalkableGrid::build(&town, &config).unwrap();
    let (mut places, mut below, mut above) = (0, 0, 0);
    for polygon in &town.walkable {
        let middle = polygon.outline_in_world.iter().sum::<DVec3>() / polygon.outline_in_world.len() as f64;
        let inwards = |corner: &DVec3| [0.2, 0.5, 0.8].map(|share| corner.lerp(middle, share));
        for place in polygon.outline_in_world.iter().flat_map(inwards) {
            let Some((_, z)) = grid.ground().at(place.truncate(), place.z) else { continue };
            let Some(seen) = drawn.ground_seen(place.truncate().extend(z), 1.5) else { continue };
            places += 1;
            below += usize::from(seen.height_m - z > 0.08);
            above += usize::from(z - seen.height_m > 0.3);
        }
    }
    assert!(
        places > 10_000 && 400 * below < places && 400 * above < places,
        "{below} below, {above} above, of {places}"
    );
}
