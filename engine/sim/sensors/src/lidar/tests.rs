//! Laws of lidars, and points against rays that are cast without a tree.

use super::{
    LIDARS, LidarPattern, LidarPoint, LidarScene, LidarSweep, LidarTriangle, PatternConfig, ScanConfig, ScannedFlight,
    lidar,
};
use crate::{SensorPlace, SmoothFlight};
use cosfly_domain::{OrientedBox, SemanticLabel, Town, Weather, object_instance};
use cosfly_figures::{BodyFigure, BodyShape, FigureInPicture, figure_triangles};
use cosfly_frames::{DVec3, Pose, Seed, TargetState, real};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_maps::{MapConfig, read_town};
use std::path::Path;

const DT_S: f64 = 0.1;

fn town() -> Town {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../recipes/towns/downtown.xodr");
    let map = std::fs::read(path).expect("a shipped town");
    read_town(&map, &MapConfig::default(), Seed([5; 32])).expect("a map").0
}

fn ground(town: &Town) -> Vec<LidarTriangle> {
    let triangles = town.surfaces.iter().flat_map(|it| {
        it.triangles.iter().map(|corners| LidarTriangle {
            corners_in_world: corners.map(|corner| it.vertices_in_world[corner as usize]),
            label: it.label.id(),
            instance: 0,
        })
    });
    triangles.collect()
}

/// Two triangles for each face of each box.
fn boxes(town: &Town) -> Vec<LidarTriangle> {
    let mut triangles = vec![];
    for obstacle in &town.obstacles {
        let corners = obstacle.shape.corners_in_world();
        for axis in [1, 2, 4] {
            for side in [0, axis] {
                let (first, second) = if axis == 1 { (2, 4) } else { (1, 6 & !axis) };
                let face = [side, side + first, side + second, side + first + second].map(|it| corners[it]);
                for [a, b, c] in [[0, 1, 2], [1, 2, 3]] {
                    let (label, instance) = (obstacle.kind.label().id(), object_instance(obstacle.object_id));
                    triangles.push(LidarTriangle { corners_in_world: [face[a], face[b], face[c]], label, instance });
                }
            }
        }
    }
    triangles
}

/// A drone 6 m above a street, in the open, that flies and turns.
fn poses(town: &Town, frames: i32) -> Vec<Pose> {
    let exact = BoxBvh::build(town.obstacles.iter().map(|obstacle| obstacle.shape).collect());
    let roads = town.surfaces.iter().filter(|surface| surface.label == SemanticLabel::Roads);
    let mut places = roads.flat_map(|surface| &surface.vertices_in_world).map(|place| *place + 6.0 * DVec3::Z);
    let start = places.find(|place| exact.nearest(*place, 8.0).is_none()).expect("an open place");
    let at = |frame: i32| {
        let time_s = f64::from(frame) * DT_S;
        let position_in_world = start + DVec3::new(5.0 * time_s, real::sin(time_s), 0.0);
        Pose { position_in_world, pitch_rad: -0.2, yaw_rad: 0.8 * time_s, roll_rad: 0.0 }
    };
    (0..frames).map(at).collect()
}

fn weather() -> Weather {
    let mut weather = Weather {
        name: String::new(),
        cloudiness: 0.0,
        precipitation: 0.0,
        precipitation_deposits: 0.0,
        wind_intensity: 0.0,
        sun_azimuth_angle: 0.0,
        sun_altitude_angle: 0.0,
        fog_density: 0.0,
        fog_distance: 0.0,
        fog_falloff: 0.0,
        wetness: 0.0,
        scattering_intensity: 0.0,
        mie_scattering_scale: 0.0,
        rayleigh_scattering_scale: 0.0,
        dust_storm: 0.0,
    };
    weather.numbers_mut().into_iter().for_each(|number| *number = 0.0);
    weather
}

/// A person who runs at 5 m/s beside the drone's way; number 70,000 in pictures.
fn runner(poses: &[Pose], time_s: f64) -> FigureInPicture {
    let feet_in_world = poses[0].position_in_world + DVec3::new(24.0 - 5.0 * time_s, 3.0, -6.0);
    let figure = BodyFigure {
        state: TargetState { feet_in_world, heading_rad: real::PI, speed_mps: 5.0 },
        height_m: 1.8,
        radius_m: 0.3,
        clothes_seed: Seed([3; 32]),
        gait_phase_rad: 0.7,
        body: BodyShape::default(),
    };
    FigureInPicture { figure, instance: 70_000 }
}

fn sweeps(town: &Town, poses_in_world: &[Pose], pattern: &LidarPattern, weather: &Weather) -> Vec<LidarSweep> {
    let scene = &LidarScene::new(&[boxes(town), ground(town)].concat());
    let bodies = &|time_s: f64, list: &mut Vec<FigureInPicture>| list.push(runner(poses_in_world, time_s));
    let (place, rate_hz, seed) = (SensorPlace::default(), 10.0, Seed([2; 32]));
    let flight = ScannedFlight { scene, bodies, poses_in_world, dt_s: DT_S, place, rate_hz, weather, seed };
    let mut all = vec![];
    flight.scan(pattern, &mut |sweep| all.push(sweep));
    assert_eq!(all.len(), flight.sweeps());
    all
}

