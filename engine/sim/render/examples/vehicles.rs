//! Draws vehicles of all kinds on a street of a town, and a drone above them, from both ends and from above, as PNG files.

use cosfly_domain::{BodyKind, WalkableKind};
use cosfly_figures::{BodyShape, Bystander, Walker, pedal_phase_rad};
use cosfly_frames::{DVec3, Pose, Seed, TargetState, real};
use cosfly_maps::MapConfig;
use cosfly_render::{FrameSetup, RenderConfig, Renderer, Scene};
use std::fs::File;
use std::path::Path;

/// Kinds with their sizes, metres.
const PARK: [(BodyKind, [f64; 3]); 17] = [
    (BodyKind::Drone, [0.6, 0.6, 0.2]),
    (BodyKind::DogWalker, [1.6, 0.92, 1.78]),
    (BodyKind::Wheelchair, [1.05, 0.65, 1.32]),
    (BodyKind::PushChair, [1.5, 0.7, 1.65]),
    (BodyKind::Sitter, [1.05, 0.65, 1.32]),
    (BodyKind::Elder, [0.5, 0.5, 1.65]),
    (BodyKind::Child, [0.35, 0.35, 1.15]),
    (BodyKind::Bus, [12.0, 2.55, 3.1]),
    (BodyKind::Car, [4.6, 1.85, 1.46]),
    (BodyKind::EScooter, [1.15, 0.61, 1.87]),
    (BodyKind::Van, [5.4, 2.0, 2.4]),
    (BodyKind::Car, [4.2, 1.8, 1.5]),
    (BodyKind::Motorcycle, [2.1, 0.8, 1.6]),
    (BodyKind::Truck, [8.5, 2.5, 3.4]),
    (BodyKind::Car, [4.5, 1.85, 1.5]),
    (BodyKind::Bicycle, [1.8, 0.65, 1.75]),
    (BodyKind::Car, [4.8, 1.9, 1.65]),
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(out), Some(map)) = (arguments.next(), arguments.next()) else {
        return Err("usage: vehicles OUT_DIR TOWN.xodr".into());
    };
    let (town, _) = cosfly_maps::read_town(&std::fs::read(&map)?, &MapConfig::default(), Seed([5; 32]))
        .map_err(|error| format!("{map}: {error}"))?;
    let crossing = town.walkable.iter().find(|area| area.kind == WalkableKind::Crossing).ok_or("no crossing")?;
    let outline = &crossing.outline_in_world;
    let middle = outline.iter().sum::<DVec3>() / outline.len() as f64;
    let along = (outline[1] - outline[0]).truncate().normalize_or_zero();
    let heading_rad = real::atan2(along.y, along.x);
    let mut others = vec![];
    let mut ahead_m = 0.0;
    for (instance, (kind, size_m)) in (90_000..).zip(PARK) {
        let height_m = if kind == BodyKind::Drone { 2.5 } else { 0.0 };
        let side = if instance % 2 == 0 { 1.8 } else { -1.8 };
        let state = TargetState {
            feet_in_world: middle + (along * ahead_m - along.perp() * side).extend(height_m),
            heading_rad: if side > 0.0 { heading_rad } else { heading_rad + real::PI },
            speed_mps: 4.0,
        };
        let walker = Walker {
            state,
            height_m: size_m[2],
            radius_m: 0.5 * size_m[1],
            clothes_seed: Seed([instance as u8; 32]),
            gait_phase_rad: pedal_phase_rad(f64::from(instance)),
            body: BodyShape::of(kind, DVec3::from_array(size_m)),
        };
        others.push(Bystander { walker, instance });
        ahead_m += 4.5;
    }
    let scene = Scene::new(&town, Seed([1; 32]));
    let mut renderer = Renderer::new(RenderConfig::default().camera());
    std::fs::create_dir_all(&out)?;
    for (name, preset, [back, aside, up]) in [
        ("front", "ClearNoon", [-9.0, -5.0, 4.0]),
        ("back", "ClearSunset", [50.0, 0.5, 3.2]),
        ("above", "ClearNoon", [14.0, -9.0, 16.0]),
        ("night", "WetNight", [-8.0, 5.0, 5.0]),
    ] {
        let weather = cosfly_materials::presets::preset(preset).ok_or("no such preset")?;
        let at = |ahead: f64, aside: f64, up: f64| middle + (along * ahead + along.perp() * aside).extend(up);
        let pose = Pose::looking_at(at(back, aside, up), at(18.0, 0.0, 1.0));
        let frame = renderer.render(&scene, &FrameSetup { pose, weather: &weather, target: None, others: &others });
        let file = File::create(Path::new(&out).join(format!("{name}.png")))?;
        let mut encoder = png::Encoder::new(file, frame.images.width, frame.images.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header()?.write_image_data(&frame.images.rgb)?;
    }
    Ok(())
}
