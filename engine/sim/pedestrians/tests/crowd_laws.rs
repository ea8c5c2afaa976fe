//! Laws of crowds in small towns: no order, no later frame and no other person's number changes a state; vehicles are kept clear
//! of; scripts are played as written.

use cosfly_domain::{Body, BodyKind, BodyPlan, Town, Traffic, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3, Seed, TargetState, real};
use cosfly_pedestrians::KindShares;
use cosfly_pedestrians::crowd::GroupConfig;
use cosfly_pedestrians::{Crowd, CrowdConfig, ScriptedPerson, WalkableGrid, Waypoint, path_of, scripted};
use cosfly_world::{Clock, Population, Prescribed, contacts, simulate};
use std::sync::Arc;

/// Two pavements of 4 m along a road of 8 m that one crossing joins, 120 m long.
fn street() -> Town {
    let rectangle = |kind: WalkableKind, low: (f64, f64), high: (f64, f64)| WalkablePolygon {
        kind,
        outline_in_world: [(low.0, low.1), (high.0, low.1), (high.0, high.1), (low.0, high.1)]
            .map(|(x, y)| DVec3::new(x, y, 0.0))
            .to_vec(),
        synthetic: true,
    };
    let walkable = vec![
        rectangle(WalkableKind::Sidewalk, (-60.0, -8.0), (60.0, -4.0)),
        rectangle(WalkableKind::Sidewalk, (-60.0, 4.0), (60.0, 8.0)),
        rectangle(WalkableKind::Crossing, (-2.0, -4.0), (2.0, 4.0)),
    ];
    let mut town = Town { name: "street".into(), walkable, ..Town::default() };
    town.update_bounds();
    town
}

fn grid(town: &Town, config: &CrowdConfig) -> Arc<WalkableGrid> {
    Arc::new(Crowd::grid(town, config).unwrap())
}

fn crowd(grid: &Arc<WalkableGrid>, config: &CrowdConfig, clock: Clock, seed: u64) -> Box<dyn Population> {
    Box::new(Crowd::new(grid.clone(), config, clock, Seed::of_item(seed, "traffic", "people")).unwrap())
}

fn simulated(mut populations: Vec<Box<dyn Population>>, clock: Clock) -> Traffic {
    simulate(&mut populations, clock, |_| Ok::<_, ()>(())).unwrap()
}

/// Cars that come along both lanes of the street, one every few seconds, and yield to nobody.
fn cars(clock: Clock, speed_mps: f64, apart_m: f64) -> Box<dyn Population> {
    let car = |number: u32| {
        let plan = BodyPlan {
            source: String::new(),
            kind: BodyKind::Car,
            size_m: DVec3::new(4.5, 1.8, 1.5),
            looks: Seed([0; 32]),
            group: None,
        };
        let forth = number.is_multiple_of(2);
        let (side, heading_rad) = if forth { (2.0, 0.0) } else { (-2.0, core::f64::consts::PI) };
        let state = |frame: u32| {
            let along_m = speed_mps * clock.dt_s * f64::from(frame) - apart_m * f64::from(number / 2) - 20.0;
            let x = if forth { along_m } else { -along_m };
            TargetState { feet_in_world: DVec3::new(x, side, 0.0), heading_rad, speed_mps }
        };
        Body { plan, first_frame: 0, states: (0..clock.frames).map(state).collect() }
    };
    Box::new(Prescribed::new((0..24).map(car).collect(), clock.dt_s, vec![]))
}

#[test]
fn the_order_of_populations_changes_no_state() {
    let (town, config) = (street(), CrowdConfig { count: 40, ..CrowdConfig::default() });
    let grid = grid(&town, &config);
    let clock = Clock::new(120, 0.5, 0.1);
    let make = |which: usize| match which {
        0 => crowd(&grid, &config, clock, 1),
        _ => cars(clock, 7.0, 60.0),
    };
    let one = simulated(vec![make(0), make(1)], clock);
    let other = simulated(vec![make(1), make(0)], clock);
    assert!(one.bodies[..40] == other.bodies[24..], "people");
    assert!(one.bodies[40..] == other.bodies[..24], "cars");
}

