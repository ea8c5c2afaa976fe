//! CPU time per 1280 x 720 frame, split by stage, on a town of about 3,000 boxes and 100,000 ground triangles.

#[path = "../tests/small_town/mod.rs"]
mod small_town;

use cosfly_frames::{DVec3, Pose, Seed, TargetState};
use cosfly_render::{FrameParts, FrameSetup, RenderConfig, Renderer, Scene, TargetSetup, Weather};
use std::time::Instant;

fn main() {
    let mut town = small_town::small_town(9, 1);
    refine(&mut town, 100_000);
    let started = Instant::now();
    let start = cpu_ms(started);
    let scene = Scene::new(&town, Seed([1; 32]));
    println!("{} boxes, {} triangles with faces", town.obstacles.len(), scene.triangles().len());
    println!("scene                    {:8.2} ms once", cpu_ms(started) - start);
    let mut weather = Weather::preset("ClearNoon").expect("a preset");
    weather.sun_azimuth_angle = 215.0;
    let mut renderer = Renderer::new(RenderConfig::default().camera());
    let frames: Vec<(Pose, TargetSetup)> = (0..20).map(frame).collect();
    for (name, parts) in [
        ("visibility", FrameParts::Visibility),
        ("visibility, depth, ids", FrameParts::Ids),
        ("everything", FrameParts::All),
    ] {
        let start = cpu_ms(started);
        for (pose, target) in frames.iter().chain(&frames) {
            let setup = FrameSetup { pose: *pose, weather: &weather, target: Some(*target) };
            let _ = renderer.render_parts(&scene, &setup, parts);
        }
        println!("{name:24} {:8.2} ms a frame", (cpu_ms(started) - start) / (2.0 * frames.len() as f64));
    }
}

/// CPU time of this thread, milliseconds; wall time where the system does not tell.
fn cpu_ms(started: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let spent_ns = told.and_then(|text| text.split(' ').next().and_then(|first| first.parse::<f64>().ok()));
    spent_ns.map_or_else(|| started.elapsed().as_secs_f64() * 1e3, |ns| ns * 1e-6)
}

/// A follower 20 m behind and above a target that walks along a street.
fn frame(index: u32) -> (Pose, TargetSetup) {
    let feet = DVec3::new(-30.0 + 0.7 * f64::from(index), 43.5, 0.14);
    let target = TargetSetup {
        state: TargetState { feet_in_world: feet, heading_rad: 0.1, speed_mps: 1.4 },
        height_m: 1.75,
        radius_m: 0.3,
        clothes_seed: Seed([9; 32]),
        gait_phase_rad: 0.4 * f64::from(index),
        visible_by_rays: 1.0,
    };
    (Pose::looking_at(feet + DVec3::new(-17.0, -10.0, 20.0), feet), target)
}

/// Cuts ground triangles until there are at least `wanted`.
fn refine(town: &mut cosfly_maps::Town, wanted: usize) {
    while town.surfaces.iter().map(|mesh| mesh.triangles.len()).sum::<usize>() < wanted {
        for mesh in &mut town.surfaces {
            let mut finer = Vec::with_capacity(2 * mesh.triangles.len());
            for [a, b, c] in core::mem::take(&mut mesh.triangles) {
                let middle = 0.5 * (mesh.vertices_in_world[b as usize] + mesh.vertices_in_world[c as usize]);
                mesh.vertices_in_world.push(middle);
                mesh.along_across_m.push(mesh.along_across_m[b as usize]);
                let m = (mesh.vertices_in_world.len() - 1) as u32;
                finer.extend([[m, a, b], [m, c, a]]);
            }
            mesh.triangles = finer;
        }
    }
}
