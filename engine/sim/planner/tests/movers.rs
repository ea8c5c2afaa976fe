//! Flights among boxes that move, measured by other means than the planner's own.

use core::f64::consts::{PI, TAU};
use cosfly_domain::{OrientedBox, PlanOutcome, Trajectory};
use cosfly_frames::{DVec3, TargetTrack, real};
use cosfly_geometry::{BoxBvh, BruteForce, SpatialQuery};
use cosfly_planner::config::{Foresight, Planner};
use cosfly_planner::{MucoConfig, PlanRequest, plan_request};
use cosfly_random::Seed;
use cosfly_scenes::{Scene, SceneKind, movers_around};
use cosfly_surroundings::moving::{OtherDrones, drone_boxes};
use cosfly_surroundings::visibility::body_points;

fn positions(flight: &Trajectory) -> Vec<DVec3> {
    flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect()
}

fn fly(
    scene: &Scene,
    track: &TargetTrack,
    movers: &[Vec<OrientedBox>],
    config: &MucoConfig,
) -> Result<Trajectory, String> {
    let exact = BoxBvh::build(scene.boxes.clone());
    let mut request = PlanRequest::new(track, &exact, &scene.boxes, &|_, _| 0.0, config);
    request.movers = movers;
    match plan_request(request) {
        PlanOutcome::Planned(flight) => Ok(*flight),
        PlanOutcome::Rejected { reason, .. } => Err(reason),
    }
}

/// A box part of the way between two frames.
fn between(a: &OrientedBox, b: &OrientedBox, share: f64) -> OrientedBox {
    let turn = (b.yaw_rad - a.yaw_rad + PI).rem_euclid(TAU) - PI;
    OrientedBox {
        center_in_world: a.center_in_world.lerp(b.center_in_world, share),
        half_extents_m: a.half_extents_m,
        yaw_rad: a.yaw_rad + share * turn,
    }
}

/// Distance to a box, written out here on purpose.
fn distance_m(point: DVec3, shape: &OrientedBox) -> f64 {
    let (sin, cos) = real::sin_cos(shape.yaw_rad);
    let away = point - shape.center_in_world;
    let local = DVec3::new(cos * away.x + sin * away.y, cos * away.y - sin * away.x, away.z);
    (local.abs() - shape.half_extents_m).max(DVec3::ZERO).length()
}

/// Smallest distance from what moves, sampled 20 times a frame.
fn least_distance_m(waypoints: &[DVec3], movers: &[Vec<OrientedBox>]) -> f64 {
    let mut least = f64::INFINITY;
    for places in movers {
        for (i, pair) in waypoints.windows(2).enumerate() {
            for k in 0..=20 {
                let share = f64::from(k) / 20.0;
                let shape = between(&places[i], &places[i + 1], share);
                least = least.min(distance_m(pair[0].lerp(pair[1], share), &shape));
            }
        }
    }
    least
}

/// Clearance and visibility of a flight among what moves, by sampling and by rays against every box.
fn check_flight(flight: &Trajectory, scene: &Scene, movers: &[Vec<OrientedBox>], label: &str) {
    let waypoints = positions(flight);
    let (least, stated) = (least_distance_m(&waypoints, movers), flight.certificate.min_clearance_m);
    assert!(stated >= flight.certificate.limits.clearance_m, "{label}: {stated}");
    assert!(least.min(50.0) >= stated - 1e-9, "{label}: stated {stated}, sampled {least}");
    let slow = BruteForce::new(&scene.boxes);
    for frame in (0..waypoints.len()).step_by(11) {
        let state = &flight.track.states[frame];
        let middle = state.feet_in_world + DVec3::Z * (0.5 * flight.track.height_m);
        let others: Vec<OrientedBox> = movers.iter().map(|places| places[frame]).collect();
        let others: Vec<OrientedBox> = others.into_iter().filter(|shape| distance_m(middle, shape) > 0.0).collect();
        let moving = BruteForce::new(&others);
        let camera = waypoints[frame];
        let is_seen = |point: &&DVec3| !slow.blocked(**point, camera) && !moving.blocked(**point, camera);
        let seen = body_points(state, flight.track.height_m).iter().filter(is_seen).count();
        assert_eq!(flight.visibility[frame], seen as f64 / 8.0, "{label}: frame {frame}");
    }
}

/// Flies low enough that people and vehicles are in the way.
fn low() -> MucoConfig {
    let mut config = MucoConfig::default();
    (config.view.min_altitude_m, config.view.preferred_altitude_m) = (2.5, 6.0);
    config
}

#[test]
fn flights_among_movers_keep_clear_of_them_and_state_what_they_see() {
    let mut without = 0;
    for (kind, config) in [
        (SceneKind::Light, MucoConfig::default()),
        (SceneKind::Leafy, MucoConfig::default()),
        (SceneKind::Alley, MucoConfig::default()),
        (SceneKind::Canyon, MucoConfig::default()),
        (SceneKind::Light, low()),
    ] {
        let scene = Scene::generate(kind, 31);
        for index in 0..4 {
            let label = format!("{} {} m, {index}", kind.name(), config.view.min_altitude_m);
            let track = scene.walker(31, index);
            let movers = movers_around(&track, 50, Seed::of_item(31, "movers", &label));
            match fly(&scene, &track, &movers, &config) {
                Ok(flight) => check_flight(&flight, &scene, &movers, &label),
                Err(reason) => {
                    eprintln!("{label}: {reason}");
                    without += 1;
                }
            }
        }
    }
    assert!(without <= 2, "{without} of 20 paths without a flight");
}

