//! Draws people of all builds side by side, close and from a drone's height, as PNG files: `people OUT_DIR TOWN.xodr`.

use cosfly_domain::{WalkableKind, Weather};
use cosfly_figures::{BodyShape, Bystander, Walker, gait_phase_rad};
use cosfly_frames::{DVec3, Pose, Seed, TargetState, real};
use cosfly_maps::MapConfig;
use cosfly_render::{FrameSetup, RenderConfig, Renderer, Scene};
use std::fs::File;
use std::path::Path;

/// People in a row, and rows.
const CROWD: [u32; 2] = [9, 3];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(out), Some(map)) = (arguments.next(), arguments.next()) else {
        return Err("usage: people OUT_DIR TOWN.xodr".into());
    };
    let (town, _) = cosfly_maps::read_town(&std::fs::read(&map)?, &MapConfig::default(), Seed([5; 32]))
        .map_err(|error| format!("{map}: {error}"))?;
    let crossing = town.walkable.iter().find(|area| area.kind == WalkableKind::Crossing).ok_or("no crossing")?;
    let outline = &crossing.outline_in_world;
    let middle = outline.iter().sum::<DVec3>() / outline.len() as f64;
    let along = (outline[1] - outline[0]).truncate().normalize_or_zero();
    let heading_rad = real::atan2(-along.y, -along.x);
    let mut others = vec![];
    for number in 0..CROWD[0] * CROWD[1] {
        let (column, row) = (number % CROWD[0], number / CROWD[0]);
        let aside = 0.8 * (f64::from(column) - 0.5 * f64::from(CROWD[0] - 1)) + 0.4 * f64::from(row % 2);
        let seed = Seed([7; 32]).child("person", u64::from(number));
        let height_m = if number % 7 == 3 { 1.2 } else { seed.stream("height").uniform(1.55, 1.92) };
        let turn_rad = [0.0, 0.9, 3.0][row as usize];
        let walker = Walker {
            state: TargetState {
                feet_in_world: middle + (along * (1.6 * f64::from(row)) + along.perp() * aside).extend(0.0),
                heading_rad: heading_rad + turn_rad,
                speed_mps: if number % 5 == 4 { 0.0 } else { 1.3 },
            },
            height_m,
            radius_m: 0.16 * height_m,
            clothes_seed: seed,
            gait_phase_rad: gait_phase_rad(0.37 * f64::from(number), height_m),
            body: BodyShape::default(),
        };
        others.push(Bystander { walker, instance: 90_000 + number });
    }
    let scene = Scene::new(&town, Seed([1; 32]));
    let mut renderer = Renderer::new(RenderConfig::default().camera());
    std::fs::create_dir_all(&out)?;
    for (name, preset, [back, aside, up]) in [
        ("close", "ClearNoon", [-4.4, -0.6, 2.2]),
        ("sunset", "ClearSunset", [-5.5, 2.5, 3.5]),
        ("drone", "CloudyNoon", [-12.0, 3.0, 9.0]),
        ("rain", "MidRainyNoon", [-6.0, 2.0, 4.0]),
    ] {
        let weather = Weather::preset(preset).ok_or("no such preset")?;
        for Bystander { walker, .. } in &mut others {
            walker.body = walker.body.in_rain(weather.precipitation, &walker.clothes_seed);
        }
        let at = |ahead: f64, aside: f64, up: f64| middle + (along * ahead + along.perp() * aside).extend(up);
        let pose = Pose::looking_at(at(back, aside, up), at(1.0, 0.0, 0.9));
        let frame = renderer.render(&scene, &FrameSetup { pose, weather: &weather, target: None, others: &others });
        let file = File::create(Path::new(&out).join(format!("{name}.png")))?;
        let mut encoder = png::Encoder::new(file, frame.images.width, frame.images.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header()?.write_image_data(&frame.images.rgb)?;
    }
    Ok(())
}
