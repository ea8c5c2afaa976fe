//! Splats in pictures: bodies among splats, shadows on them; labels and depth stay those of the geometry.

mod small_town;

use cosfly_domain::{Camera, ChannelSet, FrameImages, SemanticLabel, TARGET_INSTANCE, Weather};
use cosfly_figures::{BodyFigure, BodyShape};
use cosfly_frames::{DVec3, Pose, Seed, TargetState};
use cosfly_render::{FrameSetup, Renderer, Scene, SceneScan, SceneSplats};
use cosfly_scans::up_axis::UpAxis;
use cosfly_splats::{Splat, SplatCloud, SplatsConfig};
use std::sync::Arc;

const CAMERA: Camera = Camera { width: 320, height: 180, horizontal_fov_rad: 1.2 };
const FEET: DVec3 = DVec3::new(-8.0, 13.5, 0.14);

fn scene() -> Scene {
    Scene::new(&small_town::small_town(2, 1), Seed([1; 32]))
}

fn config() -> SplatsConfig {
    SplatsConfig::new("street.ply", UpAxis::Z)
}

fn cloud_of(splats: &[Splat]) -> SplatCloud {
    let mut cloud = SplatCloud::new(0);
    splats.iter().for_each(|splat| cloud.push(splat));
    cloud
}

fn with_splats(splats: &[Splat], config: &SplatsConfig) -> Scene {
    let splats = SceneSplats::new(cloud_of(splats), config, DVec3::ZERO).expect("a place");
    scene().with_scan(SceneScan { splats: Some(Arc::new(splats)), ..SceneScan::default() })
}

fn look_at(from: DVec3) -> Pose {
    Pose::looking_at(FEET + from, FEET + DVec3::Z)
}

fn draw(scene: &Scene, pose: Pose, has_target: bool) -> FrameImages {
    drawn(scene, pose, has_target, &noon()).0
}

fn noon() -> Weather {
    Weather { sun_azimuth_angle: 200.0, ..cosfly_materials::presets::clear_noon() }
}

/// A frame, and the share of the target that its pixels show.
fn drawn(scene: &Scene, pose: Pose, has_target: bool, weather: &Weather) -> (FrameImages, f64) {
    let target = BodyFigure {
        state: TargetState { feet_in_world: FEET, heading_rad: 0.1, speed_mps: 1.4 },
        height_m: 1.75,
        radius_m: 0.3,
        clothes_seed: Seed([9; 32]),
        gait_phase_rad: 1.2,
        body: BodyShape::default(),
    };
    let mut renderer = Renderer::new(CAMERA);
    renderer.set_optics(cosfly_domain::Optics::IDEAL);
    renderer.set_channels(&ChannelSet::of(|channel| !channel.is_on_request() || channel.name == "normals"));
    let target = has_target.then_some(target);
    let frame = renderer.render(scene, &FrameSetup { pose, weather, target, others: &[] });
    (frame.images.clone(), frame.target_view.visible_by_pixels)
}

/// A level or upright sheet of white splats around a place of the world.
fn sheet(middle: DVec3, along: [DVec3; 2]) -> Vec<Splat> {
    let places = (-12..=12).flat_map(|x| (-12..=12).map(move |y| (f64::from(x), f64::from(y))));
    let splat = |(x, y)| {
        let at: DVec3 = middle + along[0] * x + along[1] * y;
        Splat::plain([at.x as f32, -at.y as f32, at.z as f32], [0.08; 3], [1.0, 0.0, 0.0, 0.0], 0.95, [1.0; 3])
    };
    places.map(splat).collect()
}

/// Mean of the colours of some pixels.
fn brightness(images: &FrameImages, pixels: &[usize]) -> f64 {
    let sum: f64 = pixels.iter().flat_map(|at| &images.rgb[3 * at..3 * at + 3]).map(|byte| f64::from(*byte)).sum();
    sum / (3 * pixels.len()) as f64
}

fn of_target(images: &FrameImages) -> Vec<usize> {
    (0..images.instance.len()).filter(|at| images.instance[*at] == TARGET_INSTANCE).collect()
}

