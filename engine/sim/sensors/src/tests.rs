//! Laws of all sensors, and the numbers of each.

use crate::{ALL, SensedFlight, Sensor, SensorPlace, SensorSet, called};
use cosfly_domain::{Mount, OrientedBox, Town, channels};
use cosfly_frames::{DVec3, Pose, Seed};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_maps::{MapConfig, read_town};
use cosfly_town::GroundIndex;
use std::path::Path;

const DT_S: f64 = 0.25;

/// A town, ready for sensors.
struct World {
    town: Town,
    exact: BoxBvh,
    ground: GroundIndex,
}

fn world() -> World {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../recipes/towns/downtown.xodr");
    let map = std::fs::read(path).expect("a shipped town");
    let town = read_town(&map, &MapConfig::default(), Seed([5; 32])).expect("a map").0;
    let exact = BoxBvh::build(town.obstacles.iter().map(|obstacle| obstacle.shape).collect());
    World { exact, ground: GroundIndex::new(&town), town }
}

/// A box of 2 m beside the flight's third frame that is there for the first two seconds.
fn bodies(world: &World) -> impl Fn(f64, &mut Vec<OrientedBox>) {
    let below = poses(world)[3].position_in_world - 5.0 * DVec3::Z;
    move |time_s, list| {
        let shape = OrientedBox::from_corners(below - DVec3::ONE, below + DVec3::ONE);
        list.extend((time_s <= 2.0).then_some(shape));
    }
}

/// A flight across a town, over roofs and streets, that climbs out of the beam's range.
fn poses(world: &World) -> Vec<Pose> {
    let (low, high) = (world.town.min_in_world, world.town.max_in_world);
    let at = |frame: i32| {
        let share = f64::from(frame) / 40.0;
        let position_in_world = DVec3 { z: low.z + 30.0 + 110.0 * share * share, ..low.lerp(high, 0.1 + 0.8 * share) };
        Pose { position_in_world, pitch_rad: -0.3, yaw_rad: 3.0 + share, roll_rad: 0.1 }
    };
    (0..=40).map(at).collect()
}

/// A reading with numbers of its own.
type Kept = (usize, f64, Vec<f64>);

fn readings(world: &World, poses_in_world: &[Pose], sensor: &Sensor, rate_hz: Option<f64>) -> Vec<Kept> {
    let place = SensorPlace { position_in_body: DVec3::new(0.3, 0.0, -0.1), ..SensorPlace::default() };
    let World { exact: town, ground, .. } = world;
    let (bodies, seed) = (&bodies(world), Seed([3; 32]));
    let flown = SensedFlight { town, ground, bodies, poses_in_world, dt_s: DT_S, place, rate_hz, seed };
    let mut all = vec![];
    flown.read(sensor, &mut |it| all.push((it.frame, it.time_s, it.values.to_vec())));
    assert_eq!(all.len(), flown.readings());
    all
}

#[test]
fn names_are_words_and_columns_have_a_meaning() {
    assert!(ALL.is_sorted_by_key(|sensor| sensor.name));
    for sensor in ALL {
        let names: Vec<&str> = sensor.quantities.iter().map(|quantity| quantity.name).collect();
        for name in names.iter().chain([&sensor.name]) {
            assert!(name.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'_'), "{name}");
        }
        assert!((1..names.len()).all(|at| !names[at..].contains(&names[at - 1])), "{}: {names:?}", sensor.name);
        // A name in `obs=` is of one thing; columns that the table has of its own.
        assert!(
            channels::called(sensor.name).is_none() && !["state", "prompt", "episode", "step"].contains(&sensor.name)
        );
        assert!(!["trajectory_id", "row", "split", "frame", "time_s"].iter().any(|own| names.contains(own)));
        assert!(sensor.doc.ends_with('.') && sensor.quantities.iter().all(|it| !it.doc.is_empty()), "{}", sensor.name);
    }
}

#[test]
fn every_sensor_fills_finite_numbers_at_each_moment_and_repeats_itself() {
    let world = world();
    let poses = poses(&world);
    for sensor in ALL {
        let often = readings(&world, &poses, sensor, Some(40.0));
        assert_eq!(often, readings(&world, &poses, sensor, Some(40.0)), "{}", sensor.name);
        assert!(often.iter().all(|(_, _, values)| values.iter().all(|value| value.is_finite())), "{}", sensor.name);
        let by_frame = readings(&world, &poses, sensor, None);
        assert_eq!(by_frame.len(), poses.len());
        assert!(by_frame.iter().enumerate().all(|(frame, it)| it.0 == frame && it.1 == frame as f64 * DT_S));
        // A flight of one frame, and of none.
        assert_eq!(readings(&world, &poses[..1], sensor, Some(40.0)).len(), 1);
        assert!(readings(&world, &[], sensor, Some(40.0)).is_empty() && readings(&world, &[], sensor, None).is_empty());
    }
}

