//! Time per 1280 x 720 frame: wall time by stage, CPU time in all; `bench_frame [TOWN.xodr [SPLATS.ply]] [PEOPLE [CARS]] [PRESET...]`;
//! without a map file, an invented town of about 3,000 boxes and 100,000 ground triangles; PEOPLE is how many are around, none by
//! default. With CARS, people and vehicles are spread over the pavements and lanes of the map, and the views are those of its middle
//! street. SPLATS are those of `cosfly map convert TOWN.xodr`; their time is in the total alone.

#[path = "../tests/crowd/mod.rs"]
mod crowd;
#[path = "../tests/small_town/mod.rs"]
mod small_town;
#[path = "../tests/traffic/mod.rs"]
mod traffic;

use cosfly_domain::Town;
use cosfly_figures::{BodyFigure, BodyShape, FigureInPicture};
use cosfly_frames::{DVec3, Pose, Seed, TargetState, real};
use cosfly_maps::MapConfig;
use cosfly_render::{FrameParts, FrameSetup, RenderConfig, Renderer, Scene, SceneScan, SceneSplats, Stages};
use cosfly_scans::up_axis::UpAxis;
use cosfly_splats::{SplatsConfig, read};
use std::sync::Arc;
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1).peekable();
    let map = arguments.next_if(|argument| argument.ends_with(".xodr"));
    let splats = arguments.next_if(|argument| argument.ends_with(".ply"));
    let people = arguments.next_if(|argument| argument.parse::<u32>().is_ok()).and_then(|count| count.parse().ok());
    let cars: Option<u32> =
        arguments.next_if(|argument| argument.parse::<u32>().is_ok()).and_then(|count| count.parse().ok());
    let mut presets: Vec<String> = arguments.collect();
    if presets.is_empty() {
        presets = ["ClearNoon", "HardRainNoon", "WetNight"].map(str::to_owned).to_vec();
    }
    let town = match &map {
        None => {
            let mut town = small_town::small_town(9, 1);
            refine(&mut town, 100_000);
            town
        }
        Some(path) => {
            cosfly_maps::read_town(&std::fs::read(path)?, &MapConfig::default(), Seed([5; 32]))
                .map_err(|error| format!("{path}: {error}"))?
                .0
        }
    };
    let started = Instant::now();
    let start = cpu_ns(started);
    let mut scene = Scene::new(&town, Seed([1; 32]));
    if let Some(path) = &splats {
        let cloud = read(&std::fs::read(path)?)?.cloud;
        println!("{} splats", cloud.len());
        let placed = SceneSplats::new(cloud, &SplatsConfig::new("", UpAxis::Z), town.origin.offset_m);
        let splats = Some(Arc::new(placed.map_err(|problem| problem.message)?));
        scene = scene.with_scan(SceneScan { splats, ..SceneScan::default() });
    }
    println!("{} boxes, {} triangles with faces", town.obstacles.len(), scene.triangles().len());
    println!("scene {:8.2} ms once", (cpu_ns(started) - start) as f64 * 1e-6);
    let mut renderer = Renderer::new(RenderConfig::default().camera());
    let middle =
        if map.is_some() { 0.5 * (town.min_in_world + town.max_in_world) } else { DVec3::new(-23.0, 43.5, 0.14) };
    let (middle, others) = match cars {
        Some(cars) => spread(&town, middle, people.unwrap_or(0), cars),
        None => (middle, crowd::crowd(middle, people.unwrap_or(0))),
    };
    let views = [("follow", [-17.0, -10.0, 20.0]), ("high", [40.0, -60.0, 55.0]), ("street", [-14.0, -8.0, 5.0])];
    let names = Stages::NAMES.map(|name| format!("{name:>10}")).join("");
    println!("{:22}{names} total, CPU  depth + ids", "ms a frame");
    for preset in &presets {
        let mut weather = cosfly_materials::presets::preset(preset).ok_or_else(|| format!("no preset {preset}"))?;
        weather.sun_azimuth_angle = 215.0;
        for (view, away) in &views {
            let mut spent: [Vec<u64>; Stages::NAMES.len()] = Default::default();
            let mut before = 0;
            for index in 0..40 {
                let (pose, target) = frame(index, middle, DVec3::from_array(*away));
                let setup = FrameSetup { pose, weather: &weather, target: Some(target), others: &others };
                if index == 4 {
                    before = cpu_ns(started);
                }
                let (_, stages) = renderer.render_timed(&scene, &setup, &|| started.elapsed().as_nanos() as u64);
                for (times, time) in spent.iter_mut().zip(stages.ns()) {
                    times.push(time);
                }
            }
            let total_ms = (cpu_ns(started) - before) as f64 * 1e-6 / 36.0;
            // A low quantile: the machine may have other work.
            let each = spent.map(|mut times| {
                times.sort_unstable();
                format!("{:10.2}", times[times.len() / 5] as f64 * 1e-6)
            });
            let before = cpu_ns(started);
            for index in 0..40 {
                let (pose, target) = frame(index, middle, DVec3::from_array(*away));
                let setup = FrameSetup { pose, weather: &weather, target: Some(target), others: &others };
                let _ = renderer.render_parts(&scene, &setup, FrameParts::Ids);
            }
            let ids_ms = (cpu_ns(started) - before) as f64 * 1e-6 / 40.0;
            println!("{:22}{}{total_ms:10.2}{ids_ms:12.2}", format!("{preset} {view}"), each.join(""));
        }
    }
    Ok(())
}

