//! The card and the CPU renderer draw the same town, on any available adapter, Mesa's software renderer included.

#![cfg(feature = "device")]

use cosfly_domain::{Camera, FrameImages, TargetView, Town, WalkableKind, Weather};
use cosfly_figures::{BodyShape, TargetSetup};
use cosfly_frames::{DVec3, Pose, Seed, TargetState};
use cosfly_gpu::GpuBackend;
use cosfly_maps::MapConfig;
use cosfly_maps::generate::{GenerateConfig, generate_town};
use cosfly_render::{Backend, FrameSetup, Renderer, Scene};

const CAMERA: Camera = Camera { width: 640, height: 360, horizontal_fov_rad: 1.5 };

/// The backend, or `None` after printing the reason.
fn backend(camera: Camera) -> Option<GpuBackend> {
    match GpuBackend::new(camera) {
        Ok(backend) => {
            eprintln!("drawing on {}", backend.card_name());
            Some(backend)
        }
        Err(error) => {
            eprintln!("skipped: {error}");
            None
        }
    }
}

fn town() -> Town {
    let text = generate_town(&GenerateConfig::default(), 3);
    cosfly_maps::read_town(text.as_bytes(), &MapConfig::default(), Seed([5; 32])).expect("a generated town is sound").0
}

/// Positions spread over the pavements.
fn places(town: &Town, count: usize) -> Vec<DVec3> {
    let pavements: Vec<_> = town.walkable.iter().filter(|area| area.kind == WalkableKind::Sidewalk).collect();
    (0..count).map(|i| pavements[i * pavements.len() / count].outline_in_world[0]).collect()
}

fn target(feet: DVec3) -> TargetSetup {
    TargetSetup {
        state: TargetState { feet_in_world: feet, heading_rad: 0.4, speed_mps: 1.4 },
        height_m: 1.75,
        radius_m: 0.3,
        clothes_seed: Seed([9; 32]),
        gait_phase_rad: 1.2,
        visible_by_rays: 1.0,
        body: BodyShape::default(),
    }
}

/// Whether a pixel and its neighbours show one object without a jump in depth.
fn is_inside(images: &FrameImages, u: usize, v: usize) -> bool {
    let width = images.width as usize;
    let at = v * width + u;
    (v - 1..=v + 1).flat_map(|v| (u - 1..=u + 1).map(move |u| v * width + u)).all(|other| {
        let (near, far) =
            (images.depth_m[at].min(images.depth_m[other]), images.depth_m[at].max(images.depth_m[other]));
        images.semantic[at] == images.semantic[other]
            && images.instance[at] == images.instance[other]
            && (near == far || far - near < 0.03 * near)
    })
}

fn compare(cpu: (&FrameImages, TargetView), gpu: (&FrameImages, TargetView), what: &str) {
    let ((a, view), (b, other)) = (cpu, gpu);
    let (width, height) = (a.width as usize, a.height as usize);
    let (mut inside, mut worst) = (0, 0.0f32);
    for v in 1..height - 1 {
        for u in (1..width - 1).filter(|u| is_inside(a, *u, v)) {
            let at = v * width + u;
            assert_eq!((a.semantic[at], a.instance[at]), (b.semantic[at], b.instance[at]), "{what}: ids at {u}, {v}");
            if a.depth_m[at] != b.depth_m[at] {
                let allowed = 1e-3 + 1e-5 * a.depth_m[at];
                let apart = (a.depth_m[at] - b.depth_m[at]).abs();
                assert!(apart <= allowed, "{what}: depth {} and {} at {u}, {v}", a.depth_m[at], b.depth_m[at]);
                worst = worst.max(apart);
            }
            inside += 1;
        }
    }
    let differ = |count: usize| 100.0 * count as f64 / (width * height) as f64;
    let ids = (0..width * height).filter(|at| a.semantic[*at] != b.semantic[*at] || a.instance[*at] != b.instance[*at]);
    let ids = differ(ids.count());
    let colours: u64 = a.rgb.iter().zip(&b.rgb).map(|(x, y)| u64::from(x.abs_diff(*y))).sum();
    let colours = colours as f64 / a.rgb.len() as f64;
    eprintln!(
        "{what}: {:.1} % off edges, all ids equal there; {ids:.3} % of all ids differ; depth within {worst} m; colours {colours:.4} of 255 apart",
        differ(inside)
    );
    assert!(differ(inside) > 40.0 && ids < 0.1 && colours < 0.1, "{what}");
    assert!((view.visible_by_pixels - other.visible_by_pixels).abs() < 0.05, "{what}: {view:?} {other:?}");
}

