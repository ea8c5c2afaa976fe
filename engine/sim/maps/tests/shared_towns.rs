//! Real map files of `../shared`: each is read, is well formed and has what it is known to have.

use cosfly_domain::{ObstacleKind, SemanticLabel, SurfaceMesh, Town, WalkableKind};
use cosfly_frames::{DVec2, DVec3, Seed};
use cosfly_maps::formats::opendrive::{OpenDriveOptions, Roofs};
use cosfly_maps::{MapConfig, read_town};
use cosfly_town::polygons::contains;
use cosfly_town::{FormatOptions, GroundIndex, MapError};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

#[path = "../../../../tests/shared.rs"]
mod shared;

fn try_read(path: &Path, options: &MapConfig) -> Result<(Town, Vec<String>), MapError> {
    read_town(&std::fs::read(path).expect("the listed file can be read"), options, Seed::of_item(1, "town", "town"))
}

fn read(path: &Path, options: &MapConfig) -> Town {
    try_read(path, options).unwrap_or_else(|error| panic!("{}: {error}", path.display())).0
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = ["carla_xodr", "xodr_city"]
        .iter()
        .flat_map(|sub| std::fs::read_dir(folder.join(sub)).expect("the data folder is complete"))
        .map(|entry| entry.expect("the data folder can be listed").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "xodr"))
        .collect();
    files.sort();
    files
}

fn with_shoulders() -> MapConfig {
    let options = OpenDriveOptions { shoulders_as_sidewalks: true, ..OpenDriveOptions::default() };
    MapConfig { options: FormatOptions::of(&options), ..MapConfig::default() }
}

/// Share of walkable area in the largest connected part, on a half-metre grid.
fn largest_part(town: &Town) -> f64 {
    const CELL_M: f64 = 0.5;
    let low = town.min_in_world.truncate();
    let size = town.max_in_world.truncate() - low;
    let [columns, rows] = size.to_array().map(|side| (side / CELL_M) as usize + 2);
    let mut open = vec![false; columns * rows];
    for polygon in &town.walkable {
        let plan = polygon.plan();
        let cell = |point: DVec2| ((point - low) / CELL_M).floor().max(DVec2::ZERO);
        let from = cell(plan.iter().copied().fold(DVec2::INFINITY, DVec2::min));
        let to = cell(plan.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max));
        for row in from.y as usize..=to.y as usize {
            for column in from.x as usize..=to.x as usize {
                let center = low + CELL_M * DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
                open[row * columns + column] |= contains(&plan, center);
            }
        }
    }
    let total = open.iter().filter(|is_open| **is_open).count();
    let mut largest = 0;
    for start in 0..open.len() {
        let (mut size, mut stack) = (0, vec![start]);
        while let Some(cell) = stack.pop() {
            if core::mem::take(&mut open[cell]) {
                size += 1;
                let around = [cell.wrapping_sub(1), cell + 1, cell.wrapping_sub(columns), cell + columns];
                stack.extend(around.into_iter().filter(|next| *next < columns * rows));
            }
        }
        largest = largest.max(size);
    }
    largest as f64 / total.max(1) as f64
}

/// The terrain lies below every road and pavement, and pavement polygons lie on the ground.
fn check_ground(town: &Town) {
    let is_terrain =
        |mesh: &SurfaceMesh| matches!(mesh.label, SemanticLabel::Terrain | SemanticLabel::Ground) && mesh.synthetic;
    let terrain = GroundIndex::of_surfaces(&town.surfaces, is_terrain);
    for mesh in
        town.surfaces.iter().filter(|mesh| matches!(mesh.label, SemanticLabel::Roads | SemanticLabel::SideWalks))
    {
        for triangle in mesh.triangles.iter().step_by(7) {
            let [a, b, c] = triangle.map(|corner| mesh.vertices_in_world[corner as usize]);
            // Faces of kerbs and skirts reach down below the terrain: only the tops count.
            if (b - a).truncate().perp_dot((c - a).truncate()).abs() < 1e-6 {
                continue;
            }
            for point in [a, b, c, (a + b + c) / 3.0] {
                let below_m = terrain.ground_height_m(point.x, point.y).expect("the terrain is everywhere");
                assert!(below_m < point.z - 0.1, "terrain at {below_m} pokes through the road at {point}");
            }
        }
    }
    let ground = GroundIndex::new(town);
    let pavements = town.walkable.iter().filter(|polygon| polygon.kind == WalkableKind::Sidewalk && !polygon.synthetic);
    let corners: Vec<_> = pavements.flat_map(|polygon| &polygon.outline_in_world).collect();
    let on_ground =
        |corner: &DVec3| ground.ground_near(*corner).is_some_and(|found| (found.height_m - corner.z).abs() < 0.1);
    let count = corners.iter().filter(|corner| on_ground(corner)).count();
    // Where a lane ends in a point its last triangles have no width and no ground.
    assert!(count as f64 >= 0.99 * corners.len() as f64, "{count} of {} corners lie on the ground", corners.len());
}

#[test]
fn terrain_stays_below_roads_and_pavements_lie_on_the_ground() {
    let Some(folder) = shared::shared_input("") else { return };
    for name in [
        "carla_xodr/Town01.xodr",
        "carla_xodr/Town04.xodr",
        "carla_xodr/Town07.xodr",
        "xodr_city/Ingolstadt_CityHall.xodr",
    ] {
        println!("{name}");
        check_ground(&read(&folder.join(name), &MapConfig::default()));
    }
}

