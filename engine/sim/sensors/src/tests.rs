//! Laws of all sensors, and the numbers of each.

use crate::constellation::directions_in_world;
use crate::inertial_unit::{ACCELEROMETER, GYROSCOPE};
use crate::{ALL, Carrier, GeoOrigin, SensedFlight, Sensor, SensorPlace, SensorSet, called};
use cosfly_domain::{Mount, OrientedBox, Town, channels};
use cosfly_frames::{DMat3, DQuat, DVec3, Pose, Seed, real};
use cosfly_geometry::{BoxBvh, BruteForce, SpatialQuery};
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
    let (bodies, seed, origin) = (&bodies(world), Seed([3; 32]), GeoOrigin::default());
    let flown = SensedFlight { town, ground, bodies, poses_in_world, dt_s: DT_S, place, rate_hz, origin, seed };
    let mut all = vec![];
    flown.read(sensor, &mut |it| all.push((it.frame, it.time_s, it.values.to_vec())));
    assert_eq!(all.len(), flown.readings());
    all
}

#[test]
fn names_are_words_and_columns_have_a_meaning() {
    assert!(ALL.is_sorted_by_key(|sensor| sensor.name));
    for sensor in ALL {
        let numbers = || sensor.quantities.iter().chain(sensor.truths);
        let names: Vec<&str> = numbers().map(|quantity| quantity.name).collect();
        for name in names.iter().chain([&sensor.name]) {
            let is_word = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_';
            assert!(name.bytes().all(is_word), "{name}");
        }
        let is_true = |name: &str| name.starts_with("true_");
        assert!(
            sensor.truths.iter().all(|it| is_true(it.name)) && !sensor.quantities.iter().any(|it| is_true(it.name))
        );
        assert!((1..names.len()).all(|at| !names[at..].contains(&names[at - 1])), "{}: {names:?}", sensor.name);
        // A name in `obs=` is of one thing; columns that the table has of its own.
        assert!(
            channels::called(sensor.name).is_none() && !["state", "prompt", "episode", "step"].contains(&sensor.name)
        );
        assert!(!["trajectory_id", "row", "split", "frame", "time_s"].iter().any(|own| names.contains(own)));
        assert!(sensor.doc.ends_with('.') && numbers().all(|it| !it.doc.is_empty()), "{}", sensor.name);
    }
}

