//! Every planned flight is measured again, by other means than the planner's own.

use core::f64::consts::PI;
use cosfly_domain::{OrientedBox, PlanOutcome, Trajectory};
use cosfly_frames::{DVec3, Pose};
use cosfly_geometry::{BoxBvh, BruteForce, SpatialQuery};
use cosfly_planner::{MucoConfig, Preset, plan};
use cosfly_random::Seed;
use cosfly_scenes::{Scene, SceneKind};
use cosfly_surroundings::visibility::{aim_point, body_points};

fn planned(scene: &Scene, seed: u64, index: u64, config: &MucoConfig) -> Result<Box<Trajectory>, String> {
    let exact = BoxBvh::build(scene.boxes.clone());
    let track = scene.walker(seed, index);
    match plan(&track, &exact, &scene.boxes, &|_, _| 0.0, config, Seed::of_item(seed, "muco", "x")) {
        PlanOutcome::Planned(flight) => Ok(flight),
        PlanOutcome::Rejected { reason, .. } => Err(reason),
    }
}

/// Distance to an axis-aligned box, written out here on purpose.
fn distance_m(point: DVec3, shape: &OrientedBox) -> f64 {
    assert_eq!(shape.yaw_rad, 0.0);
    ((point - shape.center_in_world).abs() - shape.half_extents_m).max(DVec3::ZERO).length()
}

fn check_flight(flight: &Trajectory, boxes: &[OrientedBox], config: &MucoConfig, label: &str) {
    let positions: Vec<DVec3> = flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect();
    let n = flight.track.len();
    assert_eq!((positions.len(), flight.visibility.len(), flight.clearance_m.len()), (n, n, n), "{label}");
    let certificate = &flight.certificate;
    assert!(certificate.holds && certificate.violations.is_empty(), "{label}: {:?}", certificate.violations);
    check_clearance(flight, &positions, boxes, config, label);
    check_kinematics(flight, &positions, config, label);
    check_views(flight, &positions, boxes, label);
    assert_eq!(flight.terms.len(), 9, "{label}");
    for term in &flight.terms {
        assert!(
            term.per_frame.len() == n && term.per_frame.iter().all(|cost| cost.is_finite()),
            "{label} {}",
            term.name
        );
    }
    let lowest = positions.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    // The paper's pipeline knows a lowest altitude only as a cost.
    let slack_m = if config.preset == Preset::Paper { 3.0 } else { 0.1 };
    assert!(lowest > config.view.min_altitude_m - slack_m, "{label}: lowest {lowest}");
}

fn check_clearance(flight: &Trajectory, positions: &[DVec3], boxes: &[OrientedBox], config: &MucoConfig, label: &str) {
    let low = positions.iter().copied().reduce(DVec3::min).unwrap_or_default() - 6.0;
    let high = positions.iter().copied().reduce(DVec3::max).unwrap_or_default() + 6.0;
    let near: Vec<OrientedBox> = boxes
        .iter()
        .filter(|shape| {
            let (min, max) = shape.bounds_in_world();
            min.cmple(high).all() && max.cmpge(low).all()
        })
        .copied()
        .collect();
    let mut smallest = f64::INFINITY;
    for pair in positions.windows(2) {
        let steps = (pair[1].distance(pair[0]) / 0.1).ceil().max(1.0) as usize;
        for k in 0..=steps {
            let point = pair[0].lerp(pair[1], k as f64 / steps as f64);
            smallest = near.iter().map(|shape| distance_m(point, shape)).fold(smallest, f64::min);
        }
    }
    assert!(smallest >= config.limits.clearance_m - 1e-9, "{label}: sampled clearance {smallest}");
    let stated = flight.certificate.min_clearance_m;
    assert!(stated <= smallest.min(50.0) + 1e-9, "{label}: stated {stated}, sampled {smallest}");
    if smallest < 6.0 {
        assert!(smallest - stated < 0.05, "{label}: stated {stated}, sampled {smallest}");
    }
}

