//! Looks from the edges of a town outwards, and at its roofs: `outward OUT_DIR MAP [PRESET...]`; noon and haze by default.

use cosfly_domain::{Camera, ObstacleKind, Town, Weather};
use cosfly_frames::{DVec2, DVec3, Pose, Seed};
use cosfly_maps::{MapConfig, read_town};
use cosfly_render::{FrameSetup, Renderer, Scene};
use cosfly_town::GroundIndex;
use std::fs::File;
use std::path::Path;

/// Height of the camera above the ground, and its distance from the edge, metres.
const ABOVE_M: f64 = 30.0;
const INSIDE_M: f64 = 40.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(out), Some(map)) = (arguments.next(), arguments.next()) else {
        return Err("usage: outward OUT_DIR MAP [PRESET...]".into());
    };
    let mut presets: Vec<String> = arguments.collect();
    if presets.is_empty() {
        presets = ["ClearNoon", "haze"].map(str::to_owned).to_vec();
    }
    let name = Path::new(&map).file_stem().map(|stem| stem.to_string_lossy().replace('.', "_")).unwrap_or_default();
    let (town, _) = read_town(&std::fs::read(&map)?, &MapConfig::default(), Seed([5; 32]))
        .map_err(|error| format!("{map}: {error}"))?;
    std::fs::create_dir_all(&out)?;
    let scene = Scene::new(&town, Seed([1; 32]));
    let mut renderer = Renderer::new(Camera { width: 640, height: 360, horizontal_fov_rad: 1.4 });
    for preset in &presets {
        for (view, pose) in views(&town) {
            let setup = FrameSetup { pose, weather: &weather(preset)?, target: None, others: &[] };
            let images = renderer.render(&scene, &setup).images;
            let file = File::create(Path::new(&out).join(format!("{name}-{view}-{preset}.png")))?;
            let mut encoder = png::Encoder::new(file, images.width, images.height);
            encoder.set_color(png::ColorType::Rgb);
            encoder.write_header()?.write_image_data(&images.rgb)?;
        }
    }
    Ok(())
}

fn weather(preset: &str) -> Result<Weather, String> {
    let is_haze = preset == "haze";
    let named = if is_haze { "CloudyNoon" } else { preset };
    let mut weather = Weather::preset(named).ok_or_else(|| format!("no preset {preset}"))?;
    weather.sun_azimuth_angle = 215.0;
    if is_haze {
        (weather.fog_density, weather.fog_distance) = (25.0, 20.0);
    }
    Ok(weather)
}

/// From the middle of each side outwards, along the northern edge, and down on the roofs in the middle.
fn views(town: &Town) -> Vec<(&'static str, Pose)> {
    let buildings = town.obstacles.iter().filter(|one| one.kind == ObstacleKind::Building);
    let middles: Vec<DVec2> = buildings.map(|one| one.shape.center_in_world.truncate()).collect();
    let mut low = middles.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let mut high = middles.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    if middles.is_empty() {
        (low, high) = (town.min_in_world.truncate(), town.max_in_world.truncate());
    }
    let middle = 0.5 * (low + high);
    let ground = GroundIndex::new(town);
    let on_ground = |at: DVec2| at.extend(ground.ground_height_m(at.x, at.y).unwrap_or(town.min_in_world.z));
    let eye = |at: DVec2| on_ground(at) + DVec3::Z * ABOVE_M;
    let from = |at: DVec2, way: DVec2| {
        let eye = eye(at);
        Pose::looking_at(eye, eye + (100.0 * way).extend(-12.0))
    };
    let north = DVec2::new(middle.x, low.y + INSIDE_M);
    let nearest = middles.iter().copied().min_by(|a, b| a.distance(middle).total_cmp(&b.distance(middle)));
    let roof = on_ground(nearest.unwrap_or(middle));
    vec![
        ("north", from(north, -DVec2::Y)),
        ("south", from(DVec2::new(middle.x, high.y - INSIDE_M), DVec2::Y)),
        ("east", from(DVec2::new(high.x - INSIDE_M, middle.y), DVec2::X)),
        ("west", from(DVec2::new(low.x + INSIDE_M, middle.y), -DVec2::X)),
        ("along", from(north, DVec2::X)),
        ("roofs", Pose::looking_at(roof + DVec3::new(-45.0, 30.0, 45.0), roof + DVec3::Z * 5.0)),
    ]
}
