//! Time and memory of a textured mesh: `bench_mesh [MILLIONS OF TRIANGLES]`, a hilly square kilometre around an invented town.

#[path = "../tests/small_town/mod.rs"]
mod small_town;

use cosfly_frames::{DVec3, Pose, Seed, real};
use cosfly_maps::{MapConfig, read_town};
use cosfly_models::mesh::{MeshConfig, TexturedMesh};
use cosfly_render::{FrameSetup, RenderConfig, Renderer, Scene, SceneMesh, SceneScan, Stages};
use serde_json::json;
use std::sync::Arc;
use std::time::Instant;

/// Side of the mesh, metres.
const SIDE_M: f64 = 1000.0;
const FRAMES: u32 = 10;

fn main() {
    let millions: f64 = std::env::args().nth(1).and_then(|it| it.parse().ok()).unwrap_or(3.0);
    let cells = (5e5 * millions).sqrt() as usize;
    let town = small_town::small_town(4, 1);
    let lap = |what: &str, since: Instant| {
        println!("{what:28} {:9.1} ms, {}", since.elapsed().as_secs_f64() * 1e3, peak());
    };
    let started = Instant::now();
    let file = hills(cells);
    lap("file made", started);
    if std::env::args().any(|it| it == "map") {
        let started = Instant::now();
        let config: MapConfig =
            serde_json::from_str(r#"{ "source": "", "options": { "one_surface": true } }"#).expect("a configuration");
        let read = read_town(&file, &config, Seed([1; 32]));
        lap("read as a map", started);
        return println!("{:?}", read.map(|(town, _)| town.obstacles.len()));
    }
    let config = MeshConfig::new("hills.glb");
    let started = Instant::now();
    let mesh = TexturedMesh::read(&file, &[], &config.place(DVec3::ZERO).expect("a place")).expect("a mesh");
    drop(file);
    lap("read", started);
    let started = Instant::now();
    let mesh = SceneMesh::new(mesh, &config, &town);
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
    println!("{triangles} triangles; {away_m:.2} m; {}", peak());
}

/// The most memory that was taken so far.
fn peak() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status.lines().find(|line| line.starts_with("VmHWM")).unwrap_or_default().to_owned()
}

/// CPU time of this thread, nanoseconds; wall time where the system does not tell.
fn cpu_ns(started: Instant) -> u64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let spent_ns = told.and_then(|text| text.split(' ').next().and_then(|first| first.parse::<u64>().ok()));
    spent_ns.unwrap_or_else(|| started.elapsed().as_nanos() as u64)
}

/// Hills as a GLB file with a colour of each corner.
fn hills(cells: usize) -> Vec<u8> {
    let side_m = SIDE_M / cells as f64;
    let corners = cells + 1;
    let count = corners * corners;
    let mut data = Vec::with_capacity(16 * count + 24 * cells * cells);
    for (row, column) in (0..corners).flat_map(|row| (0..corners).map(move |column| (row, column))) {
        let [x, y] = [column, row].map(|at| at as f64 * side_m - 0.5 * SIDE_M);
        let height = real::sin_cos(0.11 * x).0 * real::sin_cos(0.07 * y).0 + 0.1 * real::sin_cos(3.1 * x + y).0;
        [x, height, y].iter().for_each(|it| data.extend((*it as f32).to_le_bytes()));
    }
    (0..count).for_each(|at| data.extend([100 + (at & 63) as u8, 140, 90, 255]));
    for (row, column) in (0..cells).flat_map(|row| (0..cells).map(move |column| (row, column))) {
        let [a, d] = [row, row + 1].map(|row| (row * corners + column) as u32);
        [a, a + 1, d + 1, a, d + 1, d].iter().for_each(|corner| data.extend(corner.to_le_bytes()));
    }
    let places = [0, 12 * count, 16 * count, data.len()];
    let views: Vec<_> =
        places.windows(2).map(|it| json!({ "buffer": 0, "byteOffset": it[0], "byteLength": it[1] - it[0] })).collect();
    let mut text = json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "COLOR_0": 1 }, "indices": 2 }] }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5121, "count": count, "type": "VEC4", "normalized": true },
            { "bufferView": 2, "componentType": 5125, "count": 6 * cells * cells, "type": "SCALAR" },
        ],
        "bufferViews": views, "buffers": [{ "byteLength": data.len() }],
    })
    .to_string();
    text.push_str(&"   "[..text.len().next_multiple_of(4) - text.len()]);
    let number = |of: usize| (of as u32).to_le_bytes();
    let whole = number(28 + text.len() + data.len());
    [b"glTF\x02\0\0\0", &whole[..], &number(text.len()), b"JSON", text.as_bytes(), &number(data.len()), b"BIN\0", &data]
        .concat()
}