#[test]
fn readings_begin_with_the_flight_and_end_within_it() {
    let world = world();
    let poses = poses(&world);
    let last = poses.len() - 1;
    for rate_hz in [0.3, 1.0 / DT_S, 7.0, 1000.0] {
        let all = readings(&world, &poses, ALL[0], Some(rate_hz));
        assert_eq!((all[0].0, all[0].1), (0, 0.0));
        let end = all.last().expect("a reading");
        let end_s = last as f64 * DT_S;
        assert!(end.1 <= end_s + 1e-6 && end.1 > end_s - 1.0 / rate_hz, "{rate_hz}: {end:?}");
        assert!(end.0 <= last && all.is_sorted_by_key(|it| it.0));
    }
}

#[test]
fn a_sensor_sits_and_moves_where_its_place_says() {
    let body = Pose { position_in_world: DVec3::new(3.0, -2.0, 9.0), pitch_rad: 0.0, yaw_rad: 1.2, roll_rad: 0.0 };
    let mount = Mount { pitch_rad: -0.4, yaw_rad: 0.3, levelled: false };
    let place = SensorPlace { position_in_body: DVec3::new(0.2, 0.0, -0.1), mount };
    let on = place.on(&body);
    let expected = body.position_in_world + body.world_from_body() * place.position_in_body;
    assert!(on.position_in_world.distance(expected) < 1e-12);
    assert!((on.yaw_rad - 1.5).abs() < 1e-12 && (on.pitch_rad + 0.4).abs() < 1e-12);
    assert_eq!(SensorPlace::default().on(&body), body);

    // Even motion has one velocity, at the ends, too.
    static SPEED: Sensor = Sensor {
        name: "speed",
        doc: "Speed.",
        version: 1,
        quantities: &[],
        read: |at, _| assert!(at.velocity_in_world.abs_diff_eq(DVec3::new(2.0, 0.0, -1.0), 1e-9)),
    };
    let moved = |frame: i32| Pose { position_in_world: DVec3::new(2.0, 0.0, -1.0) * f64::from(frame) * DT_S, ..body };
    let poses: Vec<Pose> = (0..9).map(moved).collect();
    assert_eq!(readings(&world(), &poses, &SPEED, Some(17.0)).len(), 35);
}

#[test]
fn the_beam_ends_at_the_first_thing_below() {
    let world = world();
    let poses = poses(&world);
    let sensor = called("laser_altimeter").expect("in the list");
    let place = SensorPlace { position_in_body: DVec3::new(0.3, 0.0, -0.1), ..SensorPlace::default() };
    let (mut roofs, mut far, mut on_bodies) = (0, 0, 0);
    for (frame, time_s, values) in readings(&world, &poses, sensor, None) {
        let from = place.on(&poses[frame]).position_in_world;
        // Oracle: small steps down, until a box or the ground is reached.
        let ground = |at: DVec3| world.ground.ground_height_m(at.x, at.y).is_some_and(|height_m| at.z <= height_m);
        let mut about = vec![];
        bodies(&world)(time_s, &mut about);
        let about = BoxBvh::build(about);
        let is_body = |down_m: f64| about.nearest(from - DVec3::Z * down_m, 0.0).is_some();
        let is_solid = |down_m: &f64| {
            let at = from - DVec3::Z * *down_m;
            ground(at) || world.exact.nearest(at, 0.0).is_some() || is_body(*down_m)
        };
        let first = (0..=10_000).map(|step| f64::from(step) * 0.01).find(is_solid);
        assert!((values[0] - first.unwrap_or(100.0)).abs() < 0.011, "frame {frame}: {values:?}, {first:?}");
        assert_eq!(values[1], if first.is_some() { 1.0 } else { 0.0 });
        on_bodies += usize::from(first.is_some_and(|down_m| is_body(down_m + 0.02)));
        roofs += usize::from(first.is_some_and(|down_m| !ground(from - DVec3::Z * (down_m + 0.02))));
        far += usize::from(first.is_none());
    }
    assert!(roofs > 0 && far > 0 && on_bodies > 0, "{roofs} roofs, {on_bodies} on bodies, {far} out of range");
}

#[test]
fn a_set_has_the_chosen_sensors_in_the_order_of_the_list() {
    let all = SensorSet::of(|_| true);
    assert!(all.iter().map(|it| it.name).eq(ALL.iter().map(|it| it.name)) && ALL.len() <= 64);
    assert!(SensorSet::default().iter().next().is_none());
    for sensor in ALL {
        let one = SensorSet::of(|it| it.name == sensor.name);
        assert_eq!(one.iter().map(|it| it.name).collect::<Vec<_>>(), [sensor.name]);
    }
}
