//! Parked cars: beside lanes where there is room, else in lanes that nobody needs; never on pavements or crossings.

use cosfly_domain::{Around, Body, BodyPlan, Town, Traffic};
use cosfly_frames::{DVec2, Seed, TargetTrack, real};
use cosfly_maps::{MapConfig, read_town};
use cosfly_places::grid::{GenerateConfig, generate_town};
use cosfly_town::polygons::PolygonIndex;
use cosfly_vehicles::{VehicleConfig, Vehicles};
use cosfly_world::{Clock, simulate};

fn read(text: &str) -> Town {
    read_town(text.as_bytes(), &MapConfig::default(), Seed([1; 32])).unwrap().0
}

fn generated(seed: u64) -> Town {
    read(&generate_town(&GenerateConfig::default(), seed))
}

/// A straight street of 200 m, the same on both sides, with these lanes from the middle outwards and a pavement.
fn street(lanes: &[(&str, f64)]) -> Town {
    let side = |sign: i32| {
        let all = lanes.iter().chain(&[("sidewalk", 2.5)]);
        let lane = |(number, (kind, width_m)): (i32, &(&str, f64))| {
            let id = sign * number;
            format!(
                r#"<lane id="{id}" type="{kind}" level="false"><width sOffset="0" a="{width_m}" b="0" c="0" d="0"/></lane>"#
            )
        };
        (1..).zip(all).map(lane).collect::<String>()
    };
    read(&format!(
        r#"<OpenDRIVE><header revMajor="1" revMinor="6"/><road name="" id="1" length="200" junction="-1">
        <type s="0" type="town"><speed max="50" unit="km/h"/></type>
        <planView><geometry s="0" x="0" y="0" hdg="0.3" length="200"><line/></geometry></planView>
        <lanes><laneSection s="0"><left>{}</left><center><lane id="0" type="none" level="false"/></center>
        <right>{}</right></laneSection></lanes></road></OpenDRIVE>"#,
        side(1),
        side(-1)
    ))
}

fn traffic(town: &Town, count: u32, parked_share: f64) -> Traffic {
    let config = VehicleConfig { count, parked_share, ..VehicleConfig::default() };
    let clock = Clock::new(40, 0.5, 0.1);
    let vehicles = Vehicles::new(town, &config, clock, Seed([7; 32])).unwrap();
    simulate(&mut [Box::new(vehicles)], clock, |_| Ok::<_, ()>(())).unwrap()
}

/// Those that never move.
fn parked(traffic: &Traffic) -> Vec<&Body> {
    let all = traffic.bodies.iter().filter(|body| body.states.len() == traffic.frames as usize);
    all.filter(|body| body.states.iter().all(|state| *state == body.states[0] && state.speed_mps == 0.0)).collect()
}

/// Places a quarter of a metre apart under a body.
fn footprint(body: &Body) -> Vec<DVec2> {
    let BodyPlan { size_m, .. } = body.plan;
    let state = body.states[0];
    let (sin, cos) = real::sin_cos(state.heading_rad);
    let place = |x: f64, y: f64| state.feet_in_world.truncate() + DVec2::new(cos * x - sin * y, sin * x + cos * y);
    let steps = |side_m: f64| (0..=(4.0 * side_m) as u32).map(move |step| f64::from(step) / 4.0 - 0.5 * side_m);
    steps(size_m.x).flat_map(|x| steps(size_m.y).map(move |y| place(x, y))).collect()
}

fn check_nobody_walks_there(town: &Town, cars: &[&Body]) {
    let walked = PolygonIndex::new(town.walkable.iter().map(|area| area.plan()).collect());
    for car in cars {
        let under = footprint(car).into_iter().find(|place| walked.at(*place).next().is_some());
        assert!(under.is_none(), "a car at {} stands where people walk", car.states[0].feet_in_world);
    }
}

#[test]
fn cars_are_parked_in_most_streets_of_generated_towns() {
    for seed in 0..3 {
        let town = generated(seed);
        let traffic = traffic(&town, 60, 0.6);
        let cars = parked(&traffic);
        check_nobody_walks_there(&town, &cars);
        let near =
            |place: DVec2| cars.iter().any(|car| (car.states[0].feet_in_world.truncate() - place).length() < 35.0);
        let streets = town.lanes.iter().filter(|lane| !lane.in_junction);
        let middles: Vec<DVec2> =
            streets.map(|lane| lane.middle_in_world[lane.middle_in_world.len() / 2].truncate()).collect();
        let with_cars = middles.iter().filter(|middle| near(**middle)).count();
        println!(
            "town {seed}: {} parked, near {with_cars} of {} lanes: {:?}",
            cars.len(),
            middles.len(),
            traffic.notes
        );
        assert!(cars.len() > 60 && with_cars * 3 > middles.len() * 2, "{} {with_cars} {}", cars.len(), middles.len());
    }
}