#[test]
fn bodies_stand_among_splats_and_labels_say_who_is_seen() {
    let pose = look_at(DVec3::new(-6.0, 0.0, 1.5));
    let across = [DVec3::Y * 0.1, DVec3::Z * 0.1];
    let behind = with_splats(&sheet(FEET + DVec3::new(1.5, 0.0, 1.0), across), &config());
    let before = with_splats(&sheet(FEET + DVec3::new(-1.5, 0.0, 1.0), across), &config());
    let plain = draw(&scene(), pose, true);
    let pixels = of_target(&plain);
    assert!(pixels.len() > 200, "{}", pixels.len());
    let ((behind, seen_before_it), (before, seen_behind_it)) =
        (drawn(&behind, pose, true, &noon()), drawn(&before, pose, true, &noon()));
    assert!(behind.depth_m == plain.depth_m && behind.instance == plain.instance, "geometry");
    assert!(behind.semantic == plain.semantic && behind.on_request == plain.on_request, "geometry");
    assert!(seen_before_it > 0.99 && seen_behind_it < 0.01, "{seen_before_it} {seen_behind_it}");
    for at in 0..plain.instance.len() {
        let is_hidden = before.instance[at] != plain.instance[at];
        assert!(!is_hidden || plain.instance[at] == TARGET_INSTANCE && before.instance[at] == 0, "pixel {at}");
        // The sheet stands 1.5 m before the feet, and its labels lie on it.
        assert!(!is_hidden || before.semantic[at] == SemanticLabel::Static.id(), "pixel {at}");
        assert!(!is_hidden || (plain.depth_m[at] - before.depth_m[at] - 1.5).abs() < 0.5, "pixel {at}");
        assert!(is_hidden || before.depth_m[at] == plain.depth_m[at], "pixel {at}");
    }
    assert!((brightness(&behind, &pixels) - brightness(&plain, &pixels)).abs() < 12.0);
    assert!(brightness(&before, &pixels) > 235.0);
    // What is beside the body shows the sheet in both.
    let beside: Vec<usize> =
        pixels.iter().map(|at| at + 25).filter(|at| plain.instance[*at] != TARGET_INSTANCE).collect();
    assert!(brightness(&behind, &beside) > 235.0 && brightness(&before, &beside) > 235.0);
}

#[test]
fn shadows_of_bodies_fall_on_splats_and_exposure_is_a_key() {
    let pose = look_at(DVec3::new(-5.0, -3.0, 6.0));
    let ground = sheet(FEET, [DVec3::X * 0.25, DVec3::Y * 0.25].map(|way| way * 0.5));
    let scene = with_splats(&ground, &config());
    let (with, without) = (draw(&scene, pose, true), draw(&scene, pose, false));
    let is_ground = |at: &usize| with.instance[*at] == 0;
    let darker = |at: &usize| brightness(&without, &[*at]) > 225.0 && brightness(&with, &[*at]) < 200.0;
    let shadow = (0..with.instance.len()).filter(is_ground).filter(darker).count();
    assert!(shadow > 60, "{shadow} pixels in the shadow");
    let dark = with_splats(&ground, &SplatsConfig { exposure_ev: -2.0, ..config() });
    let lit: Vec<usize> = (0..with.instance.len()).filter(|at| brightness(&without, &[*at]) > 225.0).collect();
    assert!(brightness(&draw(&dark, pose, false), &lit) < 160.0);
}