#[test]
fn a_shorter_simulation_is_the_beginning_of_a_longer_one() {
    let (town, config) = (street(), CrowdConfig { count: 30, ..CrowdConfig::default() });
    let grid = grid(&town, &config);
    let run = |frames: u32| {
        let clock = Clock::new(frames, 0.5, 0.1);
        simulated(vec![crowd(&grid, &config, clock, 2)], clock)
    };
    let (short, long) = (run(40), run(120));
    for (one, other) in short.bodies.iter().zip(&long.bodies) {
        assert!(one.plan == other.plan && one.states[..] == other.states[..40]);
    }
}

#[test]
fn the_first_people_are_the_same_whatever_their_number() {
    let (town, config) = (street(), CrowdConfig { count: 30, ..CrowdConfig::default() });
    let grid = grid(&town, &config);
    let clock = Clock::new(2, 0.5, 0.1);
    let few = crowd(&grid, &config, clock, 3);
    let many = crowd(&grid, &CrowdConfig { count: 60, ..config.clone() }, clock, 3);
    let (few_plans, many_plans) = (few.plans(), many.plans());
    // The last company of a crowd may have been cut short.
    for body in 0..26 {
        assert_eq!((few.state(body), &few_plans[body]), (many.state(body), &many_plans[body]));
    }
}

#[test]
fn frames_of_any_length_keep_bodies_apart_and_feet_on_the_ground() {
    let (town, config) = (street(), CrowdConfig { count: 150, ..CrowdConfig::default() });
    let grid = grid(&town, &config);
    for (frames, dt_s, step_s) in [(300, 0.1, 0.1), (60, 0.5, 0.1), (60, 0.5, 0.5), (40, 1.0, 0.2)] {
        let clock = Clock::new(frames, dt_s, step_s);
        let traffic = simulated(vec![crowd(&grid, &config, clock, 4)], clock);
        assert_eq!(contacts(&traffic, 0.0), [], "{dt_s} s");
        for (number, body) in (0..).zip(&traffic.bodies) {
            for pair in body.states.windows(2) {
                let (from, to) = (pair[0].feet_in_world, pair[1].feet_in_world);
                assert!(grid.ground().covers(from, to), "{dt_s} s: person {number} from {from} to {to}");
            }
            let path = path_of(Some(grid.ground()), traffic.track(number).unwrap());
            assert_eq!((path.ground.len(), path.standing.len()), (frames as usize, frames as usize));
        }
    }
}

#[test]
fn runners_run_alone_past_people_who_walk_and_touch_nobody() {
    let kinds = KindShares { runner: 0.3, ..KindShares::default() };
    let groups = GroupConfig { share: 0.0, ..GroupConfig::default() };
    let config = CrowdConfig { count: 40, kinds, groups, ..CrowdConfig::default() };
    let (town, clock) = (street(), Clock::new(120, 0.5, 0.1));
    let traffic = simulated(vec![crowd(&grid(&town, &config), &config, clock, 5)], clock);
    assert_eq!(contacts(&traffic, 0.0), []);
    let fastest_mps = |kind: BodyKind| {
        let of_kind = traffic.bodies.iter().filter(|body| body.plan.kind == kind);
        of_kind.flat_map(|body| &body.states).map(|state| state.speed_mps).fold(0.0, f64::max)
    };
    let [walks_mps, runs_mps] = [BodyKind::Pedestrian, BodyKind::Runner].map(fastest_mps);
    // Steps are chords of ways: nobody walks faster than this.
    assert!(walks_mps < 2.76 && runs_mps > 2.8, "{walks_mps} m/s, {runs_mps} m/s");
}