#[test]
fn nobody_leaves_a_town_because_cars_are_parked_in_its_lanes() {
    for (seed, parked_share) in [(0, 0.3), (1, 0.6), (2, 1.0)] {
        let town = generated(seed);
        let traffic = traffic(&town, 60, parked_share);
        // Streets of generated towns have no ends.
        let left = traffic.bodies.iter().filter(|body| body.states.len() < traffic.frames as usize).count();
        assert_eq!(left, 0, "town {seed}, share {parked_share}: {:?}", traffic.notes);
    }
}

#[test]
fn traffic_goes_on_for_minutes_with_and_without_parked_cars() {
    for (seed, parked_share) in [(0, 0.0), (0, 0.6), (1, 1.0)] {
        let config = VehicleConfig { count: 60, parked_share, ..VehicleConfig::default() };
        let clock = Clock::new(300, 2.0, 0.1);
        let vehicles = Vehicles::new(&generated(seed), &config, clock, Seed([7; 32])).unwrap();
        let traffic = simulate(&mut [Box::new(vehicles)], clock, |_| Ok::<_, ()>(())).unwrap();
        let cars = parked(&traffic).len();
        // Those who do not move in the last minute of ten.
        let moves = |body: &&Body| body.states[270..].iter().any(|state| state.speed_mps > 0.5);
        let moving = traffic.bodies.iter().filter(moves).count();
        println!("town {seed}, share {parked_share}: {} bodies, {cars} parked, {moving} move", traffic.bodies.len());
        assert!(moving >= 54, "town {seed}, share {parked_share}: {moving} of 60 move, {:?}", traffic.notes);
    }
}

#[test]
fn parking_lanes_fill_and_all_driving_lanes_stay_open() {
    for lanes in [&[("driving", 3.5), ("parking", 2.3)][..], &[("driving", 3.5), ("shoulder", 2.5)]] {
        let town = street(lanes);
        let all = traffic(&town, 20, 1.0);
        let cars = parked(&all);
        check_nobody_walks_there(&town, &cars);
        assert!(cars.len() > 30, "{lanes:?}: {} cars, {:?}", cars.len(), all.notes);
        for car in cars {
            let state = car.states[0];
            let (sin, cos) = real::sin_cos(0.3);
            // y of the map points to the left.
            let away_m = (state.feet_in_world.x * sin + state.feet_in_world.y * cos).abs();
            assert!((3.5 + 0.8..3.5 + 2.5 - 0.8).contains(&away_m), "{lanes:?}: {away_m}");
        }
        let directions = |sign: f64| {
            all.bodies
                .iter()
                .filter(|body| body.length_m() > 5.0)
                .filter(move |body| real::sin(body.states[0].heading_rad) * sign > 0.0)
                .count()
        };
        assert!(directions(1.0) > 2 && directions(-1.0) > 2, "{lanes:?}");
    }
}

#[test]
fn streets_without_room_have_no_parked_cars() {
    // Nothing leads on from a street that ends: none of its lanes may be taken without a second one.
    let town = street(&[("driving", 3.5)]);
    let cars = traffic(&town, 4, 1.0);
    assert!(parked(&cars).len() < 32, "one side at most");
    assert_eq!(parked(&traffic(&street(&[("driving", 3.5), ("parking", 2.3)]), 4, 0.0)).len(), 0);
}

#[test]
fn parked_cars_are_obstacles_around_flights() {
    let traffic = traffic(&generated(1), 10, 0.6);
    let car = parked(&traffic)[0];
    let track = TargetTrack { dt_s: traffic.dt_s, height_m: 1.7, radius_m: 0.3, states: car.states.clone() };
    let around = Around::of(&traffic, &track, None, 60.0);
    let own = car.plan.box_at(&car.states[0]);
    assert!(around.boxes().iter().any(|places| places.len() == car.states.len() && places.iter().all(|it| *it == own)));
}
