//! Textured meshes in pictures: baked light, cut-outs, bodies and their shadows.

use cosfly_domain::{Camera, FrameImages, Optics, SemanticLabel, TARGET_INSTANCE, Weather};
use cosfly_figures::{BodyFigure, BodyShape};
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec3, Pose, Seed, TargetState};
use cosfly_maps::{MapConfig, read_town};
use cosfly_models::mesh::{MeshConfig, MeshLight, TexturedMesh};
use cosfly_render::{FrameSetup, PictureLook, Renderer, Scene, SceneMesh, SceneScan};
use std::sync::Arc;

const CAMERA: Camera = Camera { width: 320, height: 180, horizontal_fov_rad: 1.2 };
/// On the pavement before the example's house, world axes.
const FEET: DVec3 = DVec3::new(-4.0, 4.0, 0.12);

/// A file as the map and as the mesh of a scene.
fn scene_of(bytes: &[u8], exposure_ev: f64) -> Scene {
    let (town, _) = read_town(bytes, &MapConfig::default(), Seed([5; 32])).expect("a town");
    let config = MeshConfig { exposure_ev, ..MeshConfig::new("scan.glb") };
    let place = config.place(town.origin.offset_m).expect("a place");
    let mesh = TexturedMesh::read(bytes, &[], &place).expect("a mesh");
    let mesh = SceneMesh::new(mesh, &config, &town);
    assert!(mesh.known_share() > 0.99, "{}", mesh.known_share());
    let scan = SceneScan { mesh: Some(Arc::new(mesh)), ..SceneScan::default() };
    Scene::new(&town, Seed([1; 32])).with_scan(scan)
}

fn example() -> Scene {
    scene_of(TexturedMesh::EXAMPLE, 0.0)
}

fn noon(sun_azimuth_angle: f64) -> Weather {
    Weather { sun_azimuth_angle, ..cosfly_materials::presets::preset("ClearNoon").expect("a preset") }
}

fn night() -> Weather {
    cosfly_materials::presets::preset("ClearNight").expect("a preset")
}

fn body() -> BodyFigure {
    BodyFigure {
        state: TargetState { feet_in_world: FEET, heading_rad: 0.1, speed_mps: 1.4 },
        height_m: 1.75,
        radius_m: 0.3,
        clothes_seed: Seed([9; 32]),
        gait_phase_rad: 1.2,
        body: BodyShape::default(),
    }
}

fn draw(scene: &Scene, pose: Pose, target: Option<BodyFigure>, weather: &Weather) -> FrameImages {
    draw_by(&mut Renderer::new(CAMERA), scene, pose, target, weather)
}

fn draw_by(
    renderer: &mut Renderer,
    scene: &Scene,
    pose: Pose,
    target: Option<BodyFigure>,
    weather: &Weather,
) -> FrameImages {
    renderer.set_optics(Optics::IDEAL);
    renderer.render(scene, &FrameSetup { pose, weather, target, others: &[] }).images.clone()
}

fn look_at(from: DVec3, to: DVec3) -> Pose {
    Pose::looking_at(to + from, to)
}

/// Pixels whose neighbours have their label, too.
fn off_edges(images: &FrameImages) -> impl Iterator<Item = usize> + '_ {
    let width = images.width as usize;
    let is_inner = move |at: &usize| {
        let beside = [at - 1, at + 1, at - width, at + width, at - width - 1, at + width + 1];
        beside.iter().all(|other| images.semantic[*other] == images.semantic[*at])
    };
    (width + 1..images.semantic.len() - width - 1).filter(is_inner)
}

#[test]
fn light_is_that_of_the_file_and_exposure_is_a_key() {
    let pose = look_at(DVec3::new(8.0, 16.0, 5.0), DVec3::new(-5.0, -4.0, 3.0));
    let images = draw(&example(), pose, None, &noon(200.0));
    assert_eq!(images, draw(&example(), pose, None, &noon(200.0)), "the same bytes twice");
    let other_sun = draw(&example(), pose, None, &noon(20.0));
    // Around the mesh, invented ground is lit by the sun.
    let of_house = |at: &usize| images.semantic[*at] == SemanticLabel::Building.id();
    let inner: Vec<usize> = off_edges(&images).filter(of_house).collect();
    assert!(inner.iter().all(|at| images.rgb[3 * at..3 * at + 3] == other_sun.rgb[3 * at..3 * at + 3]));
    // Bricks and mortar: red is the strongest, and both are seen.
    let pixel = |at: &usize| [images.rgb[3 * at], images.rgb[3 * at + 1], images.rgb[3 * at + 2]];
    let walls: Vec<[u8; 3]> = inner.iter().map(pixel).collect();
    assert!(walls.len() > 2000, "{}", walls.len());
    let count = |keep: &dyn Fn(&&[u8; 3]) -> bool| walls.iter().filter(|pixel| keep(pixel)).count();
    assert!(2 * count(&|pixel| pixel[0] > pixel[1].saturating_add(40)) > walls.len(), "bricks");
    assert!(count(&|pixel| pixel[1] > 130) > 20, "mortar");
    let bright = draw(&scene_of(TexturedMesh::EXAMPLE, 1.0), pose, None, &noon(200.0));
    let sum = |images: &FrameImages| inner.iter().map(|at| u64::from(images.rgb[3 * at + 1])).sum::<u64>();
    assert!(10 * sum(&bright) > 12 * sum(&images));
}