#[test]
fn walkable_ground_hangs_together() {
    let Some(folder) = shared::shared_input("") else { return };
    for (name, least) in [
        ("carla_xodr/Town01.xodr", 0.99),
        ("carla_xodr/Town03_2019-04.xodr", 0.95),
        ("carla_xodr/Town04.xodr", 0.9),
        ("carla_xodr/Town07.xodr", 0.9),
        ("xodr_city/Ingolstadt_CityHall.xodr", 0.9),
    ] {
        let share = largest_part(&read(&folder.join(name), &MapConfig::default()));
        println!("{name}: {share:.3} of the walkable ground in its largest part");
        assert!(share >= least, "{name}: {share}");
    }
}

#[test]
fn towns_without_pavements_are_walked_beside_their_carriageways() {
    let Some(folder) = shared::shared_input("") else { return };
    let town = read(&folder.join("carla_xodr/Town06.xodr"), &MapConfig::default());
    assert!(town.walkable.iter().filter(|polygon| polygon.kind == WalkableKind::Shoulder).count() > 100);
    assert!(town.synthetic.notes.iter().any(|note| note.contains("use the road shoulders")));
    for name in ["Junction_with_building0", "Weird_looking_building_road_coord", "stationary_objects"] {
        let town = read(&folder.join(format!("xodr_city/esmini_{name}.xodr")), &MapConfig::default());
        check_ground(&town);
        assert!(!town.walkable.is_empty() && town.walkable.iter().all(|polygon| polygon.synthetic), "{name}");
        let notes = &town.synthetic.notes;
        println!("{name}: {notes:?}, {:.3} of the walkable ground in its largest part", largest_part(&town));
        assert!(notes.iter().any(|note| note.contains("2 m wide, beside the carriageways")), "{name}: {notes:?}");
    }
}

#[test]
fn the_surveyed_city_keeps_its_buildings_trees_and_lamps() {
    let Some(folder) = shared::shared_input("") else { return };
    let town = read(&folder.join("xodr_city/Ingolstadt_CityHall.xodr"), &MapConfig::default());
    let things = |kind| {
        let ids = town.obstacles.iter().filter(|obstacle| obstacle.kind == kind).map(|obstacle| obstacle.object_id);
        ids.collect::<std::collections::BTreeSet<_>>().len()
    };
    // 123 objects of type building, of which 4 are bus stops.
    assert_eq!(
        (things(ObstacleKind::Building), things(ObstacleKind::TreeTrunk), things(ObstacleKind::Lamp)),
        (119, 117, 40)
    );
    assert!(town.origin.offset_m.length() > 1e6 && town.max_in_world.abs().max_element() < 1e3);
}

#[test]
fn roofs_of_the_surveyed_city_are_guessed_above_the_eaves() {
    let Some(folder) = shared::shared_input("") else { return };
    let path = folder.join("xodr_city/Ingolstadt_CityHall.xodr");
    let tops = |roofs| {
        let options = OpenDriveOptions { roofs, ..OpenDriveOptions::default() };
        let town = read(&path, &MapConfig { options: FormatOptions::of(&options), ..MapConfig::default() });
        let mut tops: BTreeMap<u32, f64> = BTreeMap::new();
        for one in town.obstacles.iter().filter(|obstacle| obstacle.kind == ObstacleKind::Building) {
            let top_m = one.shape.center_in_world.z + one.shape.half_extents_m.z;
            tops.entry(one.object_id).and_modify(|top| *top = top.max(top_m)).or_insert(top_m);
        }
        tops.into_values().collect::<Vec<f64>>()
    };
    let (flat, pitched) = (tops(Roofs::Flat), tops(Roofs::Auto));
    let mut rises: Vec<f64> = pitched.iter().zip(&flat).map(|(high, low)| high - low).collect();
    rises.sort_by(f64::total_cmp);
    // The city's own model has its roofs 4.3 m above the stated heights in the median.
    let median_m = rises[rises.len() / 2];
    println!("rises: median {median_m:.2} m, {:.2} to {:.2} m", rises[0], rises[rises.len() - 1]);
    assert!((3.3..5.3).contains(&median_m), "{median_m}");
}

fn triangles(town: &Town) -> usize {
    town.surfaces.iter().map(|mesh| mesh.triangles.len()).sum()
}

#[test]
fn every_shared_town_reads_and_is_well_formed() {
    let Some(folder) = shared::shared_input("") else { return };
    for path in files(&folder) {
        let name = path.file_name().expect("a file has a name").to_string_lossy().into_owned();
        let start = Instant::now();
        let (town, warnings) = match try_read(&path, &with_shoulders()) {
            Ok(done) => done,
            Err(error) => {
                println!("{name}: refused: {error}");
                assert!(name.starts_with("esmini_"), "only some samples have no ground to walk on");
                continue;
            }
        };
        let seconds = start.elapsed().as_secs_f64();
        let kinds =
            town.obstacles.iter().fold(BTreeMap::new(), |mut counts: BTreeMap<ObstacleKind, usize>, obstacle| {
                *counts.entry(obstacle.kind).or_default() += 1;
                counts
            });
        println!(
            "{name}: {seconds:.2} s, {} walkable (largest part {:.3}), {} triangles, {} obstacles {kinds:?}, {} boxes",
            town.walkable.len(),
            largest_part(&town),
            triangles(&town),
            town.obstacles.len(),
            town.planning_boxes.len(),
        );
        for line in warnings.iter().chain(&town.synthetic.notes) {
            println!("    {line}");
        }
        town.assert_well_formed().expect("read towns are well formed");
    }
}
