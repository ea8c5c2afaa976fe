//! Filled towns: nothing invented stands on a street, everything is flagged, and real towns fill quickly.

use super::*;
use crate::{MapConfig, read_town};
use cosfly_domain::{Obstacle, ObstacleKind, OrientedBox, SemanticLabel, SurfaceMesh};
use cosfly_frames::DVec2;
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_places::grid::{GenerateConfig, generate_town};
use cosfly_town::GroundIndex;
use cosfly_town::polygons::triangulated;

#[path = "../../../../../tests/shared.rs"]
mod shared;

fn seed() -> Seed {
    Seed::of_item(1, "town", "fill")
}

fn everything() -> FillConfig {
    FillConfig { buildings: true, trees: true, lamps: true, ..FillConfig::default() }
}

/// Our own town with everything solid taken away.
fn bare_town() -> Town {
    let text = generate_town(&GenerateConfig::default(), 4);
    let (mut town, _) = read_town(text.as_bytes(), &MapConfig::default(), seed()).expect("it reads");
    town.obstacles.clear();
    town.synthetic = cosfly_domain::Synthetic::default();
    town
}

fn footprint(shape: &OrientedBox) -> Vec<DVec2> {
    let corners = shape.corners_in_world();
    [0, 1, 3, 2].map(|index| corners[index].truncate()).to_vec()
}

/// Whether two convex polygons overlap by more than a millimetre (separating axes).
fn overlap(a: &[DVec2], b: &[DVec2]) -> bool {
    let sides = |outline: &[DVec2]| -> Vec<DVec2> {
        (0..outline.len()).map(|i| outline[(i + 1) % outline.len()] - outline[i]).collect()
    };
    sides(a).into_iter().chain(sides(b)).filter_map(|side| side.perp().try_normalize()).all(|axis| {
        let span = |outline: &[DVec2]| {
            let at = outline.iter().map(|corner| corner.dot(axis));
            (at.clone().fold(f64::INFINITY, f64::min), at.fold(f64::NEG_INFINITY, f64::max))
        };
        let (first, second) = (span(a), span(b));
        first.0 < second.1 - 1e-3 && second.0 < first.1 - 1e-3
    })
}

/// Every invented thing that touches the ground keeps off streets, walkable ground and everything else.
fn check_nothing_invented_stands_in_the_way(town: &Town) {
    let on_ground = |one: &&Obstacle| one.kind != ObstacleKind::TreeCrown;
    let invented: Vec<&Obstacle> = town.obstacles.iter().filter(|one| one.synthetic).filter(on_ground).collect();
    // Flattened, so that a tree of boxes finds what is near seen from above.
    let flat = |one: &OrientedBox| OrientedBox {
        center_in_world: one.center_in_world.with_z(0.0),
        half_extents_m: one.half_extents_m.with_z(1.0),
        yaw_rad: one.yaw_rad,
    };
    let tree = BoxBvh::build(invented.iter().map(|one| flat(&one.shape)).collect());
    let check = |outline: &[DVec2], what: &str, own: Option<usize>| {
        let low = outline.iter().copied().reduce(DVec2::min).expect("corners");
        let high = outline.iter().copied().reduce(DVec2::max).expect("corners");
        tree.within(low.extend(-1.0), high.extend(1.0), &mut |index| {
            let other = invented[index as usize];
            let is_own = own.is_some_and(|own| own == index as usize);
            assert!(is_own || !overlap(outline, &footprint(&other.shape)), "{other:?} overlaps {what} {outline:?}");
        });
    };
    let is_open = |mesh: &&SurfaceMesh| matches!(mesh.label, SemanticLabel::Terrain | SemanticLabel::Ground);
    for mesh in town.surfaces.iter().filter(|mesh| !is_open(mesh)) {
        for triangle in &mesh.triangles {
            let outline = triangle.map(|corner| mesh.vertices_in_world[corner as usize].truncate());
            check(&outline, mesh.label.name(), None);
        }
    }
    for area in &town.walkable {
        let outline: Vec<DVec2> = area.outline_in_world.iter().map(|corner| corner.truncate()).collect();
        for triangle in triangulated(&outline) {
            check(&triangle.map(|corner| outline[corner as usize]), "walkable ground", None);
        }
    }
    for (index, one) in invented.iter().enumerate() {
        check(&footprint(&one.shape), "another one", Some(index));
    }
    for one in town.obstacles.iter().filter(|one| !one.synthetic) {
        check(&footprint(&one.shape), "the file's own", None);
    }
}

