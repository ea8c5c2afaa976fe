//! Simulated vehicles: no overlaps, the same every time, speeds and accelerations of real drivers, yielding to people.

use cosfly_domain::{BodyKind, BodyPlan, Town, Traffic, WalkableKind};
use cosfly_frames::{DVec2, DVec3, Seed, TargetState};
use cosfly_maps::{MapConfig, read_town};
use cosfly_places::grid::{GenerateConfig, generate_town};
use cosfly_vehicles::{VehicleConfig, Vehicles};
use cosfly_world::{Clock, Population, Snapshot, contacts, simulate};

fn town(seed: u64) -> Town {
    let text = generate_town(&GenerateConfig::default(), seed);
    read_town(text.as_bytes(), &MapConfig::default(), Seed([1; 32])).unwrap().0
}

fn clock() -> Clock {
    Clock::new(240, 0.5, 0.1)
}

fn run(populations: &mut [Box<dyn Population>], clock: Clock) -> Traffic {
    simulate(populations, clock, |_| Ok::<_, ()>(())).unwrap()
}

fn vehicles(town: &Town, count: u32, seed: u64) -> Box<dyn Population> {
    let config = VehicleConfig { count, ..VehicleConfig::default() };
    Box::new(Vehicles::new(town, &config, clock(), Seed([7; 32]).child("test", seed)).unwrap())
}

#[test]
fn vehicles_never_overlap_and_hardly_ever_stop_at_once() {
    for seed in 0..3 {
        let town = town(seed);
        for count in [60, 150] {
            let traffic = run(&mut [vehicles(&town, count, seed)], clock());
            assert_eq!(contacts(&traffic, 0.0), [], "town {seed}, {count} vehicles");
            let driving = traffic.bodies.iter().filter(|body| body.states.iter().any(|it| it.speed_mps > 0.0));
            let (mut frames, mut hard, mut standing, mut stuck, mut drivers) = (0, 0, 0, 0, 0);
            for body in driving {
                drivers += 1;
                let mut still = 0;
                for pair in body.states.windows(2) {
                    let change_mps2 = (pair[1].speed_mps - pair[0].speed_mps) / traffic.dt_s;
                    frames += 1;
                    hard += usize::from(change_mps2.abs() > 4.5);
                    let turn_rad = cosfly_frames::real::wrap_angle_rad(pair[1].heading_rad - pair[0].heading_rad);
                    let sideways_mps2 = turn_rad.abs() / traffic.dt_s * pair[1].speed_mps.min(pair[0].speed_mps);
                    assert!(sideways_mps2 < 4.0, "{:?} turns with {sideways_mps2} m/s2", body.plan.kind);
                    assert!(pair[1].speed_mps < 1.3 * 13.89, "{:?} at {} m/s", body.plan.kind, pair[1].speed_mps);
                    still = if pair[1].speed_mps < 0.1 { still + 1 } else { 0 };
                    standing += usize::from(still > 0);
                    stuck += usize::from(still == 120);
                }
            }
            println!(
                "town {seed}: {drivers} of {count} drive, {} parked, {:.3} stand, {hard} of {frames} hard, {stuck} stuck: {:?}",
                traffic.bodies.len() - drivers,
                standing as f64 / frames as f64,
                traffic.notes
            );
            assert!(hard * 1000 < frames, "{hard} of {frames} frames brake harder than 4.5 m/s2");
            assert!(stuck * 25 <= drivers, "{stuck} of {drivers} stood for a minute");
        }
    }
}

