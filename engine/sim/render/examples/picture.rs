//! Renders a small invented town to PNG files: `picture OUT_DIR [PRESET...]`.

#[path = "../tests/small_town/mod.rs"]
mod small_town;

use cosfly_frames::{DVec3, Pose, Seed, TargetState};
use cosfly_render::{FrameSetup, RenderConfig, Renderer, Scene, TargetSetup, Weather, preview};
use std::fs::File;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let out = arguments.next().ok_or("usage: picture OUT_DIR [PRESET...]")?;
    let mut presets: Vec<String> = arguments.collect();
    if presets.is_empty() {
        presets = ["ClearNoon", "ClearSunset", "HardRainNoon", "ClearNight"].map(str::to_owned).to_vec();
    }
    std::fs::create_dir_all(&out)?;
    let scene = Scene::new(&small_town::small_town(8, 1), Seed([1; 32]));
    let camera = RenderConfig::default().camera();
    let mut renderer = Renderer::new(camera);
    let feet = DVec3::new(-8.0, 13.5, 0.14);
    let target = TargetSetup {
        state: TargetState { feet_in_world: feet, heading_rad: 0.1, speed_mps: 1.4 },
        height_m: 1.75,
        radius_m: 0.3,
        clothes_seed: Seed([9; 32]),
        gait_phase_rad: 1.2,
        visible_by_rays: 1.0,
    };
    let views = [
        ("follow", Pose::looking_at(feet + DVec3::new(-17.0, -10.0, 20.0), feet + DVec3::Z)),
        ("street", Pose::looking_at(feet + DVec3::new(-14.0, -8.0, 5.0), feet + DVec3::new(8.0, 0.0, 3.0))),
        ("near", Pose::looking_at(feet + DVec3::new(-3.0, -2.5, 2.2), feet + DVec3::Z)),
    ];
    for preset in &presets {
        let mut weather = Weather::preset(preset).ok_or_else(|| format!("no preset {preset}"))?;
        weather.sun_azimuth_angle = 215.0;
        for (name, pose) in &views {
            let frame = renderer.render(&scene, &FrameSetup { pose: *pose, weather: &weather, target: Some(target) });
            let (width, height) = (frame.images.width, frame.images.height);
            write_png(&Path::new(&out).join(format!("{name}_{preset}.png")), width, height, &frame.images.rgb)?;
            println!("{name} {preset}: {:?}", frame.target_view);
            if preset == &presets[0] {
                let labels = preview::palette_image(&frame.images.semantic);
                write_png(&Path::new(&out).join(format!("{name}_labels.png")), width, height, &labels)?;
                let depth = preview::depth_preview(&frame.images.depth_m);
                write_png(&Path::new(&out).join(format!("{name}_depth.png")), width, height, &depth)?;
            }
        }
    }
    Ok(())
}

fn write_png(path: &Path, width: u32, height: u32, rgb: &[u8]) -> Result<(), Box<dyn std::error::Error>> {
    let mut encoder = png::Encoder::new(File::create(path)?, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(rgb)?;
    Ok(())
}