#[test]
fn every_channel_agrees_off_edges() {
    let Some(mut gpu) = backend(CAMERA) else { return };
    let town = town();
    let scene = Scene::new(&town, Seed([1; 32]));
    let mut cpu = Renderer::new(CAMERA);
    for (number, feet) in places(&town, 4).into_iter().enumerate() {
        let preset = ["ClearNoon", "HardRainNoon", "ClearSunset", "ClearNight"][number];
        let mut weather = Weather::preset(preset).expect("a preset");
        weather.sun_azimuth_angle = 215.0;
        for (view, offset) in [("follow", DVec3::new(-17.0, -10.0, 20.0)), ("street", DVec3::new(9.0, -12.0, 4.0))] {
            let pose = Pose::looking_at(feet + offset, feet + DVec3::Z);
            let setup = FrameSetup { pose, weather: &weather, target: Some(target(feet)), others: &[] };
            let drawn = cpu.render(&scene, &setup);
            let other = gpu.render(&scene, &setup).expect("the card draws");
            compare((drawn.images, drawn.target_view), (other.images, other.target_view), &format!("{preset} {view}"));
        }
    }
}

#[test]
fn a_camera_inside_an_obstacle_sees_out_of_it_as_on_the_cpu() {
    let camera = Camera { width: 320, height: 200, ..CAMERA };
    let Some(mut gpu) = backend(camera) else { return };
    let town = town();
    let scene = Scene::new(&town, Seed([1; 32]));
    let inside = town.obstacles.iter().max_by(|a, b| a.shape.half_extents_m.z.total_cmp(&b.shape.half_extents_m.z));
    let center = inside.expect("a town has obstacles").shape.center_in_world;
    let weather = Weather::preset("CloudyNoon").expect("a preset");
    let pose = Pose { position_in_world: center, pitch_rad: -0.2, yaw_rad: 0.7, roll_rad: 0.1 };
    let setup = FrameSetup { pose, weather: &weather, target: None, others: &[] };
    let mut cpu = Renderer::new(camera);
    let drawn = cpu.render(&scene, &setup);
    let other = gpu.render(&scene, &setup).expect("the card draws");
    compare((drawn.images, drawn.target_view), (other.images, other.target_view), "inside");
}

#[test]
fn an_empty_scene_is_sky_and_an_odd_width_is_read_back_whole() {
    let camera = Camera { width: 333, height: 100, horizontal_fov_rad: 1.0 };
    let Some(mut gpu) = backend(camera) else { return };
    let mut town = town();
    town.obstacles.clear();
    town.surfaces.clear();
    let scene = Scene::new(&town, Seed([1; 32]));
    let weather = Weather::preset("ClearNoon").expect("a preset");
    let pose = Pose::looking_at(DVec3::new(0.0, 0.0, 10.0), DVec3::new(20.0, 3.0, 0.0));
    let drawn =
        gpu.render(&scene, &FrameSetup { pose, weather: &weather, target: None, others: &[] }).expect("the card draws");
    assert!(drawn.images.depth_m.iter().all(|depth| depth.is_infinite()));
    assert!(drawn.images.instance.iter().all(|id| *id == 0));
}