fn pattern(name: &str) -> LidarPattern {
    lidar(name).expect("a device").pattern()
}

#[test]
fn devices_have_the_figures_of_their_data_sheets() {
    assert!(LIDARS.is_sorted_by_key(|lidar| lidar.name));
    let elevations_deg = |name: &str| {
        let mut all = vec![];
        pattern(name).shoot(0.0, 0.0, &mut |_, ray| all.push(real::asin(ray.z).to_degrees()));
        all
    };
    for (name, count, lowest, highest) in [
        ("vlp16", 16, -15.0, 15.0),
        ("hdl32e", 32, -30.667, 10.667),
        ("hdl64e", 64, -24.333, 2.0),
        ("os1_64", 64, -22.5, 22.5),
    ] {
        let all = elevations_deg(name);
        assert!((all[0] - lowest).abs() < 1e-3 && (all[count - 1] - highest).abs() < 1e-3, "{name}: {all:?}");
        assert!(all.len() == count && all.is_sorted(), "{name}: {all:?}");
    }
    // The rosette fills its circle and does not leave it; the other one its belt.
    let directions = |name: &str| {
        let mut all = vec![];
        (0..10_000).for_each(|shot| pattern(name).shoot(0.0, f64::from(shot) * 1e-5, &mut |_, ray| all.push(ray)));
        all
    };
    let farthest = directions("mid40").iter().map(|ray| real::acos(ray.x).to_degrees()).fold(0.0, f64::max);
    assert!((19.0..19.3).contains(&farthest), "{farthest}");
    let up: Vec<f64> = directions("mid360").iter().map(|ray| real::asin(ray.z).to_degrees()).collect();
    let (low, high) = (up.iter().copied().fold(90.0, f64::min), up.iter().copied().fold(-90.0, f64::max));
    assert!((-7.01..-6.9).contains(&low) && (51.9..52.01).contains(&high), "{low} {high}");
    for device in LIDARS {
        for rate_hz in device.rates_hz {
            assert!(device.pattern().shots(rate_hz).is_some(), "{} {rate_hz}", device.name);
        }
    }
}

/// Distance along a unit vector to a triangle, by the signed volumes of its corners.
fn to_triangle(from: DVec3, ray: DVec3, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let [a, b, c] = [a, b, c].map(|corner| corner - from);
    let volumes = [ray.dot(b.cross(c)), ray.dot(c.cross(a)), ray.dot(a.cross(b))];
    let is_met = volumes.iter().all(|it| *it >= 0.0) || volumes.iter().all(|it| *it <= 0.0);
    let sum: f64 = volumes.iter().sum();
    let distance = (a * volumes[0] + b * volumes[1] + c * volumes[2]).dot(ray) / sum;
    (is_met && sum != 0.0 && distance > 0.0).then_some(distance)
}

/// Distance along a unit vector to a box, by the slabs of its own axes.
fn to_box(from: DVec3, ray: DVec3, shape: &OrientedBox) -> Option<f64> {
    let (sin, cos) = real::sin_cos(shape.yaw_rad);
    let axes = [DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z];
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for (axis, half_m) in axes.into_iter().zip(shape.half_extents_m.to_array()) {
        let (start, step) = (axis.dot(from - shape.center_in_world), axis.dot(ray));
        let ends = [(-half_m - start) / step, (half_m - start) / step];
        enter = enter.max(ends[0].min(ends[1]));
        leave = leave.min(ends[0].max(ends[1]));
    }
    (enter <= leave).then_some(enter)
}

