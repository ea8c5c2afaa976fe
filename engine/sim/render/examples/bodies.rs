//! Draws people of all builds side by side, and bodies of all other kinds along a street, as PNG files: `bodies OUT_DIR TOWN.xodr`.

use cosfly_domain::{BodyKind, Town, WalkableKind};
use cosfly_figures::{BodyFigure, BodyShape, FigureInPicture, gait_phase_rad, pedal_phase_rad};
use cosfly_frames::{DVec2, DVec3, Pose, Seed, TargetState, real};
use cosfly_maps::MapConfig;
use cosfly_render::{FrameSetup, RenderConfig, Renderer, Scene};
use std::fs::File;
use std::path::Path;

/// People in a row, and rows.
const CROWD: [u32; 2] = [9, 3];

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

/// A picture's name, its preset, and where its camera is: ahead, aside, up, metres.
type View = (&'static str, &'static str, [f64; 3]);

const OF_CROWD: [View; 4] = [
    ("close", "ClearNoon", [-4.4, -0.6, 2.2]),
    ("sunset", "ClearSunset", [-5.5, 2.5, 3.5]),
    ("drone", "CloudyNoon", [-12.0, 3.0, 9.0]),
    ("rain", "MidRainyNoon", [-6.0, 2.0, 4.0]),
];
const OF_PARK: [View; 4] = [
    ("front", "ClearNoon", [-9.0, -5.0, 4.0]),
    ("back", "ClearSunset", [50.0, 0.5, 3.2]),
    ("above", "ClearNoon", [14.0, -9.0, 16.0]),
    ("night", "WetNight", [-8.0, 5.0, 5.0]),
];

/// A street: the middle of a crossing, and the way along the street.
struct Street {
    middle: DVec3,
    along: DVec2,
}

impl Street {
    fn of(town: &Town) -> Option<Self> {
        let outline = &town.walkable.iter().find(|area| area.kind == WalkableKind::Crossing)?.outline_in_world;
        let along = (outline[1] - outline[0]).truncate().normalize_or_zero();
        Some(Self { middle: outline.iter().sum::<DVec3>() / outline.len() as f64, along })
    }

    fn at(&self, ahead_m: f64, aside_m: f64, up_m: f64) -> DVec3 {
        self.middle + (self.along * ahead_m + self.along.perp() * aside_m).extend(up_m)
    }

    fn heading_rad(&self) -> f64 {
        real::atan2(self.along.y, self.along.x)
    }

    fn crowd(&self) -> Vec<FigureInPicture> {
        let person = |number: u32| {
            let (column, row) = (number % CROWD[0], number / CROWD[0]);
            let aside = 0.8 * (f64::from(column) - 0.5 * f64::from(CROWD[0] - 1)) + 0.4 * f64::from(row % 2);
            let seed = Seed([7; 32]).child("person", u64::from(number));
            let height_m = if number % 7 == 3 { 1.2 } else { seed.stream("height").uniform(1.55, 1.92) };
            let figure = BodyFigure {
                state: TargetState {
                    feet_in_world: self.at(1.6 * f64::from(row), aside, 0.0),
                    heading_rad: self.heading_rad() + real::PI + [0.0, 0.9, 3.0][row as usize],
                    speed_mps: if number % 5 == 4 { 0.0 } else { 1.3 },
                },
                height_m,
                radius_m: 0.16 * height_m,
                clothes_seed: seed,
                gait_phase_rad: gait_phase_rad(0.37 * f64::from(number), height_m),
                body: BodyShape::default(),
            };
            FigureInPicture { figure, instance: 90_000 + number }
        };
        (0..CROWD[0] * CROWD[1]).map(person).collect()
    }

    fn park(&self) -> Vec<FigureInPicture> {
        let body = |(number, (kind, size_m)): (u8, (BodyKind, [f64; 3]))| {
            let (side, turn_rad) = if number.is_multiple_of(2) { (-1.8, 0.0) } else { (1.8, real::PI) };
            let height_m = if kind == BodyKind::Drone { 2.5 } else { 0.0 };
            let figure = BodyFigure {
                state: TargetState {
                    feet_in_world: self.at(4.5 * f64::from(number), side, height_m),
                    heading_rad: self.heading_rad() + turn_rad,
                    speed_mps: 4.0,
                },
                height_m: size_m[2],
                radius_m: 0.5 * size_m[1],
                clothes_seed: Seed([144 + number; 32]),
                gait_phase_rad: pedal_phase_rad(f64::from(number)),
                body: BodyShape::of(kind, DVec3::from_array(size_m)),
            };
            FigureInPicture { figure, instance: 90_000 + u32::from(number) }
        };
        (0..).zip(PARK).map(body).collect()
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(out), Some(map)) = (arguments.next(), arguments.next()) else {
        return Err("usage: bodies OUT_DIR TOWN.xodr".into());
    };
    let (town, _) = cosfly_maps::read_town(&std::fs::read(&map)?, &MapConfig::default(), Seed([5; 32]))
        .map_err(|error| format!("{map}: {error}"))?;
    let street = Street::of(&town).ok_or("no crossing")?;
    let scene = Scene::new(&town, Seed([1; 32]));
    let mut renderer = Renderer::new(RenderConfig::default().camera());
    std::fs::create_dir_all(&out)?;
    let sets =
        [(street.crowd(), OF_CROWD, street.at(1.0, 0.0, 0.9)), (street.park(), OF_PARK, street.at(18.0, 0.0, 1.0))];
    for (mut others, views, seen) in sets {
        for (name, preset, [ahead, aside, up]) in views {
            let weather = cosfly_materials::presets::preset(preset).ok_or("no such preset")?;
            for FigureInPicture { figure, .. } in &mut others {
                figure.body = figure.body.in_rain(weather.precipitation, &figure.clothes_seed);
            }
            let pose = Pose::looking_at(street.at(ahead, aside, up), seen);
            let frame = renderer.render(&scene, &FrameSetup { pose, weather: &weather, target: None, others: &others });
            let file = File::create(Path::new(&out).join(format!("{name}.png")))?;
            let mut encoder = png::Encoder::new(file, frame.images.width, frame.images.height);
            encoder.set_color(png::ColorType::Rgb);
            encoder.set_depth(png::BitDepth::Eight);
            encoder.write_header()?.write_image_data(&frame.images.rgb)?;
        }
    }
    Ok(())
}
