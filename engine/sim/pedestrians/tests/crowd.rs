//! People who walk together in a real town: on its ground, off its things, apart from each other, and getting on.

use cosfly_domain::{Body, Town, Traffic};
use cosfly_frames::{DVec2, DVec3, Seed, TargetState, real};
use cosfly_maps::{MapConfig, read_town};
use cosfly_pedestrians::{Crowd, CrowdConfig, Ground, WalkableGrid};
use cosfly_world::{Clock, Population, contacts, simulate};
use std::path::Path;
use std::sync::Arc;

fn downtown() -> Town {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../recipes/towns/downtown.xodr");
    let bytes = std::fs::read(path).expect("the map can be read");
    let mut config = MapConfig::default();
    (config.fill.buildings, config.fill.trees) = (true, true);
    read_town(&bytes, &config, Seed::of_item(1, "town", "town")).unwrap().0
}

fn crowd(grid: &Arc<WalkableGrid>, config: &CrowdConfig, clock: Clock) -> Box<dyn Population> {
    Box::new(Crowd::new(grid.clone(), config, clock, Seed::of_item(3, "traffic", "people")).unwrap())
}

fn simulated(grid: &Arc<WalkableGrid>, config: &CrowdConfig, clock: Clock) -> Traffic {
    simulate(&mut [crowd(grid, config, clock)], clock, |_| Ok::<_, ()>(())).unwrap()
}

/// Distance in plan from the middle of a person to the nearest thing that the person's body would meet, metres.
fn free_m(town: &Town, body: &Body, frame: usize) -> f64 {
    let feet = body.states[frame].feet_in_world;
    let solid = town.obstacles.iter().filter(|thing| {
        let (low, high) = thing.shape.bounds_in_world();
        low.z < feet.z + body.plan.size_m.z && high.z > feet.z + 0.1
    });
    solid.fold(f64::INFINITY, |least, thing| {
        let offset = feet.truncate() - thing.shape.center_in_world.truncate();
        let (sin, cos) = real::sin_cos(thing.shape.yaw_rad);
        let own = DVec2::new(cos * offset.x + sin * offset.y, cos * offset.y - sin * offset.x);
        least.min((own.abs() - thing.shape.half_extents_m.truncate()).max(DVec2::ZERO).length())
    })
}

/// Whether a point is within an outline seen from above: it has an odd number of edges to its right.
fn is_within(outline: &[DVec3], point: DVec2) -> bool {
    let mut is_inside = false;
    for (from, to) in outline.iter().zip(outline.iter().cycle().skip(1)) {
        let is_crossed = (from.y > point.y) != (to.y > point.y);
        if is_crossed && point.x < from.x + (point.y - from.y) / (to.y - from.y) * (to.x - from.x) {
            is_inside = !is_inside;
        }
    }
    is_inside
}

/// Frames in which somebody is within none of the town's walkable outlines, found by trying all of them.
fn off_ground(town: &Town, traffic: &Traffic) -> usize {
    let bounds: Vec<(DVec2, DVec2)> = town
        .walkable
        .iter()
        .map(|polygon| {
            let plan = || polygon.outline_in_world.iter().map(|corner| corner.truncate());
            (plan().fold(DVec2::INFINITY, DVec2::min), plan().fold(DVec2::NEG_INFINITY, DVec2::max))
        })
        .collect();
    let is_off = |state: &&TargetState| {
        let point = state.feet_in_world.truncate();
        let mut near = town
            .walkable
            .iter()
            .zip(&bounds)
            .filter(|(_, (low, high))| point.cmpge(*low).all() && point.cmple(*high).all());
        !near.any(|(polygon, _)| is_within(&polygon.outline_in_world, point))
    };
    traffic.bodies.iter().flat_map(|body| &body.states).filter(is_off).count()
}

/// Overlaps of people, found by trying all pairs.
fn overlaps(traffic: &Traffic) -> usize {
    let pairs = |frame: usize| {
        let touches = |(one, other): (&Body, &Body)| {
            let away = one.states[frame].feet_in_world - other.states[frame].feet_in_world;
            away.truncate().length() < one.plan.radius_m() + other.plan.radius_m()
        };
        let bodies = &traffic.bodies;
        let rest = |number: usize| bodies[number + 1..].iter().filter(move |other| touches((&bodies[number], other)));
        (0..bodies.len()).map(|number| rest(number).count()).sum::<usize>()
    };
    (0..traffic.frames as usize).map(pairs).sum()
}

/// The law of a crowd: nobody leaves the ground, meets a thing or overlaps another person.
fn check_law(town: &Town, ground: &Ground, traffic: &Traffic) {
    for (number, body) in traffic.bodies.iter().enumerate() {
        assert_eq!((body.first_frame, body.states.len()), (0, traffic.frames as usize));
        for (frame, state) in body.states.iter().enumerate() {
            let feet = state.feet_in_world;
            assert!(feet.is_finite() && state.heading_rad.is_finite(), "person {number} frame {frame}");
            assert!(ground.at(feet.truncate(), feet.z).is_some(), "person {number} frame {frame} at {feet}");
            let free = free_m(town, body, frame);
            assert!(free >= body.plan.radius_m(), "person {number} frame {frame} at {feet}: {free} m");
        }
        for (frame, pair) in body.states.windows(2).enumerate() {
            let (from, to) = (pair[0].feet_in_world, pair[1].feet_in_world);
            assert!(ground.covers(from, to), "person {number} frame {frame}: {from} to {to}");
        }
    }
    assert_eq!(contacts(traffic, 0.0), []);
    assert_eq!((overlaps(traffic), off_ground(town, traffic)), (0, 0));
}

/// Share of the people who move for 30 s without coming a metre away.
fn stuck_share(traffic: &Traffic) -> f64 {
    let span = (30.0 / traffic.dt_s) as usize;
    let is_stuck = |body: &&Body| {
        body.states.windows(span).any(|states| {
            let away_m = |state: &TargetState| (state.feet_in_world - states[0].feet_in_world).length();
            let moves = states.iter().filter(|state| state.speed_mps > 0.0).count();
            states.iter().all(|state| away_m(state) < 1.0) && moves * 2 > span
        })
    };
    traffic.bodies.iter().filter(is_stuck).count() as f64 / traffic.bodies.len() as f64
}

#[test]
fn three_hundred_people_downtown_keep_the_law_and_get_on() {
    let (town, config) = (downtown(), CrowdConfig { count: 300, ..CrowdConfig::default() });
    let grid = Arc::new(Crowd::grid(&town, &config).unwrap());
    let clock = Clock::new(200, 0.5, 0.1);
    let traffic = simulated(&grid, &config, clock);
    check_law(&town, grid.ground(), &traffic);
    let way_m = traffic.bodies.iter().map(Body::length_m).sum::<f64>() / traffic.bodies.len() as f64;
    let stuck = stuck_share(&traffic);
    println!("mean way {way_m:.1} m, stuck {:.2} %", 100.0 * stuck);
    assert!(way_m > 90.0 && stuck < 0.01, "mean way {way_m} m, stuck {stuck}");
}