#[test]
fn a_baseline_keeps_clear_of_movers_and_looks_past_them_too() {
    let scene = Scene::generate(SceneKind::Light, 32);
    let mut track = scene.walker(32, 0);
    track.states.truncate(40);
    let movers = movers_around(&track, 50, Seed::of_item(32, "movers", "a"));
    for planner in [Planner::Astar, Planner::AstarSmoothed, Planner::Beam] {
        let mut config = MucoConfig { planner, ..MucoConfig::default() };
        config.limits.require_kinematics = false;
        let flight = fly(&scene, &track, &movers, &config).unwrap();
        check_flight(&flight, &scene, &movers, planner.name());
    }
}

#[test]
fn the_box_of_the_target_itself_hides_nothing_of_it() {
    let scene = Scene::generate(SceneKind::Light, 33);
    let track = scene.walker(33, 0);
    let own = |state: &cosfly_frames::TargetState| OrientedBox {
        center_in_world: state.feet_in_world + DVec3::Z * 0.9,
        half_extents_m: DVec3::new(0.25, 0.25, 0.9),
        yaw_rad: state.heading_rad,
    };
    let movers = [track.states.iter().map(own).collect::<Vec<_>>()];
    let config = MucoConfig::default();
    let (alone, with) = (fly(&scene, &track, &[], &config).unwrap(), fly(&scene, &track, &movers, &config).unwrap());
    assert_eq!((positions(&alone), alone.visibility), (positions(&with), with.visibility));
}

#[test]
fn a_causal_flight_is_certified_against_what_happens_and_knows_nothing_of_it_before() {
    let config = MucoConfig { foresight: Foresight::Causal, ..MucoConfig::default() };
    let scene = Scene::generate(SceneKind::Light, 34);
    let (mut flown, mut same) = (0, 0);
    for index in 0..3 {
        let mut track = scene.walker(34, index);
        track.states.truncate(80);
        let movers = movers_around(&track, 50, Seed::of_item(34, "movers", &index.to_string()));
        let Ok(flight) = fly(&scene, &track, &movers, &config) else { continue };
        check_flight(&flight, &scene, &movers, &format!("causal {index}"));
        assert!(flight.certificate.holds && flight.certificate.lattice_visibility > 0.8);
        flown += 1;
        // From some frame on everything stands still.
        const LAST: usize = 50;
        let mut other = track.clone();
        (LAST + 1..80).for_each(|i| other.states[i].feet_in_world = track.states[LAST].feet_in_world);
        let mut still = movers.clone();
        still.iter_mut().for_each(|places| (LAST + 1..80).for_each(|i| places[i] = places[LAST]));
        if let Ok(otherwise) = fly(&scene, &other, &still, &config) {
            assert_eq!(positions(&flight)[..=LAST + 1], positions(&otherwise)[..=LAST + 1]);
            assert_ne!(positions(&flight), positions(&otherwise));
            same += 1;
        }
    }
    assert!(flown >= 2 && same >= 1, "{flown} flown, {same} compared");
}

#[test]
fn a_causal_expert_loses_its_target_when_that_is_ordered() {
    let mut config = MucoConfig { foresight: Foresight::Causal, ..MucoConfig::default() };
    (config.occlusion.count, config.occlusion.min_s, config.occlusion.max_s) = (1, 1.0, 2.0);
    (config.causal.horizon_s, config.causal.replan_s) = (8.0, 1.0);
    let scene = Scene::generate(SceneKind::Alley, 36);
    let (mut flown, mut lost) = (0, 0);
    for index in 0..4 {
        let mut track = scene.walker(36, index);
        track.states.truncate(70);
        let Ok(flight) = fly(&scene, &track, &[], &config) else { continue };
        check_flight(&flight, &scene, &[], &format!("causal loss {index}"));
        let certificate = &flight.certificate;
        assert_eq!(certificate.occlusion_ordered_s, 1.5);
        let unseen_s = flight.visibility.iter().filter(|seen| **seen == 0.0).count() as f64 * track.dt_s;
        assert!(certificate.occlusion_reached_s <= unseen_s, "{certificate:?}");
        flown += 1;
        lost += usize::from(certificate.occlusion_reached_s >= 1.0);
    }
    assert!(flown >= 2 && lost >= 1, "{flown} flown, {lost} lost their targets");
}

#[test]
fn drones_behind_one_target_keep_apart() {
    const SEPARATION_M: f64 = 6.0;
    let config = MucoConfig::default();
    for (kind, index) in [(SceneKind::Light, 0), (SceneKind::Light, 1), (SceneKind::Leafy, 0), (SceneKind::Alley, 0)] {
        let scene = Scene::generate(kind, 35);
        let exact = BoxBvh::build(scene.boxes.clone());
        let mut track = scene.walker(35, index);
        track.states.truncate(120);
        let mut flown: Vec<Vec<DVec3>> = vec![];
        for _ in 0..3 {
            let movers: Vec<Vec<OrientedBox>> = flown.iter().map(|places| drone_boxes(places)).collect();
            let mut request = PlanRequest::new(&track, &exact, &scene.boxes, &|_, _| 0.0, &config);
            request.movers = &movers;
            request.drones = OtherDrones { count: movers.len(), separation_m: SEPARATION_M };
            let PlanOutcome::Planned(flight) = plan_request(request) else { panic!("{} {index}", kind.name()) };
            assert!(flight.certificate.holds && flight.certificate.mean_visibility > 0.7);
            flown.push(positions(&flight));
        }
        for (one, places) in flown.iter().enumerate() {
            for other in &flown[..one] {
                for (a, b) in places.windows(2).zip(other.windows(2)) {
                    let apart =
                        (0..=20).map(|k| f64::from(k) / 20.0).map(|t| a[0].lerp(a[1], t).distance(b[0].lerp(b[1], t)));
                    assert!(apart.fold(f64::INFINITY, f64::min) >= SEPARATION_M - 1e-9);
                }
            }
        }
    }
}