fn check_kinematics(flight: &Trajectory, p: &[DVec3], config: &MucoConfig, label: &str) {
    let dt = flight.track.dt_s;
    let velocity: Vec<DVec3> = (1..p.len()).map(|i| (p[i] - p[i - 1]) / dt).collect();
    let acceleration: Vec<DVec3> = (1..velocity.len()).map(|i| (velocity[i] - velocity[i - 1]) / dt).collect();
    let jerk: Vec<DVec3> = (1..acceleration.len()).map(|i| (acceleration[i] - acceleration[i - 1]) / dt).collect();
    let certificate = &flight.certificate;
    for (values, stated, limit) in [
        (&velocity, certificate.max_speed_mps, config.limits.speed_mps),
        (&acceleration, certificate.max_acceleration_mps2, config.limits.acceleration_mps2),
        (&jerk, certificate.max_jerk_mps3, config.limits.jerk_mps3),
    ] {
        let largest = values.iter().map(|v| v.length()).fold(0.0, f64::max);
        assert!((largest - stated).abs() < 1e-6 && largest <= limit + 1e-6, "{label}: {largest} {stated} {limit}");
    }
    let angles = |angle: fn(&Pose) -> f64| flight.poses_in_world.iter().map(angle).collect::<Vec<f64>>();
    for (angles, stated, limit) in [
        (angles(|pose| pose.yaw_rad), certificate.max_yaw_rate_deg_s, config.stated_limits().yaw_rate_deg_s),
        (angles(|pose| pose.pitch_rad), certificate.max_pitch_rate_deg_s, config.stated_limits().pitch_rate_deg_s),
    ] {
        let turn = |pair: &[f64]| (pair[1] - pair[0] + PI).rem_euclid(2.0 * PI) - PI;
        let largest = angles.windows(2).map(|pair| turn(pair).abs().to_degrees() / dt).fold(0.0, f64::max);
        assert!((largest - stated).abs() < 1e-6 && largest <= limit + 1e-6, "{label}: {largest} {stated} {limit}");
    }
}

fn check_views(flight: &Trajectory, positions: &[DVec3], boxes: &[OrientedBox], label: &str) {
    let slow = BruteForce::new(boxes);
    for (i, (pose, state)) in flight.poses_in_world.iter().zip(&flight.track.states).enumerate() {
        let aim = pose.body_from_world_point(aim_point(state, flight.track.height_m));
        assert!(aim.y.abs() < 1e-9 && aim.z.abs() < 1e-9 && pose.roll_rad == 0.0, "{label}: frame {i} looks away");
        if i % 7 == 0 {
            let seen = body_points(state, flight.track.height_m)
                .iter()
                .filter(|&&point| !slow.blocked(point, positions[i]))
                .count();
            assert_eq!(flight.visibility[i], seen as f64 / 8.0, "{label}: frame {i}");
        }
    }
}

#[test]
fn flights_in_seeded_scenes_keep_every_promise_of_their_certificate() {
    let config = MucoConfig::default();
    let mut count = 0;
    for (kind, least) in
        [(SceneKind::Light, 0.9), (SceneKind::Leafy, 0.8), (SceneKind::Alley, 0.9), (SceneKind::Canyon, 0.9)]
    {
        for seed in 0..3 {
            let scene = Scene::generate(kind, 100 + seed);
            for index in 0..2 {
                let label = format!("{} {seed} {index}", kind.name());
                let flight = planned(&scene, seed, index, &config).unwrap_or_else(|reason| panic!("{label}: {reason}"));
                check_flight(&flight, &scene.boxes, &config, &label);
                assert!(flight.certificate.mean_visibility > least, "{label} {}", flight.certificate.mean_visibility);
                count += 1;
            }
        }
    }
    assert_eq!(count, 24);
}

#[test]
fn the_papers_weights_fly_safely_too() {
    let config = MucoConfig { preset: Preset::Paper, ..MucoConfig::default() };
    let scene = Scene::generate(SceneKind::Light, 5);
    let flight = planned(&scene, 5, 0, &config).expect("planned");
    check_flight(&flight, &scene.boxes, &config, "paper");
    assert_eq!(flight.terms[4].weight, 3.0);
    let rear = MucoConfig {
        view: cosfly_planner::config::ViewConfig { rear_sector_deg: 60.0, ..config.view.clone() },
        ..config.clone()
    };
    let behind = planned(&scene, 5, 0, &rear).expect("planned");
    check_flight(&behind, &scene.boxes, &rear, "rear sector");
    assert!(behind.certificate.mean_rear_angle_deg < 60.0, "{}", behind.certificate.mean_rear_angle_deg);
}