/// The lane's place that is nearest to a place, and people and vehicles all over the town.
fn spread(town: &Town, middle: DVec3, people: u32, cars: u32) -> (DVec3, Vec<FigureInPicture>) {
    let mut random = Seed([3; 32]).stream("spread");
    let away = |point: &DVec3| (*point - middle).truncate().length();
    let points = town.lanes.iter().flat_map(|lane| &lane.middle_in_world).copied();
    let street = points.min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(middle);
    let mut others = crowd::crowd(DVec3::ZERO, people);
    for other in &mut others {
        let outline = &town.walkable[random.index(town.walkable.len())].outline_in_world;
        let corner = outline[random.index(outline.len())];
        other.figure.state.feet_in_world = corner.lerp(outline[random.index(outline.len())], random.unit());
    }
    for number in 0..cars {
        let lane = &town.lanes[random.index(town.lanes.len())].middle_in_world;
        let side = random.index(lane.len() - 1);
        let (from, along) = (lane[side], lane[side + 1] - lane[side]);
        others.push(traffic::vehicle(number, from + random.unit() * along, real::atan2(along.y, along.x)));
    }
    (street, others)
}

/// CPU time of this thread, nanoseconds; wall time where the system does not tell.
fn cpu_ns(started: Instant) -> u64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let spent_ns = told.and_then(|text| text.split(' ').next().and_then(|first| first.parse::<u64>().ok()));
    spent_ns.unwrap_or_else(|| started.elapsed().as_nanos() as u64)
}

/// A follower behind and above a target that walks along a street.
fn frame(index: u32, middle: DVec3, away: DVec3) -> (Pose, BodyFigure) {
    let (sin, cos) = real::sin_cos(0.01 * f64::from(index));
    let feet = middle + DVec3::new(0.2 * f64::from(index), 0.0, 0.0);
    let target = BodyFigure {
        state: TargetState { feet_in_world: feet, heading_rad: 0.1, speed_mps: 1.4 },
        height_m: 1.75,
        radius_m: 0.3,
        clothes_seed: Seed([9; 32]),
        gait_phase_rad: 0.4 * f64::from(index),
        body: BodyShape::default(),
    };
    let turned = DVec3::new(cos * away.x - sin * away.y, sin * away.x + cos * away.y, away.z);
    (Pose::looking_at(feet + turned, feet + DVec3::Z), target)
}
/// Cuts ground triangles until there are at least `wanted`.
fn refine(town: &mut Town, wanted: usize) {
    while town.surfaces.iter().map(|mesh| mesh.triangles.len()).sum::<usize>() < wanted {
        for mesh in &mut town.surfaces {
            let mut finer = Vec::with_capacity(2 * mesh.triangles.len());
            for [a, b, c] in core::mem::take(&mut mesh.triangles) {
                let middle = 0.5 * (mesh.vertices_in_world[b as usize] + mesh.vertices_in_world[c as usize]);
                mesh.vertices_in_world.push(middle);
                mesh.along_across_m.push(mesh.along_across_m[b as usize]);
                let m = (mesh.vertices_in_world.len() - 1) as u32;
                finer.extend([[m, a, b], [m, c, a]]);
            }
            mesh.triangles = finer;
        }
    }
}
