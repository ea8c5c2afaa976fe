//! Renders a town to PNG files: `picture OUT_DIR [TOWN.xodr] [SEASON] [PEOPLE] [PRESET...]`; without a map file, a small
//! invented town; SEASON is `summer`, `autumn` or `winter`, the town's own by default; PEOPLE is how many stand and walk
//! around, none by default.

#[path = "../tests/crowd/mod.rs"]
mod crowd;
#[path = "../tests/small_town/mod.rs"]
mod small_town;

use cosfly_domain::{Season, Town, WalkableKind};
use cosfly_figures::{BodyShape, Walker};
use cosfly_frames::{DVec3, Pose, Seed, TargetState};
use cosfly_maps::MapConfig;
use cosfly_render::{FrameSetup, RenderConfig, Renderer, Scene};
use std::fs::File;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1).peekable();
    let out = arguments.next().ok_or("usage: picture OUT_DIR [TOWN.xodr] [SEASON] [PEOPLE] [PRESET...]")?;
    let map = arguments.next_if(|argument| argument.ends_with(".xodr"));
    let season = arguments.peek().and_then(|name| Season::named(name));
    arguments.next_if(|_| season.is_some());
    let people = arguments.next_if(|argument| argument.parse::<u32>().is_ok()).and_then(|count| count.parse().ok());
    let mut presets: Vec<String> = arguments.collect();
    if presets.is_empty() {
        presets = ["ClearNoon", "ClearSunset", "HardRainNoon", "ClearNight"].map(str::to_owned).to_vec();
    }
    std::fs::create_dir_all(&out)?;
    let town = match &map {
        None => small_town::small_town(8, 1),
        Some(path) => {
            cosfly_maps::read_town(&std::fs::read(path)?, &MapConfig::default(), Seed([5; 32]))
                .map_err(|error| format!("{path}: {error}"))?
                .0
        }
    };
    let scene = Scene::new(&town, Seed([1; 32])).in_season(season);
    let camera = RenderConfig::default().camera();
    let mut renderer = Renderer::new(camera);
    let feet = if map.is_some() { pavement_near_the_middle(&town) } else { DVec3::new(-8.0, 13.5, 0.14) };
    let target = Walker {
        state: TargetState { feet_in_world: feet, heading_rad: 0.1, speed_mps: 1.4 },
        height_m: 1.75,
        radius_m: 0.3,
        clothes_seed: Seed([9; 32]),
        gait_phase_rad: 1.2,
        body: BodyShape::default(),
    };
    let views = [
        ("follow", Pose::looking_at(feet + DVec3::new(-17.0, -10.0, 20.0), feet + DVec3::Z)),
        ("high", Pose::looking_at(feet + DVec3::new(40.0, -60.0, 55.0), feet)),
        ("street", Pose::looking_at(feet + DVec3::new(-14.0, -8.0, 5.0), feet + DVec3::new(8.0, 0.0, 3.0))),
        ("near", Pose::looking_at(feet + DVec3::new(-3.0, -2.5, 2.2), feet + DVec3::Z)),
    ];
    let others = crowd::crowd(feet, people.unwrap_or(0));
    for preset in &presets {
        let mut weather = cosfly_materials::presets::preset(preset).ok_or_else(|| format!("no preset {preset}"))?;
        weather.sun_azimuth_angle = 215.0;
        for (name, pose) in &views {
            let setup = FrameSetup { pose: *pose, weather: &weather, target: Some(target), others: &others };
            let frame = renderer.render(&scene, &setup);
            let (width, height) = (frame.images.width, frame.images.height);
            write_png(&Path::new(&out).join(format!("{name}_{preset}.png")), width, height, &frame.images.rgb)?;
            println!("{name} {preset}: {:?}", frame.target_view);
        }
    }
    Ok(())
}

/// Somewhere on a pavement in the middle of the town.
fn pavement_near_the_middle(town: &Town) -> DVec3 {
    let middle = 0.5 * (town.min_in_world + town.max_in_world);
    let corners = town.walkable.iter().filter(|area| area.kind == WalkableKind::Sidewalk).map(|area| {
        let (a, b) = (area.outline_in_world[0], area.outline_in_world[area.outline_in_world.len() / 2]);
        0.5 * (a + b)
    });
    let away = |point: &DVec3| (*point - middle).truncate().length();
    corners.min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(middle)
}

fn write_png(path: &Path, width: u32, height: u32, rgb: &[u8]) -> Result<(), Box<dyn std::error::Error>> {
    let mut encoder = png::Encoder::new(File::create(path)?, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(rgb)?;
    Ok(())
}
