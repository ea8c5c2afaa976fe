//! The book's pictures: one town at noon, sunset, in rain, fog, at night, in dust and in winter: `postcards OUT_DIR TOWN.xodr`.

use cosfly_domain::{Season, Town, WalkableKind, Weather};
use cosfly_figures::{BodyFigure, BodyShape, FigureInPicture, gait_phase_rad};
use cosfly_frames::{DVec3, Pose, Seed, TargetState};
use cosfly_maps::MapConfig;
use cosfly_render::{FrameSetup, RenderConfig, Renderer, Scene};
use std::fs::File;
use std::path::Path;

/// A picture's name, its preset, what is changed of it, and where the camera is: back, aside and up from the target, metres.
type Postcard = (&'static str, &'static str, fn(&mut Weather), [f64; 3]);

const POSTCARDS: [Postcard; 7] = [
    ("noon", "ClearNoon", |it| it.sun_azimuth_angle = 330.0, [-23.0, 11.0, 15.0]),
    ("sunset", "ClearSunset", |it| it.sun_azimuth_angle = 160.0, [-26.0, 9.0, 17.0]),
    ("rain", "HardRainNoon", |it| it.sun_azimuth_angle = 215.0, [-15.0, 8.0, 8.0]),
    (
        "fog",
        "CloudyNoon",
        |it| {
            it.sun_azimuth_angle = 215.0;
            (it.fog_density, it.fog_distance) = (90.0, 5.0);
        },
        [-24.0, 12.0, 13.0],
    ),
    ("night", "ClearNight", |it| it.sun_azimuth_angle = 215.0, [-21.0, 11.0, 12.0]),
    ("dust", "DustStorm", |it| it.sun_azimuth_angle = 215.0, [-20.0, 10.0, 11.0]),
    (WINTER, "ClearSunset", |it| (it.sun_altitude_angle, it.sun_azimuth_angle) = (26.0, 160.0), [-23.0, 11.0, 14.0]),
];
/// Name of the picture in winter; the others are in the town's own season.
const WINTER: &str = "winter";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(out), Some(map)) = (arguments.next(), arguments.next()) else {
        return Err("usage: postcards OUT_DIR TOWN.xodr".into());
    };
    let bytes = std::fs::read(&map)?;
    let (town, _) = cosfly_maps::read_town(&bytes, &MapConfig::default(), Seed([5; 32]))
        .map_err(|error| format!("{map}: {error}"))?;
    let scene = || Scene::new(&town, Seed([1; 32]));
    let (in_season, in_winter) = (scene(), scene().in_season(Some(Season::Winter)));
    let mut renderer = Renderer::new(RenderConfig::default().camera());
    std::fs::create_dir_all(&out)?;
    let (feet, heading_rad) = corner_of_a_pavement(&town);
    let others = passers_by(&town, feet);
    let state = TargetState { feet_in_world: feet, heading_rad, speed_mps: 1.4 };
    let (sin, cos) = cosfly_frames::real::sin_cos(heading_rad);
    for (name, preset, change, [back, aside, up]) in POSTCARDS {
        let mut weather = cosfly_materials::presets::preset(preset).ok_or("no such preset")?;
        change(&mut weather);
        let target = BodyFigure {
            state,
            height_m: 1.75,
            radius_m: 0.3,
            clothes_seed: Seed([9; 32]),
            gait_phase_rad: 1.2,
            body: BodyShape::default(),
        };
        let offset = DVec3::new(back * cos - aside * sin, back * sin + aside * cos, up);
        let ahead = DVec3::new(6.0 * cos, 6.0 * sin, 1.0);
        let setup = FrameSetup {
            pose: Pose::looking_at(feet + offset, feet + ahead),
            weather: &weather,
            target: Some(target),
            others: &others,
        };
        let scene = if name == WINTER { &in_winter } else { &in_season };
        let frame = renderer.render(scene, &setup);
        let file = File::create(Path::new(&out).join(format!("{name}.png")))?;
        let mut encoder = png::Encoder::new(file, frame.images.width, frame.images.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header()?.write_image_data(&frame.images.rgb)?;
    }
    Ok(())
}

/// People on the pavements and crossings around a place.
fn passers_by(town: &Town, place: DVec3) -> Vec<FigureInPicture> {
    let mut random = Seed([4; 32]).stream("passers-by");
    let mut people = vec![];
    for area in &town.walkable {
        let outline = &area.outline_in_world;
        let (Some(first), Some(second)) = (outline.first(), outline.get(1)) else { continue };
        let apart_m = (*first - place).truncate().length();
        if !(4.0..90.0).contains(&apart_m) || !random.chance(0.9) {
            continue;
        }
        let opposite = outline[outline.len() / 2];
        let feet = *first + (opposite - *first) * random.uniform(0.3, 0.7);
        let along = *second - *first;
        let turn = if random.chance(0.5) { 0.0 } else { cosfly_frames::real::PI };
        let heading_rad = cosfly_frames::real::atan2(along.y, along.x) + turn;
        let height_m = random.uniform(1.55, 1.92);
        let number = people.len() as u8;
        people.push(FigureInPicture {
            figure: BodyFigure {
                state: TargetState { feet_in_world: feet, heading_rad, speed_mps: random.uniform(1.1, 1.6) },
                height_m,
                radius_m: 0.3,
                clothes_seed: Seed([number; 32]),
                gait_phase_rad: gait_phase_rad(random.uniform(0.0, 2.0), height_m),
                body: BodyShape::default(),
            },
            instance: 60_000 + u32::from(number),
        });
    }
    people
}

/// A place on a pavement near the middle of the town, and a way along it.
fn corner_of_a_pavement(town: &Town) -> (DVec3, f64) {
    let middle = 0.5 * (town.min_in_world + town.max_in_world);
    let pavements = town.walkable.iter().filter(|area| area.kind == WalkableKind::Sidewalk);
    let edges = pavements.filter_map(|area| {
        let outline = &area.outline_in_world;
        let opposite = outline.len() / 2;
        let along = outline.get(1)? - outline.first()?;
        let place = 0.5 * (*outline.first()? + *outline.get(opposite)?);
        (along.length() > 3.0).then_some((place, cosfly_frames::real::atan2(along.y, along.x)))
    });
    let away = |point: &DVec3| (*point - middle).truncate().length();
    edges.min_by(|a, b| away(&a.0).total_cmp(&away(&b.0))).unwrap_or((middle, 0.0))
}