#[test]
fn points_lie_where_rays_meet_the_first_thing_by_brute_force() {
    let town = town();
    let (poses, triangles) = (poses(&town, 3), ground(&town));
    let pattern = pattern("vlp16");
    let all = sweeps(&town, &poses, &pattern, &weather());
    assert_eq!((all.len(), all[1].frame, all[1].time_s), (2, 1, 0.1));
    assert_eq!(all, sweeps(&town, &poses, &pattern, &weather()));
    let smooth = SmoothFlight::new(&poses, DT_S);
    let (mut on_runner, mut on_houses, mut on_ground, mut others) = (0, 0, 0, 0);
    for sweep in &all {
        let drawn = sweep.points.iter().enumerate();
        for (_, point) in drawn.filter(|(number, point)| number % 197 == 0 || point.instance == 70_000) {
            let time_s = sweep.time_s + f64::from(point.time_s);
            let sensor = smooth.at(time_s / DT_S);
            let in_sensor = DVec3::from_array(point.place_m.map(f64::from));
            let (from, ray) = (sensor.position_in_world, sensor.world_from_body * in_sensor.normalize());
            let nearest = |all: &mut dyn Iterator<Item = f64>| all.fold(f64::INFINITY, f64::min);
            let house = nearest(&mut town.obstacles.iter().filter_map(|it| to_box(from, ray, &it.shape)));
            let floor = nearest(&mut triangles.iter().filter_map(|it| to_triangle(from, ray, it.corners_in_world)));
            let figure = figure_triangles(&runner(&poses, time_s).figure);
            let runner = nearest(&mut figure.into_iter().filter_map(|corners| to_triangle(from, ray, corners)));
            let first = house.min(floor).min(runner);
            // Noise has 3.47 deviations at most. The rounded direction may miss an edge.
            if (in_sensor.length() - first).abs() > 3.5 * 0.03 {
                others += 1;
            } else if first == runner {
                assert_eq!((point.instance, point.label), (70_000, SemanticLabel::Pedestrian.id()));
                on_runner += 1;
            } else if first == floor {
                assert_eq!(point.instance, 0);
                on_ground += 1;
            } else {
                let owner = |it: &&cosfly_domain::Obstacle| object_instance(it.object_id) == point.instance;
                let own = town.obstacles.iter().find(owner).expect("an obstacle");
                assert_eq!(own.kind.label().id(), point.label);
                on_houses += 1;
            }
        }
    }
    assert!(on_runner > 10 && on_houses > 10 && on_ground > 10, "{on_runner} {on_houses} {on_ground}");
    assert!(20 * others < on_runner + on_houses + on_ground, "{others} of {}", on_runner + on_houses + on_ground);
}

#[test]
fn rain_and_fog_take_far_points_away_and_slanting_light_is_weak() {
    let town = town();
    let poses = poses(&town, 2);
    let points = |weather: &Weather| sweeps(&town, &poses, &pattern("hdl32e"), weather).remove(0).points;
    let far = |all: &[LidarPoint]| all.iter().filter(|it| it.place_m[0].abs().max(it.place_m[1].abs()) > 30.0).count();
    let dry = points(&weather());
    let wet = points(&Weather { precipitation: 100.0, ..weather() });
    let thick = points(&Weather { fog_density: 100.0, ..weather() });
    assert!(wet.len() < dry.len() && far(&wet) < far(&dry), "{} {}", wet.len(), dry.len());
    assert!(thick.len() < wet.len() && far(&thick) < far(&wet), "{} {}", thick.len(), wet.len());
    assert!(dry.iter().all(|it| it.intensity > 0.0 && it.intensity <= 0.8));
}

#[test]
fn refusals_name_the_key() {
    let own = PatternConfig {
        elevations_deg: vec![-10.0, 0.0],
        azimuths_deg: [-35.0, 35.0],
        shots_hz: 1000,
        range_m: [0.5, 80.0],
        deviation_m: 0.01,
    };
    let config = |lidar: Option<&str>, pattern: Option<PatternConfig>, rate_hz: Option<f64>| ScanConfig {
        lidar: lidar.map(str::to_owned),
        pattern,
        table: None,
        camera: None,
        rate_hz,
        position_in_body_m: [0.0; 3],
        pitch_deg: 0.0,
        yaw_deg: 0.0,
    };
    let key = |config: &ScanConfig| config.read_pattern().expect_err("a refusal").key;
    assert_eq!(key(&config(Some("vlp61"), None, None)), "lidar");
    assert_eq!(key(&config(None, None, None)), "lidar");
    assert_eq!(key(&config(Some("vlp16"), Some(own.clone()), None)), "pattern");
    assert_eq!(key(&config(Some("vlp16"), None, Some(7.0))), "rate_hz");
    assert_eq!(key(&config(Some("vlp16"), None, Some(40.0))), "rate_hz");
    assert_eq!(key(&config(None, Some(own.clone()), Some(3.0))), "rate_hz");
    for range_m in [[0.0, 80.0], [-1.0, 80.0], [80.0, 80.0], [1.0, f64::NAN]] {
        let own = PatternConfig { range_m, ..own.clone() };
        assert_eq!(key(&config(None, Some(own), None)), "pattern.range_m");
    }
    let backwards = PatternConfig { azimuths_deg: [10.0, 10.0], ..own.clone() };
    assert_eq!(key(&config(None, Some(backwards), None)), "pattern.azimuths_deg");
    let none = PatternConfig { elevations_deg: vec![], ..own.clone() };
    assert_eq!(key(&config(None, Some(none), None)), "pattern.elevations_deg");
    let solid = config(None, Some(own), None);
    let pattern = solid.read_pattern().expect("a pattern");
    assert_eq!((solid.table(), pattern.beams(), pattern.shots(solid.rate_hz())), ("lidar", 2, Some(100)));
    let mut first = vec![];
    pattern.shoot(0.0, 0.0, &mut |_, ray| first.push(ray));
    assert!((real::atan2(first[1].y, first[1].x).to_degrees() + 35.0).abs() < 1e-9);
}
