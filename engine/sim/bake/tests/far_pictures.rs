//! Scans from afar: pictures of a mesh beside the mean of many samples. `--nocapture` prints the figures of the page "Benchmarks".

#[path = "../../render/tests/small_town/mod.rs"]
mod small_town;

use cosfly_bake::bake;
use cosfly_domain::{Camera, FrameImages, Optics, Town};
use cosfly_frames::{DVec3, Pose, Seed, real};
use cosfly_models::mesh::{MeshConfig, TexturedMesh};
use cosfly_render::{FrameSetup, Renderer, Scene, SceneMesh, SceneScan};
use std::sync::Arc;

const SEED: Seed = Seed([1; 32]);
/// Pixels are as large as those of a camera of 1280 x 720 pixels and 90 degrees.
const CAMERA: Camera = Camera { width: 320, height: 180, horizontal_fov_rad: 0.5 };
/// Samples of a pixel along each side.
const SAMPLES: u32 = 4;

/// A town in its own mesh, with pictures of 5 cm a pixel.
fn scanned(town: &Town) -> Scene {
    let weather = cosfly_materials::presets::clear_noon();
    let bytes = bake(town, SEED, &weather, 0.05).expect("a small town").to_glb("a town").expect("a file");
    let config = MeshConfig::new("town.glb");
    let mesh = TexturedMesh::read(&bytes, &[], &config.place(DVec3::ZERO).expect("a place")).expect("a mesh");
    let mesh = Some(Arc::new(SceneMesh::new(mesh, &config, town)));
    Scene::new(town, SEED).with_scan(SceneScan { mesh, ..SceneScan::default() })
}

fn draw(scene: &Scene, pose: Pose, samples: u32) -> FrameImages {
    let Camera { width, height, horizontal_fov_rad } = CAMERA;
    let mut renderer = Renderer::new(Camera { width: width * samples, height: height * samples, horizontal_fov_rad });
    renderer.set_optics(Optics::IDEAL);
    let weather = cosfly_materials::presets::clear_noon();
    renderer.render(scene, &FrameSetup { pose, weather: &weather, target: None, others: &[] }).images.clone()
}

/// A place above the town, `distance_m` away and `shift_m` to the side.
fn pose(distance_m: f64, shift_m: f64) -> Pose {
    let middle = DVec3::new(0.0, shift_m, 2.0);
    Pose::looking_at(middle + distance_m * DVec3::new(-0.83, 0.25, 0.5), middle)
}

fn light(code: u8) -> f64 {
    let value = f64::from(code) / 255.0;
    if value <= 0.04045 { value / 12.92 } else { real::powf((value + 0.055) / 1.055, 2.4) }
}

fn code(light: f64) -> f64 {
    255.0 * if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * real::powf(light, 1.0 / 2.4) - 0.055 }
}

/// Red, green and blue of each pixel as the mean light of its samples, codes.
fn mean(images: &FrameImages) -> Vec<f64> {
    let (width, samples) = (CAMERA.width as usize, SAMPLES as usize);
    let one = |at: usize, channel: usize| {
        let (row, column) = (at / width * samples, at % width * samples);
        let all = (0..samples * samples).map(|k| {
            let place = (row + k / samples) * samples * width + column + k % samples;
            light(images.rgb[3 * place + channel])
        });
        code(all.sum::<f64>() / (samples * samples) as f64)
    };
    (0..width * CAMERA.height as usize).flat_map(|at| [0, 1, 2].map(|channel| one(at, channel))).collect()
}

/// Root of the mean square over the colours of some pixels.
fn rms(pixels: &[usize], off: impl Fn(usize) -> f64) -> f64 {
    let all = pixels.iter().flat_map(|at| 3 * at..3 * at + 3);
    (all.map(|byte| off(byte) * off(byte)).sum::<f64>() / (3 * pixels.len()) as f64).sqrt()
}

#[test]
fn far_pictures_of_a_mesh_are_near_the_mean_of_many_samples() {
    let town = small_town::small_town(1, 1);
    let scene = scanned(&town);
    for (distance_m, most) in [(50.0, 2.5), (100.0, 4.5), (200.0, 8.0)] {
        let views = [0.0, 0.1].map(|shift_m| {
            let pose = pose(distance_m, shift_m);
            (draw(&scene, pose, 1), mean(&draw(&scene, pose, SAMPLES)))
        });
        let [(drawn, exact), (drawn_beside, exact_beside)] = &views;
        let of_town = |at: &usize| (f64::from(drawn.depth_m[*at]) - distance_m).abs() < 30.0;
        let pixels: Vec<usize> = (0..drawn.depth_m.len()).filter(of_town).collect();
        let code = |images: &FrameImages, byte: usize| f64::from(images.rgb[byte]);
        let off = rms(&pixels, |byte| code(drawn, byte) - exact[byte]);
        let flicker =
            rms(&pixels, |byte| code(drawn_beside, byte) - code(drawn, byte) - (exact_beside[byte] - exact[byte]));
        println!(
            "{distance_m} m: {off:.1} steps of 255 off, {flicker:.1} from frame to frame; {} pixels",
            pixels.len()
        );
        assert!(pixels.len() > 10_000 && off < most && flicker < most, "{distance_m} m");
    }
}
