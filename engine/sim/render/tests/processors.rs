//! Frames have the same bytes on every processor and with any number of threads.

mod small_town;

use cosfly_domain::{Camera, FrameImages, Season, SemanticLabel, Weather};
use cosfly_figures::{BodyFigure, BodyShape};
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, Pose, Seed, TargetState};
use cosfly_render::{FrameSetup, PictureLook, Renderer, Scene};

const CAMERA: Camera = Camera { width: 333, height: 187, horizontal_fov_rad: 1.4 };

fn draw(renderer: &mut Renderer, scene: &Scene, weather: &str) -> FrameImages {
    let weather = Weather { sun_azimuth_angle: 215.0, ..cosfly_materials::presets::preset(weather).expect("a preset") };
    let feet = DVec3::new(5.0, -16.0, 0.1);
    let target = BodyFigure {
        state: TargetState { feet_in_world: feet, heading_rad: 0.4, speed_mps: 1.3 },
        height_m: 1.8,
        radius_m: 0.3,
        clothes_seed: Seed([2; 32]),
        gait_phase_rad: 0.8,
        body: BodyShape::default(),
    };
    let pose = Pose::looking_at(feet + DVec3::new(-16.0, 5.0, 7.0), feet + 2.0 * DVec3::Z);
    renderer.render(scene, &FrameSetup { pose, weather: &weather, target: Some(target), others: &[] }).images.clone()
}

#[test]
fn all_vector_instructions_give_the_same_bytes() {
    let scene = Scene::new(&small_town::small_town(4, 5), Seed([1; 32]));
    for weather in ["ClearNoon", "HardRainSunset", "WetNight", "DustStorm"] {
        let mut renderer = Renderer::new(CAMERA);
        for look in [PictureLook::Full, PictureLook::Simple] {
            renderer.set_look(look);
            renderer.set_level(Level::PLAIN);
            let plain = draw(&mut renderer, &scene, weather);
            for level in Level::available() {
                renderer.set_level(level);
                assert!(draw(&mut renderer, &scene, weather) == plain, "{weather} {look:?} with {}", level.name());
            }
        }
    }
}

#[test]
fn seasons_change_colours_only_on_every_processor() {
    let scene = |season| Scene::new(&small_town::small_town(4, 5), Seed([1; 32])).in_season(Some(season));
    let mut renderer = Renderer::new(CAMERA);
    let summer = draw(&mut renderer, &scene(Season::Summer), "ClearNoon");
    for season in [Season::Autumn, Season::Winter] {
        let scene = scene(season);
        renderer.set_level(Level::best());
        let drawn = draw(&mut renderer, &scene, "ClearNoon");
        assert_eq!((&drawn.depth_m, &drawn.semantic), (&summer.depth_m, &summer.semantic), "{season:?}");
        assert_eq!(drawn.instance, summer.instance, "{season:?}");
        let is_crown = |at: usize| summer.semantic[at] == SemanticLabel::Vegetation.id();
        let pixels = drawn.rgb.chunks_exact(3).zip(summer.rgb.chunks_exact(3)).enumerate();
        let crowns: Vec<_> = pixels.filter(|(at, _)| is_crown(*at)).map(|(_, (a, b))| a != b).collect();
        let changed = crowns.iter().filter(|changed| **changed).count();
        assert!(3 * changed > crowns.len() && !crowns.is_empty(), "{season:?}: {changed} of {}", crowns.len());
        for level in Level::available() {
            renderer.set_level(level);
            assert!(draw(&mut renderer, &scene, "ClearNoon") == drawn, "{season:?} with {}", level.name());
        }
    }
}

#[test]
fn the_simple_look_changes_colours_only() {
    let scene = Scene::new(&small_town::small_town(4, 5), Seed([1; 32]));
    for weather in ["ClearNoon", "HardRainSunset", "WetNight"] {
        let mut renderer = Renderer::new(CAMERA);
        let full = draw(&mut renderer, &scene, weather);
        renderer.set_look(PictureLook::Simple);
        let simple = draw(&mut renderer, &scene, weather);
        assert_eq!((&simple.depth_m, &simple.semantic), (&full.depth_m, &full.semantic), "{weather}");
        assert_eq!(simple.instance, full.instance, "{weather}");
        let away = |a: &u8, b: &u8| f64::from(a.abs_diff(*b));
        let mean = full.rgb.iter().zip(&simple.rgb).map(|(a, b)| away(a, b)).sum::<f64>() / full.rgb.len() as f64;
        assert!(mean > 1.0 && mean < 40.0, "{weather}: {mean} of 255 apart");
        renderer.set_look(PictureLook::Full);
        assert!(draw(&mut renderer, &scene, weather) == full, "{weather}: the full look after the simple one");
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let scene = Scene::new(&small_town::small_town(4, 5), Seed([1; 32]));
    let alone = draw(&mut Renderer::new(CAMERA), &scene, "SoftRainNight");
    for threads in [1, 2, 5] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let mut renderer = Renderer::new(CAMERA);
        renderer.set_parallel(true);
        assert!(pool.install(|| draw(&mut renderer, &scene, "SoftRainNight")) == alone, "{threads}");
        let mut simple = Renderer::new(CAMERA);
        simple.set_look(PictureLook::Simple);
        let alone = draw(&mut simple, &scene, "SoftRainNight");
        renderer.set_look(PictureLook::Simple);
        assert!(pool.install(|| draw(&mut renderer, &scene, "SoftRainNight")) == alone, "{threads}, simple");
    }
}
