//! Terrain under the streets of a whole town.

use cosfly_domain::{SemanticLabel, SurfaceMesh, Town};
use cosfly_frames::Seed;
use cosfly_maps::{MapConfig, read_town};
use cosfly_town::GroundIndex;

fn downtown() -> Town {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../recipes/towns/downtown.xodr");
    read_town(&std::fs::read(path).unwrap(), &MapConfig::default(), Seed([0; 32])).unwrap().0
}

/// Whether a mesh is invented ground: lawn, or bare in courts.
fn is_terrain(mesh: &SurfaceMesh) -> bool {
    mesh.synthetic && matches!(mesh.label, SemanticLabel::Terrain | SemanticLabel::Ground)
}

/// Heights of pavements and roads above the terrain, at the corners and middles of their flat triangles.
fn heights_above_terrain_m(town: &Town, label: SemanticLabel) -> Vec<f64> {
    let terrain = GroundIndex::of_surfaces(&town.surfaces, is_terrain);
    let meshes = town.surfaces.iter().filter(|mesh| mesh.label == label);
    let triangles = meshes.flat_map(|mesh| {
        mesh.triangles.iter().map(|triangle| triangle.map(|corner| mesh.vertices_in_world[corner as usize]))
    });
    let flat = triangles.filter(|[a, b, c]| {
        let normal = (*b - *a).cross(*c - *a);
        normal.z.abs() > 0.9 * normal.length() && normal.length() > 1e-6
    });
    flat.flat_map(|[a, b, c]| [a, b, c, (a + b + c) / 3.0])
        .map(|point| point.z - terrain.ground_height_m(point.x, point.y).unwrap())
        .collect()
}

#[test]
fn terrain_lies_closely_below_pavements_and_never_above_anything_paved() {
    let town = downtown();
    for label in [SemanticLabel::Roads, SemanticLabel::SideWalks] {
        let mut above_m = heights_above_terrain_m(&town, label);
        above_m.sort_by(f64::total_cmp);
        let share = |part: f64| above_m[((above_m.len() - 1) as f64 * part) as usize];
        println!(
            "{label:?}: least {:.3} m, median {:.3} m, 95 of 100 below {:.3} m, most {:.3} m",
            share(0.0),
            share(0.5),
            share(0.95),
            share(1.0)
        );
        assert!(share(0.0) > 0.1, "{label:?}: terrain comes up to {} m", share(0.0));
        if label == SemanticLabel::SideWalks {
            assert!(share(0.5) < 0.3 && share(0.95) < 0.5, "{} {}", share(0.5), share(0.95));
        }
    }
    let count: usize = town.surfaces.iter().filter(|mesh| is_terrain(mesh)).map(|mesh| mesh.triangles.len()).sum();
    println!("{count} triangles of terrain");
}