#[test]
fn leaves_are_cut_out_and_what_is_behind_them_shows() {
    // The card of 4 by 5 m from the front: leaves within a circle of it, with gaps.
    let pose = look_at(DVec3::new(0.0, 14.0, 0.0), DVec3::new(8.0, -6.0, 3.0));
    let images = draw(&example(), pose, None, &noon(200.0));
    let leaves = images.semantic.iter().filter(|label| **label == SemanticLabel::Vegetation.id()).count() as f64;
    let metre_px = CAMERA.focal_px() / 14.0;
    let card = 20.0 * metre_px * metre_px;
    assert!(leaves > 0.3 * card && leaves < 0.62 * card, "{leaves} of {card} pixels");
}

#[test]
fn bodies_hide_and_are_hidden_and_darken_the_mesh() {
    let scene = example();
    let of_body = |images: &FrameImages| images.instance.iter().filter(|id| **id == TARGET_INSTANCE).count();
    let free = look_at(DVec3::new(3.0, 6.0, 2.0), FEET + DVec3::Z);
    let behind = look_at(DVec3::new(-1.0, -20.0, 1.0), FEET + DVec3::Z);
    let (with, without) = (draw(&scene, free, Some(body()), &noon(200.0)), draw(&scene, free, None, &noon(200.0)));
    assert!(of_body(&with) > 300, "{}", of_body(&with));
    assert_eq!(of_body(&draw(&scene, behind, Some(body()), &noon(200.0))), 0, "behind the house");
    let darker = |at: &usize| {
        with.instance[*at] == without.instance[*at]
            && i32::from(without.rgb[3 * at + 1]) - i32::from(with.rgb[3 * at + 1]) > 15
    };
    let shadow = off_edges(&without).filter(darker).count();
    assert!(shadow > 100, "{shadow} pixels in the shadow");
}

#[test]
fn the_bytes_are_those_of_any_processor_and_any_number_of_threads() {
    let (scene, weather) = (example(), noon(120.0));
    let pose = look_at(DVec3::new(6.0, 9.0, 4.0), FEET);
    let plain = draw(&scene, pose, Some(body()), &weather);
    for level in Level::available() {
        let mut renderer = Renderer::new(CAMERA);
        renderer.set_level(level);
        renderer.set_parallel(true);
        assert_eq!(plain, draw_by(&mut renderer, &scene, pose, Some(body()), &weather), "{level:?}");
    }
}

#[test]
fn haze_lies_before_far_walls_and_changes_nothing_but_colours() {
    let pose = look_at(DVec3::new(60.0, 120.0, 25.0), DVec3::new(-5.0, -4.0, 3.0));
    let drawn = |weather: Weather| draw(&example(), pose, None, &weather);
    let clear = drawn(noon(200.0));
    let haze = drawn(Weather { fog_density: 80.0, ..noon(200.0) });
    assert!(clear.depth_m == haze.depth_m && clear.semantic == haze.semantic && clear.instance == haze.instance);
    // All walls come nearer to one light, and their contrast is less.
    let walls: Vec<usize> =
        off_edges(&clear).filter(|at| clear.semantic[*at] == SemanticLabel::Building.id()).collect();
    assert!(walls.len() > 20, "{}", walls.len());
    let spread = |images: &FrameImages| {
        let codes = walls.iter().map(|at| f64::from(images.rgb[3 * at]));
        let mean = codes.clone().sum::<f64>() / walls.len() as f64;
        (codes.map(|code| (code - mean).abs()).sum::<f64>() / walls.len() as f64, mean)
    };
    let ((clear_spread, clear_mean), (haze_spread, haze_mean)) = (spread(&clear), spread(&haze));
    assert!(haze_spread < 0.85 * clear_spread, "{haze_spread} {clear_spread}");
    assert!(haze_mean > clear_mean, "{haze_mean} {clear_mean}");
}