#[test]
fn children_and_wide_people_keep_apart_and_restless_ones_turn_about() {
    let kinds = KindShares {
        child: 0.2,
        dog_walker: 0.2,
        elder: 0.2,
        push_chair: 0.2,
        wheelchair: 0.2,
        ..KindShares::default()
    };
    let config = CrowdConfig { count: 40, kinds, ..CrowdConfig::default() };
    let (town, clock) = (street(), Clock::new(120, 0.5, 0.1));
    let traffic = simulated(vec![crowd(&grid(&town, &config), &config, clock, 5)], clock);
    assert_eq!(contacts(&traffic, 0.0), []);
    let kinds: std::collections::BTreeSet<BodyKind> = traffic.bodies.iter().map(|body| body.plan.kind).collect();
    assert_eq!(kinds.len(), 5);
    let way_m = traffic.bodies.iter().map(Body::length_m).sum::<f64>() / 40.0;
    let kinds = KindShares { sitter: 0.3, ..KindShares::default() };
    let config = CrowdConfig { count: 40, kinds, ..CrowdConfig::default() };
    let ground = grid(&town, &config);
    let traffic = simulated(vec![crowd(&ground, &config, clock, 5)], clock);
    assert_eq!(contacts(&traffic, 0.0), []);
    let sitters = traffic.bodies.iter().filter(|body| body.plan.kind == BodyKind::Sitter);
    assert!(sitters.clone().count() > 5 && sitters.clone().all(|body| body.length_m() == 0.0));
    // Nobody who sits has ground of people close behind, and everybody has some ahead.
    for body in sitters {
        let state = body.states[0];
        let (sin, cos) = real::sin_cos(state.heading_rad);
        let ahead = DVec2::new(cos, sin);
        let is_free =
            |way: DVec2| ground.step_is_free(state.feet_in_world.truncate(), state.feet_in_world.truncate() + way);
        assert!(is_free(0.8 * ahead) && !is_free(-1.2 * ahead), "{state:?}");
    }
    let turned_deg = |restless_share: f64| {
        let config = CrowdConfig { count: 20, restless_share, ..CrowdConfig::default() };
        let traffic = simulated(vec![crowd(&grid(&town, &config), &config, clock, 5)], clock);
        assert_eq!(contacts(&traffic, 0.0), []);
        let turn = |pair: &[TargetState]| real::wrap_angle_rad(pair[1].heading_rad - pair[0].heading_rad).abs();
        let turns = traffic.bodies.iter().flat_map(|body| body.states.windows(2).map(turn));
        turns.sum::<f64>().to_degrees() / (20.0 * 12.0)
    };
    let (calm, restless) = (turned_deg(0.0), turned_deg(1.0));
    println!("mean way {way_m:.1} m; turns in 5 s: {calm:.0} and {restless:.0} degrees");
    assert!(way_m > 25.0 && restless > 90.0 && restless > 1.5 * calm, "{way_m} m, {calm}, {restless} degrees");
}

#[test]
fn people_cross_between_cars_that_stop_for_nobody_and_touch_none() {
    let (town, config) = (street(), CrowdConfig { count: 30, ..CrowdConfig::default() });
    let grid = grid(&town, &config);
    let clock = Clock::new(300, 0.5, 0.1);
    let mut crossed = 0;
    for seed in 1..=8 {
        let traffic = simulated(vec![crowd(&grid, &config, clock, seed), cars(clock, 8.0, 80.0)], clock);
        assert_eq!(contacts(&traffic, 0.0), [], "seed {seed}");
        let tracks = traffic.bodies[..30].iter().map(|body| &body.states);
        let sides = |pair: &[TargetState]| {
            pair[0].feet_in_world.y.is_sign_positive() != pair[1].feet_in_world.y.is_sign_positive()
        };
        crossed += tracks.map(|states| states.windows(2).filter(|pair| sides(pair)).count()).sum::<usize>();
    }
    println!("{crossed} ways over the road");
    assert!(crossed > 160, "{crossed} ways over the road");
}

