//! Simulates traffic on the lanes of maps and prints its figures: `traffic_figures COUNT SECONDS STEP_S MAP...`.

use cosfly_domain::{BodyKind, ObstacleKind, Town, Traffic};
use cosfly_frames::{DVec2, Seed, real};
use cosfly_maps::{MapConfig, read_town};
use cosfly_vehicles::{VehicleConfig, Vehicles};
use cosfly_world::{Clock, Population, contacts, simulate};
use std::time::Instant;

const DT_S: f64 = 0.5;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [count, seconds, step_s, maps @ ..] = &arguments[..] else {
        return Err("usage: traffic_figures COUNT SECONDS STEP_S MAP...".into());
    };
    let clock = Clock::new((seconds.parse::<f64>()? / DT_S) as u32, DT_S, step_s.parse()?);
    let config = VehicleConfig { count: count.parse()?, ..VehicleConfig::default() };
    for map in maps {
        let (town, _) = read_town(&std::fs::read(map)?, &MapConfig::default(), Seed([1; 32]))?;
        let begun = Instant::now();
        let vehicles = Vehicles::new(&town, &config, clock, Seed([3; 32]))?;
        let made_s = begun.elapsed().as_secs_f64();
        let mut populations: [Box<dyn Population>; 1] = [Box::new(vehicles)];
        let traffic = simulate(&mut populations, clock, |_| Ok::<_, std::convert::Infallible>(()))?;
        let all_s = begun.elapsed().as_secs_f64();
        println!(
            "{map}: {} lanes; made in {made_s:.2} s, {} frames in {:.2} s",
            town.lanes.len(),
            clock.frames,
            all_s - made_s
        );
        println!(
            "  {} overlaps; {} states in solid things",
            contacts(&traffic, 0.0).len(),
            in_solid_things(&town, &traffic)
        );
        println!("  {} stand for the last minute", stuck(&traffic));
        for kind in BodyKind::ON_THE_GROUND.iter().copied() {
            figures(&traffic, kind);
        }
        traffic.notes.iter().for_each(|note| println!("  {note}"));
    }
    Ok(())
}

/// Number of vehicles that drove, and stand for the last minute.
fn stuck(traffic: &Traffic) -> usize {
    let last = (60.0 / traffic.dt_s) as usize;
    let is_stuck = |states: &[cosfly_frames::TargetState]| {
        states.len() == traffic.frames as usize && states.iter().rev().take(last).all(|it| it.speed_mps < 0.1)
    };
    traffic.bodies.iter().filter(|body| body.length_m() > 1.0 && is_stuck(&body.states)).count()
}

/// Speeds and accelerations of a kind.
fn figures(traffic: &Traffic, kind: BodyKind) {
    let driving = || traffic.bodies.iter().filter(|body| body.plan.kind == kind && body.length_m() > 1.0);
    let mut speeds: Vec<f64> = driving().flat_map(|body| body.states.iter().map(|it| it.speed_mps)).collect();
    if speeds.is_empty() {
        return;
    }
    let mut changes: Vec<f64> = vec![];
    let mut sideways: Vec<f64> = vec![];
    for pair in driving().flat_map(|body| body.states.windows(2)) {
        changes.push((pair[1].speed_mps - pair[0].speed_mps) / traffic.dt_s);
        let turn_rad = real::wrap_angle_rad(pair[1].heading_rad - pair[0].heading_rad).abs();
        sideways.push(turn_rad / traffic.dt_s * pair[0].speed_mps.min(pair[1].speed_mps));
    }
    let standing = speeds.iter().filter(|speed| **speed < 0.1).count() as f64 / speeds.len() as f64;
    for list in [&mut speeds, &mut changes, &mut sideways] {
        list.sort_by(f64::total_cmp);
    }
    let at =
        |list: &[f64], share: f64| list.get((share * (list.len().max(1) - 1) as f64) as usize).copied().unwrap_or(0.0);
    println!(
        "  {:10} {:4} drive; speed median {:4.1}, 95 % {:4.1} m/s; stand {:4.1} %; acceleration 1 % {:5.2}, 99 % {:4.2}, sideways 99 % {:4.2} m/s2",
        kind.name(),
        driving().count(),
        at(&speeds, 0.5),
        at(&speeds, 0.95),
        100.0 * standing,
        at(&changes, 0.01),
        at(&changes, 0.99),
        at(&sideways, 0.99)
    );
}

/// States whose boxes overlap a solid thing that is no crown of a tree.
fn in_solid_things(town: &Town, traffic: &Traffic) -> usize {
    let solid: Vec<_> =
        town.obstacles.iter().filter(|it| it.kind != ObstacleKind::TreeCrown).map(|it| it.shape).collect();
    let tree = cosfly_geometry::BoxBvh::build(solid);
    let mut count = 0;
    for body in &traffic.bodies {
        for state in &body.states {
            let shape = body.plan.box_at(state);
            let (low, high) = shape.bounds_in_world();
            let mut touches = false;
            cosfly_geometry::SpatialQuery::within(&tree, low + 0.3 * cosfly_frames::DVec3::Z, high, &mut |number| {
                touches |= overlap(&shape, &tree.boxes()[number as usize]);
            });
            count += usize::from(touches);
        }
    }
    count
}

fn overlap(one: &cosfly_domain::OrientedBox, other: &cosfly_domain::OrientedBox) -> bool {
    let axes = |yaw_rad: f64| {
        let (sin, cos) = real::sin_cos(yaw_rad);
        [DVec2::new(cos, sin), DVec2::new(-sin, cos)]
    };
    let (own, others) = (axes(one.yaw_rad), axes(other.yaw_rad));
    let between = (other.center_in_world - one.center_in_world).truncate();
    own.into_iter().chain(others).all(|axis| {
        let reach = |half: cosfly_frames::DVec3, [along, across]: [DVec2; 2]| {
            half.x * axis.dot(along).abs() + half.y * axis.dot(across).abs()
        };
        axis.dot(between).abs() < reach(one.half_extents_m, own) + reach(other.half_extents_m, others)
    })
}
