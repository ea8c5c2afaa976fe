//! Time and memory of a textured mesh: `bench_mesh [MILLIONS OF TRIANGLES]`, a hilly square kilometre around an invented town; CPU time.

#[path = "../tests/small_town/mod.rs"]
mod small_town;

use cosfly_frames::{DVec3, Pose, Seed, real};
use cosfly_models::mesh::{MeshConfig, MeshMaterial, MeshTriangle, TexturedMesh};
use cosfly_render::{FrameParts, FrameSetup, RenderConfig, Renderer, Scene, SceneMesh, SceneScan};
use std::sync::Arc;
use std::time::Instant;

/// Side of the mesh, metres.
const SIDE_M: f64 = 1000.0;

fn main() {
    let millions: f64 = std::env::args().nth(1).and_then(|it| it.parse().ok()).unwrap_or(3.0);
    let cells = (5e5 * millions).sqrt() as usize;
    let town = small_town::small_town(4, 1);
    let started = Instant::now();
    let lap = |what: &str, since: Instant, frames: u32| {
        println!("{what:28} {:9.1} ms", since.elapsed().as_secs_f64() * 1e3 / f64::from(frames));
    };
    let mesh = hills(cells);
    lap("mesh made", started, 1);
    let started = Instant::now();
    let mesh = SceneMesh::new(mesh, &MeshConfig::new("hills.glb"), &town);
    lap("ordered and labelled, once", started, 1);
    let triangles = mesh.triangles();
    let path: Vec<DVec3> = (0..300).map(|at| DVec3::new(f64::from(at) - 150.0, 20.0, 15.0)).collect();
    let started = Instant::now();
    let away_m = mesh.clearance_m(&path, 5.0);
    lap("distance of a flight", started, 1);
    let scan = SceneScan { mesh: Some(Arc::new(mesh)), ..SceneScan::default() };
    let scene = Scene::new(&town, Seed([1; 32])).with_scan(scan);
    let weather = cosfly_materials::presets::clear_noon();
    let mut renderer = Renderer::new(RenderConfig::default().camera());
    for (name, away) in
        [("follow", [-17.0, -10.0, 20.0]), ("high", [40.0, -60.0, 120.0]), ("street", [-14.0, -8.0, 5.0])]
    {
        for (part, parts) in [("all channels", FrameParts::All), ("depth and ids", FrameParts::Ids)] {
            let mut draw = |frame: u32| {
                let feet = DVec3::new(0.2 * f64::from(frame), 13.0, 1.0);
                let pose = Pose::looking_at(feet + DVec3::from_array(away), feet);
                _ = renderer.render_parts(
                    &scene,
                    &FrameSetup { pose, weather: &weather, target: None, others: &[] },
                    parts,
                );
            };
            draw(0);
            let started = Instant::now();
            (0..10).for_each(draw);
            lap(&format!("{name}, {part}, a frame"), started, 10);
        }
    }
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find(|line| line.starts_with("VmHWM")).unwrap_or_default();
    println!("{triangles} triangles; {away_m:.2} m; {peak}");
}

/// Hills of two colours.
fn hills(cells: usize) -> TexturedMesh {
    let side_m = SIDE_M / cells as f64;
    let point = |column: usize, row: usize| {
        let [x, y] = [column, row].map(|at| at as f64 * side_m - 0.5 * SIDE_M);
        let height = real::sin_cos(0.11 * x).0 * real::sin_cos(0.07 * y).0 + 0.1 * real::sin_cos(3.1 * x + y).0;
        [x as f32, y as f32, height as f32]
    };
    let mut mesh = TexturedMesh {
        materials: vec![MeshMaterial { colour: [0.4, 0.5, 0.3, 1.0], texture: None, least_alpha: None }],
        ..TexturedMesh::default()
    };
    for row in 0..cells {
        for column in 0..cells {
            let [a, b, c, d] =
                [point(column, row), point(column + 1, row), point(column + 1, row + 1), point(column, row + 1)];
            let shade = 128 + ((row ^ column) & 127) as u8;
            mesh.triangles.extend([[a, b, c], [a, c, d]].map(|corners_in_world| MeshTriangle {
                corners_in_world,
                texture_places: [[0.0; 2]; 3],
                colours: [[shade; 3]; 3],
                material: 0,
            }));
        }
    }
    mesh
}