#[test]
fn bends_are_taken_at_speeds_that_the_kinds_allow() {
    let frame_s = 0.2;
    let clock = Clock::new(500, frame_s, 0.1);
    for seed in 0..3 {
        let town = town(seed);
        let config = VehicleConfig { count: 60, ..VehicleConfig::default() };
        let vehicles = Vehicles::new(&town, &config, clock, Seed([7; 32]).child("bends", seed)).unwrap();
        let traffic = run(&mut [Box::new(vehicles)], clock);
        for (kind, limit_mps2) in [
            (BodyKind::Bicycle, 1.6),
            (BodyKind::Motorcycle, 2.5),
            (BodyKind::Car, 2.2),
            (BodyKind::Van, 2.0),
            (BodyKind::Truck, 1.5),
            (BodyKind::Bus, 1.2),
        ] {
            let mut sideways_mps2 = vec![];
            for body in traffic.bodies.iter().filter(|body| body.plan.kind == kind) {
                let places: Vec<DVec2> = body.states.iter().map(|state| state.feet_in_world.truncate()).collect();
                sideways_mps2.extend(places.windows(3).map(|places| {
                    let change = (places[2] - places[1]) - (places[1] - places[0]);
                    change.perp_dot((places[2] - places[0]).normalize_or_zero()).abs() / (frame_s * frame_s)
                }));
            }
            sideways_mps2.sort_unstable_by(f64::total_cmp);
            let Some(most) = sideways_mps2.last() else { continue };
            let usual = sideways_mps2[sideways_mps2.len() * 99 / 100];
            assert!(usual <= limit_mps2 && *most <= 1.2 * limit_mps2, "town {seed}: {kind:?} {usual} {most}");
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_traffic_and_another_one_another() {
    let town = town(1);
    let [one, same, other] = [3, 3, 4].map(|seed| run(&mut [vehicles(&town, 40, seed)], Clock::new(40, 0.5, 0.1)));
    assert!(one == same && one != other);
}

/// Somebody who walks over the middle of a crossing, again and again.
struct StreetCrosser {
    from: DVec2,
    to: DVec2,
    share: f64,
    waits: bool,
}

impl Population for StreetCrosser {
    fn plans(&self) -> Vec<BodyPlan> {
        let size_m = DVec3::new(0.5, 0.5, 1.75);
        vec![BodyPlan { source: String::new(), kind: BodyKind::Pedestrian, size_m, looks: Seed([0; 32]), group: None }]
    }

    fn state(&self, _: usize) -> Option<TargetState> {
        let along = self.to - self.from;
        let place = self.from + along * self.share.fract();
        let heading_rad = cosfly_frames::real::atan2(along.y, along.x);
        Some(TargetState {
            feet_in_world: place.extend(0.0),
            heading_rad,
            speed_mps: if self.waits { 0.0 } else { 1.3 },
        })
    }

    fn step(&mut self, _: f64, step_s: f64, everybody: &Snapshot) {
        // Waits at the kerb while a vehicle is on the crossing or cannot stop any more.
        let is_at_kerb = self.share.fract() < 0.02;
        let mut is_free = true;
        if is_at_kerb {
            let middle = 0.5 * (self.from + self.to);
            everybody.near(middle, 25.0, |body| {
                let away = middle - body.state.feet_in_world.truncate();
                let arrives = body.velocity_mps.dot(away) > 0.0 && away.length() < 3.0 * body.state.speed_mps + 6.0;
                is_free &= body.kind.is_person() || !arrives && away.length() > 8.0;
            });
        }
        self.waits = !is_free;
        if is_free {
            self.share += 1.3 * step_s / (self.to - self.from).length();
        }
    }
}

#[test]
fn vehicles_stop_for_people_on_crossings() {
    let town = town(2);
    let crossings: Vec<Vec<DVec2>> = town
        .walkable
        .iter()
        .filter(|area| area.kind == WalkableKind::Crossing && area.outline_in_world.len() == 4 && !area.synthetic)
        .map(|area| area.plan())
        .collect();
    assert!(crossings.len() > 20);
    let mut populations: Vec<Box<dyn Population>> = vec![vehicles(&town, 120, 9)];
    for corners in &crossings {
        let sides: [[DVec2; 2]; 2] = [[corners[0], corners[1]], [corners[1], corners[2]]];
        let long = usize::from(sides[1][0].distance(sides[1][1]) > sides[0][0].distance(sides[0][1]));
        let shift = 0.5 * (sides[1 - long][1] - sides[1 - long][0]) * if long == 0 { 1.0 } else { -1.0 };
        let [from, to] = sides[long].map(|corner| corner + shift);
        populations.push(Box::new(StreetCrosser { from, to, share: 0.0, waits: true }));
    }
    let traffic = run(&mut populations, clock());
    let found = contacts(&traffic, 0.0);
    println!("{:?}", traffic.notes);
    assert_eq!(found, []);
    let walked =
        traffic.bodies.iter().filter(|body| body.plan.kind.is_person()).map(|body| body.length_m()).sum::<f64>();
    let driven =
        traffic.bodies.iter().filter(|body| !body.plan.kind.is_person()).map(|body| body.length_m()).sum::<f64>();
    println!("walked {walked:.0} m, driven {driven:.0} m");
    assert!(driven > 5_000.0 && walked > 5_000.0, "both go on: {driven} {walked}");
}

#[test]
fn a_town_without_lanes_is_refused() {
    let error = Vehicles::new(&Town::default(), &VehicleConfig::default(), clock(), Seed([1; 32])).err().unwrap();
    assert!(error.to_string().contains("no lanes"), "{error}");
    let none = VehicleConfig { count: 0, ..VehicleConfig::default() };
    assert!(Vehicles::new(&Town::default(), &none, clock(), Seed([1; 32])).is_ok());
}