#[test]
fn two_crowds_and_people_who_make_no_way_do_not_overlap() {
    let (town, config) = (street(), CrowdConfig { count: 25, ..CrowdConfig::default() });
    let grid = grid(&town, &config);
    let clock = Clock::new(200, 0.5, 0.1);
    let script = |id: &str, from: [f64; 2], to: [f64; 2]| ScriptedPerson {
        id: id.into(),
        route: vec![
            Waypoint { at_m: from, time_s: None, wait_s: 2.0 },
            Waypoint { at_m: to, time_s: Some(80.0), wait_s: 0.0 },
        ],
        speed_mps: 1.3,
        height_m: 1.8,
        radius_m: 0.25,
    };
    let scripts = [script("east", [-50.0, 6.0], [50.0, 6.0]), script("west", [50.0, -6.0], [-50.0, -6.0])];
    let played = scripted(&scripts, &grid, 3.0, clock, Seed([1; 32])).unwrap();
    let ends: Vec<DVec2> = played.bodies().iter().map(|body| body.states[199].feet_in_world.truncate()).collect();
    assert!(
        ends[0].distance(DVec2::new(50.0, 6.0)) < 0.5 && ends[1].distance(DVec2::new(-50.0, -6.0)) < 0.5,
        "{ends:?}"
    );
    assert_eq!(played.bodies()[0].states[3].speed_mps, 0.0);
    let begins = |population: &dyn Population| -> Vec<(DVec2, f64)> {
        let plans = population.plans();
        let place = |(body, plan): (usize, &BodyPlan)| {
            population.state(body).map(|state| (state.feet_in_world.truncate(), plan.radius_m()))
        };
        plans.iter().enumerate().filter_map(place).collect()
    };
    let mut taken = begins(&played);
    let beside = |taken: &[(DVec2, f64)], seed: u64| {
        let seed = Seed::of_item(seed, "traffic", "people");
        Box::new(Crowd::beside(grid.clone(), &config, clock, seed, taken).unwrap())
    };
    let first = beside(&taken, 6);
    taken.extend(begins(&*first));
    let second = beside(&taken, 7);
    let traffic = simulated(vec![first, Box::new(played) as Box<dyn Population>, second], clock);
    assert_eq!(contacts(&traffic, 0.0), []);
}

#[test]
fn scripts_that_cannot_be_played_are_refused() {
    let (town, config) = (street(), CrowdConfig::default());
    let grid = grid(&town, &config);
    let at = |x: f64, y: f64, time_s: Option<f64>| Waypoint { at_m: [x, y], time_s, wait_s: 0.0 };
    let refused = |route: Vec<Waypoint>| {
        let person = ScriptedPerson { id: "Ada".into(), route, speed_mps: 1.3, height_m: 1.8, radius_m: 0.25 };
        scripted(&[person], &grid, 3.0, Clock::new(10, 0.5, 0.1), Seed([1; 32])).unwrap_err().to_string()
    };
    assert_eq!(refused(vec![]), "the route of `Ada` has no waypoint; it needs at least one");
    assert_eq!(
        refused(vec![at(0.0, 6.0, None), at(0.0, 60.0, None)]),
        "waypoint 2 of `Ada` at (0, 60) is not on walkable ground; the nearest is at (-0.2, 7.8)"
    );
    let fast = refused(vec![at(0.0, 6.0, None), at(50.0, 6.0, Some(5.0))]);
    assert!(fast.starts_with("waypoint 2 of `Ada` is 5") && fast.ends_with("at most 3 m/s are allowed"), "{fast}");
    assert_eq!(
        refused(vec![at(0.0, 6.0, Some(5.0)), at(50.0, 6.0, Some(4.0))]),
        "`time_s` is `4`; it must be within `5` and `1000000`"
    );
    assert_eq!(refused(vec![at(f64::NAN, 6.0, None)]), "`at_m` is `NaN`; it must be within `-10000000` and `10000000`");
}