#[test]
fn a_mesh_is_lit_by_the_weather_where_somebody_asks() {
    let (town, _) = read_town(TexturedMesh::EXAMPLE, &MapConfig::default(), Seed([5; 32])).expect("a town");
    let lit = |exposure_ev: f64| {
        let config = MeshConfig { exposure_ev, light: MeshLight::Weather, ..MeshConfig::new("scan.glb") };
        let place = config.place(town.origin.offset_m).expect("a place");
        let mesh = TexturedMesh::read(TexturedMesh::EXAMPLE, &[], &place).expect("a mesh");
        let mesh = SceneMesh::new(mesh, &config, &town);
        Scene::new(&town, Seed([1; 32])).with_scan(SceneScan { mesh: Some(Arc::new(mesh)), ..SceneScan::default() })
    };
    let pose = look_at(DVec3::new(8.0, 16.0, 5.0), DVec3::new(-5.0, -4.0, 3.0));
    let weather = |sun_azimuth_angle| Weather { sun_altitude_angle: 35.0, ..noon(sun_azimuth_angle) };
    let plain = draw(&example(), pose, None, &weather(90.0));
    let walls: Vec<usize> =
        off_edges(&plain).filter(|at| plain.semantic[*at] == SemanticLabel::Building.id()).collect();
    let ground: Vec<usize> =
        off_edges(&plain).filter(|at| (1..=2).contains(&plain.semantic[*at]) || plain.semantic[*at] == 25).collect();
    assert!(walls.len() > 2000 && ground.len() > 2000, "{} {}", walls.len(), ground.len());
    let sum = |images: &FrameImages, of: &[usize]| of.iter().map(|at| u64::from(images.rgb[3 * at + 1])).sum::<u64>();
    // The camera looks from the south-east: +y and +x. Azimuth 90 degrees is a sun in the south.
    let scene = lit(0.0);
    let (south, north) = (draw(&scene, pose, None, &weather(90.0)), draw(&scene, pose, None, &weather(270.0)));
    assert!(plain.depth_m == south.depth_m && plain.semantic == north.semantic && plain.instance == north.instance);
    // From the south, walls that are seen are lit; from the north they are not, and the house's shadow falls before them.
    assert!(2 * sum(&south, &walls) > 3 * sum(&north, &walls), "walls");
    let green = |images: &FrameImages, at: usize| i32::from(images.rgb[3 * at + 1]);
    let in_shadow = ground.iter().filter(|at| green(&south, **at) - green(&north, **at) > 40).count();
    assert!(20 * in_shadow > ground.len(), "{in_shadow} of {} pixels of ground in the shadow", ground.len());
    assert!(sum(&draw(&lit(-1.0), pose, None, &weather(90.0)), &walls) < sum(&south, &walls));
    assert!(3 * sum(&draw(&scene, pose, None, &night()), &walls) < sum(&south, &walls), "a night is dark");
    for level in Level::available() {
        let mut renderer = Renderer::new(CAMERA);
        renderer.set_level(level);
        renderer.set_parallel(true);
        assert_eq!(south, draw_by(&mut renderer, &scene, pose, None, &weather(90.0)), "{level:?}");
        renderer.set_look(PictureLook::Simple);
        let simple = draw_by(&mut renderer, &scene, pose, None, &weather(90.0));
        assert!(sum(&simple, &walls) > sum(&north, &walls), "the simple look has light and no shadows");
    }
}

#[test]
fn the_camera_exposes_a_mesh_as_it_does_bodies() {
    let pose = look_at(DVec3::new(8.0, 16.0, 5.0), DVec3::new(-5.0, -4.0, 3.0));
    let taken = |exposure_ev: f64, white_balance_k: f64| {
        let mut renderer = Renderer::new(CAMERA);
        renderer.set_optics(Optics { exposure_ev, white_balance_k, ..Optics::IDEAL });
        let setup = FrameSetup { pose, weather: &noon(200.0), target: None, others: &[] };
        renderer.render(&example(), &setup).images.clone()
    };
    let [plain, darker, warm] = [(0.0, 6500.0), (-1.0, 6500.0), (0.0, 4500.0)].map(|(ev, kelvin)| taken(ev, kelvin));
    let walls: Vec<usize> =
        off_edges(&plain).filter(|at| plain.semantic[*at] == SemanticLabel::Building.id()).collect();
    let light = |code: u8| cosfly_frames::real::powf((f64::from(code) / 255.0 + 0.055) / 1.055, 2.4);
    let sum = |images: &FrameImages, k: usize| walls.iter().map(|at| light(images.rgb[3 * at + k])).sum::<f64>();
    for k in 0..3 {
        let share = sum(&darker, k) / sum(&plain, k);
        assert!((share - 0.5).abs() < 0.03, "channel {k}: {share}");
    }
    let gains = [0, 1, 2].map(|k| sum(&warm, k) / sum(&plain, k));
    let turned = (gains[0] - 1.0) * (gains[2] - 1.0);
    assert!(turned < -1e-3, "red and blue go apart: {gains:?}");
}
