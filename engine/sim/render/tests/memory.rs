//! Memory stays flat over ten thousand frames.

mod small_town;

use cosfly_domain::{Camera, Lens, MotionBlur, Noise, RollingShutter};
use cosfly_figures::{BodyFigure, BodyShape};
use cosfly_frames::{DVec3, Pose, Seed, TargetState, real};
use cosfly_render::{Effects, Moment, Neighbours, Renderer, Scene, Shot};

/// Resident memory of this process in kB, where the system tells.
fn resident_kb() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

#[test]
fn ten_thousand_frames_take_no_more_memory_than_a_thousand() {
    if resident_kb().is_none() {
        println!("skipped: this system does not tell its resident memory");
        return;
    }
    let scene = Scene::new(&small_town::small_town(2, 5), Seed([1; 32]));
    let camera = Camera { width: 64, height: 48, horizontal_fov_rad: 1.2 };
    let noise = Noise { gaussian: 2.0, shot: 1.0 };
    let mut effects = Effects::new(camera, Lens::brown(-0.1, 0.0), MotionBlur::default(), RollingShutter::default());
    effects.set_noise(noise);
    let mut renderer = Renderer::new(effects.ideal_camera());
    let weathers =
        ["ClearNoon", "HardRainNight"].map(|name| cosfly_materials::presets::preset(name).expect("a preset"));
    let mut early_kb = 0;
    for frame in 0..10_000u32 {
        let (sin, cos) = real::sin_cos(0.01 * f64::from(frame));
        let feet = DVec3::new(20.0 * cos, 20.0 * sin, 0.1);
        let moment = |_: f64| Moment {
            pose: Pose::looking_at(feet + DVec3::new(-9.0 * sin, 9.0 * cos, 8.0), feet),
            target: Some(BodyFigure {
                state: TargetState { feet_in_world: feet, heading_rad: 0.0, speed_mps: 1.0 },
                height_m: 1.8,
                radius_m: 0.3,
                clothes_seed: Seed([2; 32]),
                gait_phase_rad: 0.1 * f64::from(frame),
                body: BodyShape::default(),
            }),
        };
        let noise_seed = Seed([3; 32]).child("frame", u64::from(frame));
        let shot = Shot {
            weather: &weathers[(frame / 100 % 2) as usize],
            moment: &moment,
            others: &|_, _| {},
            neighbours: Neighbours::default(),
            noise_seed,
        };
        effects.film(&mut renderer, &scene, &shot);
        if frame == 1_000 {
            early_kb = resident_kb().unwrap_or(0);
        }
    }
    let grown_kb = resident_kb().unwrap_or(0).saturating_sub(early_kb);
    println!("{early_kb} kB after 1,000 frames, {grown_kb} kB more after 10,000");
    assert!(grown_kb < 4_096, "{grown_kb} kB more after 10,000 frames");
}
