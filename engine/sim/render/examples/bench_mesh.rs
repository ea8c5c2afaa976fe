//! Time and memory of a textured mesh: `bench_mesh [MILLIONS OF TRIANGLES]`, a hilly square kilometre around an invented town.

#[path = "../tests/small_town/mod.rs"]
mod small_town;

use cosfly_frames::{DVec3, Pose, Seed, real};
use cosfly_models::mesh::{MeshConfig, MeshMaterial, MeshTriangle, TexturedMesh};
use cosfly_render::{FrameSetup, RenderConfig, Renderer, Scene, SceneMesh, SceneScan, Stages};
use std::sync::Arc;
use std::time::Instant;

/// Side of the mesh, metres.
const SIDE_M: f64 = 1000.0;
const FRAMES: u32 = 10;

fn main() {
    let millions: f64 = std::env::args().nth(1).and_then(|it| it.parse().ok()).unwrap_or(3.0);
    let cells = (5e5 * millions).sqrt() as usize;
    let town = small_town::small_town(4, 1);
    let started = Instant::now();
    let lap = |what: &str, since: Instant| println!("{what:28} {:9.1} ms", since.elapsed().as_secs_f64() * 1e3);
    let mesh = hills(cells);
    lap("mesh made", started);
    let started = Instant::now();
    let mesh = SceneMesh::new(mesh, &MeshConfig::new("hills.glb"), &town);
    lap("ordered and labelled, once", started);
    let triangles = mesh.triangles();
    let path: Vec<DVec3> = (0..300).map(|at| DVec3::new(f64::from(at) - 150.0, 20.0, 15.0)).collect();
    let started = Instant::now();
    let away_m = mesh.clearance_m(&path, 5.0);
    lap("distance of a flight", started);
    let scan = SceneScan { mesh: Some(Arc::new(mesh)), ..SceneScan::default() };
    let scene = Scene::new(&town, Seed([1; 32])).with_scan(scan);
    let weather = cosfly_materials::presets::clear_noon();
    let mut renderer = Renderer::new(RenderConfig::default().camera());
    let now = || cpu_ns(started);
    println!("{:14}{} CPU ms a frame", "", Stages::NAMES.map(|name| format!("{name:>10}")).join(""));
    for (name, away) in
        [("follow", [-17.0, -10.0, 20.0]), ("high", [40.0, -60.0, 120.0]), ("street", [-14.0, -8.0, 5.0])]
    {
        let mut sum = [0; Stages::NAMES.len()];
        for frame in 0..=FRAMES {
            let feet = DVec3::new(0.2 * f64::from(frame), 13.0, 1.0);
            let pose = Pose::looking_at(feet + DVec3::from_array(away), feet);
            let setup = FrameSetup { pose, weather: &weather, target: None, others: &[] };
            let (_, stages) = renderer.render_timed(&scene, &setup, &now);
            // Shadow maps are drawn in the first one.
            if frame > 0 {
                sum.iter_mut().zip(stages.ns()).for_each(|(sum, ns)| *sum += ns);
            }
        }
        let each = sum.map(|ns| format!("{:10.1}", ns as f64 * 1e-6 / f64::from(FRAMES))).join("");
        println!("{name:14}{each}{:10.1} in all", sum.iter().sum::<u64>() as f64 * 1e-6 / f64::from(FRAMES));
    }
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find(|line| line.starts_with("VmHWM")).unwrap_or_default();
    println!("{triangles} triangles; {away_m:.2} m; {peak}");
}

/// CPU time of this thread, nanoseconds; wall time where the system does not tell.
fn cpu_ns(started: Instant) -> u64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let spent_ns = told.and_then(|text| text.split(' ').next().and_then(|first| first.parse::<u64>().ok()));
    spent_ns.unwrap_or_else(|| started.elapsed().as_nanos() as u64)
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