#[test]
fn every_sensor_fills_finite_numbers_at_each_moment_and_repeats_itself() {
    let world = world();
    let poses = poses(&world);
    for sensor in ALL {
        let often = readings(&world, &poses, sensor, Some(40.0));
        assert!(often.iter().all(|(_, _, values)| values.len() == sensor.count()), "{}", sensor.name);
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
    let mount = Mount { pitch_rad: -0.4, yaw_rad: 0.3, ..Mount::default() };
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
        carrier: Carrier::Camera,
        quantities: &[],
        truths: &[],
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

/// A flight that climbs, turns and brakes, over open ground, with frames `DT_S` apart.
fn smooth_poses(frames: u32) -> Vec<Pose> {
    let at = |frame: u32| {
        let time_s = f64::from(frame) * DT_S;
        let along = DVec3::new(4.0 * time_s, 9.0 * real::sin(0.7 * time_s), 30.0 + 3.0 * real::sin(0.4 * time_s));
        Pose { position_in_world: along, pitch_rad: -0.4, yaw_rad: 0.5 * time_s, roll_rad: 0.0 }
    };
    (0..frames).map(at).collect()
}

/// Readings over open ground, from a seed.
fn open_readings(poses_in_world: &[Pose], dt_s: f64, sensor: &Sensor, place: SensorPlace, rate_hz: f64) -> Vec<Kept> {
    let (town, ground) = (&BoxBvh::build(vec![]), &GroundIndex::of_surfaces(&[], |_| true));
    let (seed, origin) = (Seed([6; 32]), GeoOrigin { latitude_deg: 49.0, longitude_deg: 8.0 });
    let (bodies, rate_hz) = (&|_: f64, _: &mut Vec<OrientedBox>| {}, Some(rate_hz));
    let flown = SensedFlight { town, ground, bodies, poses_in_world, dt_s, place, rate_hz, origin, seed };
    let mut all = vec![];
    flown.read(sensor, &mut |it| all.push((it.frame, it.time_s, it.values.to_vec())));
    all
}

#[test]
fn true_inertial_readings_add_up_to_the_flight() {
    let (poses, rate_hz) = (smooth_poses(41), 200.0);
    let mount = Mount { pitch_rad: 0.3, yaw_rad: -0.9, ..Mount::default() };
    let place = SensorPlace { position_in_body: DVec3::new(0.2, -0.1, 0.05), mount };
    let all = open_readings(&poses, DT_S, called("inertial_unit").expect("in the list"), place, rate_hz);
    let vector = |index: usize, first: usize| DVec3::from_slice(&all[index].2[first..first + 3]);
    let first = &all[0].2;
    let (mut position, mut velocity) = (vector(0, 12), vector(0, 15));
    let mut world_from_sensor = DMat3::from_quat(DQuat::from_slice(&first[18..22]));
    let step_s = 1.0 / rate_hz;
    for index in 1..all.len() {
        let (rates, next_rates) = (vector(index - 1, 9), vector(index, 9));
        let turn = 0.5 * step_s * (rates + next_rates);
        let next = world_from_sensor * DMat3::from_quat(DQuat::from_scaled_axis(turn));
        let felt = |attitude: &DMat3, index: usize| *attitude * vector(index, 6) - 9.81 * DVec3::Z;
        let mean = 0.5 * (felt(&world_from_sensor, index - 1) + felt(&next, index));
        position += step_s * (velocity + 0.5 * step_s * mean);
        velocity += step_s * mean;
        world_from_sensor = next;
    }
    let last = all.len() - 1;
    assert_eq!((last, all[last].1), (2000, 10.0));
    let away_m = position.distance(vector(last, 12));
    assert!(away_m < 0.01, "{away_m} m after 10 s");
    // The sensor is where the frame's drone carries it.
    assert!(vector(last, 12).distance(poses[40].position_in_world) < 0.25);
}

#[test]
fn errors_at_rest_have_the_stated_allan_deviations() {
    let pose = Pose { position_in_world: DVec3::new(0.0, 0.0, 30.0), pitch_rad: 0.0, yaw_rad: 1.0, roll_rad: 0.0 };
    let (rate_hz, count) = (2.0, 100_000_usize);
    let poses = [pose; 2];
    let dt_s = (count - 1) as f64 / rate_hz;
    let all =
        open_readings(&poses, dt_s, called("inertial_unit").expect("in the list"), SensorPlace::default(), rate_hz);
    assert_eq!(all.len(), count);
    for (first, errors) in [(0, ACCELEROMETER), (3, GYROSCOPE)] {
        for readings_of_mean in [1_usize, 10, 400] {
            let time_s = readings_of_mean as f64 / rate_hz;
            let variance =
                (first..first + 3).map(|axis| allan_variance(&all, axis, readings_of_mean)).sum::<f64>() / 3.0;
            // White noise, and a Gauss-Markov process (IEEE 952, C.12).
            let (tau_s, deviation) = (errors.bias.time_constant_s, errors.bias.deviation);
            let share = tau_s / (2.0 * time_s);
            let faded = 3.0 - 4.0 * real::exp(-time_s / tau_s) + real::exp(-2.0 * time_s / tau_s);
            let wander = 2.0 * deviation * deviation * tau_s / time_s * (1.0 - share * faded);
            let expected = (errors.density * errors.density / time_s + wander).sqrt();
            let found = variance.sqrt();
            assert!((found / expected - 1.0).abs() < 0.1, "{first}, {time_s} s: {found} {expected}");
        }
    }
    assert!(all.iter().all(|(_, _, values)| (values[2] - 9.81).abs() < 0.15 && (values[8] - 9.81).abs() < 1e-12));
}

/// Overlapping Allan variance of a number of the readings over means of `count` readings.
fn allan_variance(all: &[Kept], number: usize, count: usize) -> f64 {
    let mut sums = vec![0.0];
    all.iter().for_each(|(_, _, values)| sums.push(sums[sums.len() - 1] + values[number] - all[0].2[number]));
    let mean = |from: usize| (sums[from + count] - sums[from]) / count as f64;
    let pairs = all.len() - 2 * count + 1;
    (0..pairs).map(|from| mean(from + count) - mean(from)).map(|step| 0.5 * step * step).sum::<f64>() / pairs as f64
}

#[test]
fn the_drift_of_a_flight_is_the_same_at_any_rate() {
    let poses = smooth_poses(9);
    let sensor = called("inertial_unit").expect("in the list");
    let [slow, fast] =
        [10.0, 200.0].map(|rate_hz| open_readings(&poses, DT_S, sensor, SensorPlace::default(), rate_hz));
    for (index, (_, time_s, values)) in slow.iter().enumerate() {
        let (_, same_s, other) = &fast[20 * index];
        assert!((time_s - same_s).abs() < 1e-12);
        // The truths; what is measured has another noise.
        assert!(values[6..].iter().zip(&other[6..]).all(|(a, b)| (a - b).abs() < 1e-12));
        assert_ne!(values[0], other[0]);
    }
}

#[test]
fn satellites_hide_behind_houses_and_fewer_give_worse_positions() {
    let world = world();
    let sensor = called("satellite_receiver").expect("in the list");
    let (boxes, ground) = (BruteForce::new(world.exact.boxes()), &world.ground);
    let (mut least, mut most, mut outages) = (99.0_f64, 0.0_f64, 0);
    let (mut open_error, mut narrow_error) = (vec![], vec![]);
    let (low, high) = (world.town.min_in_world, world.town.max_in_world);
    // Two metres above the ground, all over the town; and high above it.
    for place in 0..300 {
        let share = |count: i32| (f64::from(place) * f64::from(count) * 0.618_034).fract();
        let across = DVec3::new(low.x + (high.x - low.x) * share(1), low.y + (high.y - low.y) * share(2), 2.0);
        let position_in_world = if place % 3 == 0 { across + 300.0 * DVec3::Z } else { across };
        let pose = Pose { position_in_world, pitch_rad: 0.0, yaw_rad: 0.0, roll_rad: 0.0 };
        let (seed, bodies) = (Seed([place as u8; 32]), &|_: f64, _: &mut Vec<OrientedBox>| {});
        let (town, origin, dt_s) = (&world.exact, GeoOrigin { latitude_deg: 49.0, longitude_deg: 8.0 }, DT_S);
        let (poses_in_world, rate_hz) = (&[pose][..], None);
        let place_on_drone = SensorPlace::default();
        let flown =
            SensedFlight { town, ground, bodies, poses_in_world, dt_s, place: place_on_drone, rate_hz, origin, seed };
        flown.read(sensor, &mut |reading| {
            let values = reading.values;
            // Oracle: all satellites, all boxes, no tree.
            let day_s = seed.stream("time of day").uniform(0.0, 86_164.0);
            let sky = directions_in_world(&origin, day_s);
            let is_seen = |ray: &&DVec3| {
                ray.z >= real::sin(10.0_f64.to_radians())
                    && boxes.closest_hit(position_in_world, **ray, 2000.0).is_none()
            };
            assert_eq!(values[1], sky.iter().filter(is_seen).count() as f64);
            if position_in_world.z > 100.0 {
                (least, most) = (least.min(values[1]), most.max(values[1]));
            }
            outages += u32::from(values[0] == 0.0);
            if values[0] == 1.0 {
                let error_m = real::hypot(values[4] - values[12], values[5] - values[13]);
                if values[2] < 2.0 { open_error.push(error_m) } else { narrow_error.push(error_m) }
            }
        });
    }
    assert!(least >= 5.0 && most <= 12.0 && outages > 0, "{least} {most} {outages}");
    let mean = |errors: &[f64]| errors.iter().sum::<f64>() / errors.len() as f64;
    assert!(
        mean(&open_error) < 4.5 && mean(&narrow_error) > 1.5 * mean(&open_error),
        "{open_error:?} {narrow_error:?}"
    );
}

#[test]
fn barometer_and_magnetometer_are_near_the_truth() {
    let poses = smooth_poses(41);
    let open =
        |name: &str| open_readings(&poses, DT_S, called(name).expect("in the list"), SensorPlace::default(), 50.0);
    for (_, _, values) in open("barometer") {
        assert!((values[0] - values[2]).abs() < 0.3 && (values[1] - values[3]).abs() < 3.0, "{values:?}");
        // 1 hPa is 8.3 m near the ground.
        assert!((1013.25 - values[2] - values[3] / 8.32).abs() < 0.02, "{values:?}");
    }
    for (_, _, values) in open("magnetometer") {
        let strength = DVec3::from_slice(&values[3..]).length();
        assert!((strength - 51.3).abs() < 0.1, "{strength}");
        assert!((0..3).all(|axis| (values[axis] - values[3 + axis]).abs() < 4.0), "{values:?}");
    }
}