#[test]
fn keyframes_may_be_seconds_apart() {
    let mut config = MucoConfig::default();
    config.search.keyframe_frames = 5;
    let scene = Scene::generate(SceneKind::Light, 6);
    check_flight(&planned(&scene, 6, 1, &config).expect("planned"), &scene.boxes, &config, "keyframes");
}

#[test]
fn the_same_inputs_give_the_same_flight() {
    let scene = Scene::generate(SceneKind::Leafy, 9);
    let config = MucoConfig::default();
    assert_eq!(planned(&scene, 9, 0, &config), planned(&scene, 9, 0, &config));
}

#[test]
fn a_map_cut_into_small_boxes_is_planned_coarse_and_certified_fine() {
    let fine = Scene::generate(SceneKind::Fine, 3);
    let coarse = Scene::generate(SceneKind::Leafy, 3);
    let track = coarse.walker(3, 0);
    let exact = BoxBvh::build(fine.boxes.clone());
    let config = MucoConfig::default();
    let outcome = plan(&track, &exact, &coarse.boxes, &|_, _| 0.0, &config, Seed::of_item(3, "muco", "x"));
    let PlanOutcome::Planned(flight) = outcome else { panic!("rejected") };
    check_flight(&flight, &fine.boxes, &config, "fine");
}

#[test]
fn planning_boxes_that_miss_an_obstacle_never_lead_into_it() {
    let scene = Scene::generate(SceneKind::Alley, 12);
    let track = scene.walker(12, 0);
    let config = MucoConfig::default();
    let seed = Seed::of_item(12, "muco", "x");
    let alone = BoxBvh::build(scene.boxes.clone());
    let PlanOutcome::Planned(free) = plan(&track, &alone, &scene.boxes, &|_, _| 0.0, &config, seed) else {
        panic!("rejected")
    };
    let mut boxes = scene.boxes.clone();
    boxes.extend([40, 100, 160].map(|frame| OrientedBox {
        center_in_world: free.poses_in_world[frame].position_in_world + DVec3::new(0.2, 0.3, -0.1),
        half_extents_m: DVec3::splat(0.3),
        yaw_rad: 0.0,
    }));
    let exact = BoxBvh::build(boxes.clone());
    match plan(&track, &exact, &scene.boxes, &|_, _| 0.0, &config, seed) {
        PlanOutcome::Planned(flight) => check_flight(&flight, &boxes, &config, "surprise"),
        PlanOutcome::Rejected { reason, .. } => assert!(reason.contains("clearance"), "{reason}"),
    }
}

/// The walker's track at another time step.
fn resampled(track: &cosfly_frames::TargetTrack, dt_s: f64) -> cosfly_frames::TargetTrack {
    let frames = (track.duration_s() / dt_s) as usize + 1;
    let state = |frame: usize| {
        let at = (frame as f64 * dt_s / track.dt_s).min((track.len() - 1) as f64);
        let (i, share) = (at as usize, at.fract());
        let next = track.states[(i + 1).min(track.len() - 1)].feet_in_world;
        let feet_in_world = track.states[i].feet_in_world.lerp(next, share);
        cosfly_frames::TargetState { feet_in_world, ..track.states[i] }
    };
    cosfly_frames::TargetTrack { dt_s, states: (0..frames).map(state).collect(), ..*track }
}

#[test]
fn other_time_steps_are_flown_within_the_same_limits() {
    let scene = Scene::generate(SceneKind::Light, 8);
    let exact = BoxBvh::build(scene.boxes.clone());
    let config = MucoConfig::default();
    for dt_s in [1.0, 0.25, 0.1] {
        for index in 0..2 {
            let track = resampled(&scene.walker(8, index), dt_s);
            let seed = Seed::of_item(8, "muco", "x");
            match plan(&track, &exact, &scene.boxes, &|_, _| 0.0, &config, seed) {
                PlanOutcome::Planned(flight) => {
                    eprintln!(
                        "{dt_s} {index} {:.3} {}",
                        flight.certificate.mean_visibility, flight.certificate.iterations
                    );
                    check_flight(&flight, &scene.boxes, &config, &format!("{dt_s} s"));
                }
                PlanOutcome::Rejected { reason, .. } => panic!("{dt_s} s: {reason}"),
            }
        }
    }
}