#[test]
fn the_camera_exposes_splats_and_bodies_alike() {
    let pose = look_at(DVec3::new(-6.0, 0.0, 1.5));
    let grey: Vec<Splat> = sheet(FEET + DVec3::new(1.5, 0.0, 1.0), [DVec3::Y * 0.1, DVec3::Z * 0.1])
        .into_iter()
        .map(|splat| Splat::plain(splat.middle, splat.spread, splat.turn, 0.99, [0.5; 3]))
        .collect();
    let scene = with_splats(&grey, &config());
    let taken = |exposure_ev: f64, white_balance_k: f64| {
        let mut renderer = Renderer::new(CAMERA);
        renderer.set_optics(cosfly_domain::Optics { exposure_ev, white_balance_k, ..cosfly_domain::Optics::IDEAL });
        renderer.render(&scene, &FrameSetup { pose, weather: &noon(), target: None, others: &[] }).images.clone()
    };
    let middle = 3 * (CAMERA.width * CAMERA.height / 2 + CAMERA.width / 2) as usize;
    let at = |images: &FrameImages| [0, 1, 2].map(|k| f64::from(images.rgb[middle + k]));
    let light = |code: f64| cosfly_frames::real::powf((code / 255.0 + 0.055) / 1.055, 2.4);
    let [plain, darker, warm] = [taken(0.0, 6500.0), taken(-1.0, 6500.0), taken(0.0, 4500.0)].map(|images| at(&images));
    assert!((plain[0] - 128.0).abs() < 6.0, "{plain:?}");
    assert!((light(darker[1]) / light(plain[1]) - 0.5).abs() < 0.03, "{plain:?} {darker:?}");
    assert!(
        warm[0] < plain[0] - 4.0 && warm[2] > plain[2] + 4.0 || warm[0] > plain[0] + 4.0 && warm[2] < plain[2] - 4.0,
        "{warm:?}"
    );
}

#[test]
fn thin_splats_before_a_body_leave_it_its_labels() {
    let pose = look_at(DVec3::new(-6.0, 0.0, 1.5));
    let thin: Vec<Splat> = sheet(FEET + DVec3::new(-1.5, 0.0, 1.0), [DVec3::Y * 0.1, DVec3::Z * 0.1])
        .into_iter()
        .map(|splat| Splat { opacity: 0.08, ..splat })
        .collect();
    let (plain, thin) = (draw(&scene(), pose, true), draw(&with_splats(&thin, &config()), pose, true));
    assert!(plain.instance == thin.instance && plain.depth_m == thin.depth_m && plain.semantic == thin.semantic);
    assert!(plain.rgb != thin.rgb);
}

#[test]
fn haze_lies_before_far_splats_and_rain_falls_before_all() {
    let pose = look_at(DVec3::new(-40.0, 0.0, 12.0));
    let wall = sheet(FEET + DVec3::new(0.0, 0.0, 1.0), [DVec3::Y * 0.1, DVec3::Z * 0.1]);
    let black: Vec<Splat> = wall
        .into_iter()
        .map(|splat| Splat::plain(splat.middle, splat.spread, splat.turn, splat.opacity, [0.0; 3]))
        .collect();
    let scene = with_splats(&black, &config());
    let clear = draw(&scene, pose, false);
    let dark: Vec<usize> = (0..clear.instance.len()).filter(|at| brightness(&clear, &[*at]) < 12.0).collect();
    assert!(dark.len() > 100, "{}", dark.len());
    let in_air = |weather: Weather| drawn(&scene, pose, false, &weather).0;
    let haze = in_air(Weather { fog_density: 60.0, ..noon() });
    assert!(haze.depth_m == clear.depth_m && haze.semantic == clear.semantic && haze.instance == clear.instance);
    let denser = in_air(Weather { fog_density: 100.0, ..noon() });
    let [none, some, more] = [&clear, &haze, &denser].map(|images| brightness(images, &dark));
    assert!(none < 12.0 && some > none + 25.0 && more > some + 10.0, "{none} {some} {more}");
    // As dry days have it, haze is in the scan's own colours.
    assert!(in_air(Weather { fog_density: 3.0, ..noon() }).rgb.iter().zip(&clear.rgb).all(|(a, b)| a.abs_diff(*b) < 9));
    let rain = in_air(Weather { precipitation: 80.0, ..noon() });
    let streaks = dark.iter().filter(|at| brightness(&rain, &[**at]) > brightness(&clear, &[**at]) + 20.0).count();
    assert!(streaks > 5 && rain.depth_m == clear.depth_m, "{streaks}");
}