fn count(town: &Town, kind: ObstacleKind) -> usize {
    town.obstacles.iter().filter(|one| one.synthetic && one.kind == kind).count()
}

#[test]
fn a_bare_town_gets_buildings_trees_and_lamps_that_keep_off_its_streets() {
    let mut town = bare_town();
    assert_eq!(fill(&mut town, &everything(), seed()), Vec::<String>::new());
    check_nothing_invented_stands_in_the_way(&town);
    assert!(count(&town, ObstacleKind::Building) > 100, "{}", count(&town, ObstacleKind::Building));
    assert!(count(&town, ObstacleKind::TreeTrunk) > 100 && count(&town, ObstacleKind::Lamp) > 40);
    assert!(town.synthetic.buildings && town.synthetic.trees && town.synthetic.furniture);
    assert_eq!(town.synthetic.notes.len(), 3);
    assert!(town.obstacles.iter().all(|one| one.synthetic));
}

#[test]
fn the_same_seed_fills_alike_and_switches_are_independent() {
    let (mut one, mut same, mut other) = (bare_town(), bare_town(), bare_town());
    fill(&mut one, &everything(), seed());
    fill(&mut same, &everything(), seed());
    fill(&mut other, &everything(), seed().child("other", 0));
    assert_eq!(one, same);
    assert_ne!(one.obstacles, other.obstacles);
    let mut untouched = bare_town();
    assert_eq!(fill(&mut untouched, &FillConfig::default(), seed()), Vec::<String>::new());
    assert_eq!(untouched, bare_town());
    let mut trees = bare_town();
    fill(&mut trees, &FillConfig { trees: true, ..FillConfig::default() }, seed());
    assert!(!trees.synthetic.buildings && trees.synthetic.trees && !trees.synthetic.furniture);
    assert_eq!(count(&trees, ObstacleKind::Building), 0);
}

#[test]
fn what_the_file_has_is_kept_and_stood_clear_of() {
    let text = generate_town(&GenerateConfig::default(), 4);
    let (before, _) = read_town(text.as_bytes(), &MapConfig::default(), seed()).expect("it reads");
    let mut town = before.clone();
    fill(&mut town, &everything(), seed());
    assert_eq!(town.obstacles[..before.obstacles.len()], before.obstacles[..]);
    check_nothing_invented_stands_in_the_way(&town);
    let old_ids = before.obstacles.iter().map(|one| one.object_id).max();
    assert!(town.obstacles.iter().filter(|one| one.synthetic).all(|one| Some(one.object_id) > old_ids));
}

#[test]
fn a_town_without_open_land_gives_a_warning_instead_of_nothing() {
    let mut town = bare_town();
    town.walkable.clear();
    let warnings = fill(&mut town, &everything(), seed());
    assert_eq!(warnings.len(), 3);
    assert!(warnings[0].contains("fill.buildings"), "{warnings:?}");
}

#[test]
fn carla_towns_fill_with_hundreds_of_buildings() {
    for name in ["Town01", "Town03_2019-04", "Town04", "Town06", "Town07"] {
        let Some(path) = shared::shared_input(&format!("carla_xodr/{name}.xodr")) else { continue };
        let config = MapConfig::default();
        let bytes = std::fs::read(path).expect("it can be read");
        let (mut town, _) = read_town(&bytes, &config, seed()).expect("it reads");
        assert_eq!(fill(&mut town, &everything(), seed()), Vec::<String>::new(), "{name}");
        check_nothing_invented_stands_in_the_way(&town);
        let buildings = count(&town, ObstacleKind::Building);
        let trees = count(&town, ObstacleKind::TreeTrunk);
        println!("{name}: {buildings} buildings, {trees} trees, {} lamps", count(&town, ObstacleKind::Lamp));
        assert!((60..3000).contains(&buildings), "{name}: {buildings}");
        // On hills, too, a building stands in the ground and rises above its street.
        let terrain = GroundIndex::of_surfaces(&town.surfaces, |mesh| mesh.label == SemanticLabel::Terrain);
        for one in town.obstacles.iter().filter(|one| one.synthetic && one.kind == ObstacleKind::Building) {
            let (low, high) = one.shape.bounds_in_world();
            let center = one.shape.center_in_world;
            let ground_m = terrain.ground_height_m(center.x, center.y).unwrap_or(low.z);
            assert!(high.z > ground_m + 1.0 && low.z < ground_m + 2.5, "{name}: {one:?} on ground at {ground_m}");
        }
    }
}
