//! Twins: their shares of events, their bounds, their clearance, and what they depend on.

use super::config::PerturbConfig;
use super::kinds::{Departure, KINDS};
use super::mixture::Mixture;
use super::sizes::FlyableConfig;
use super::twin::{measured, perturb};
use cosfly_domain::{
    Certificate, FramePerturbation, OrientedBox, Perturbation, PerturbationKind, PlanOutcome, Trajectory,
};
use cosfly_frames::{DVec3, Pose, TargetState, TargetTrack, real};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_planner::config::muco::MucoConfig;
use cosfly_random::Seed;
use cosfly_surroundings::exact::ExactMap;
use cosfly_surroundings::moving::{OtherDrones, drone_boxes};
use cosfly_surroundings::visibility::aim_point;

/// An expert 20 m behind and 20 m above a target that walks along x at 1 m/s.
fn expert(count: usize) -> Trajectory {
    let states: Vec<TargetState> = (0..count)
        .map(|i| TargetState { feet_in_world: DVec3::new(0.5 * i as f64, 0.0, 0.0), heading_rad: 0.0, speed_mps: 1.0 })
        .collect();
    let track = TargetTrack { dt_s: 0.5, height_m: 1.7, radius_m: 0.25, states };
    let poses_in_world: Vec<Pose> = track
        .states
        .iter()
        .map(|s| Pose::looking_at(s.feet_in_world + DVec3::new(-20.0, 0.0, 20.0), aim_point(s, 1.7)))
        .collect();
    let no_twin = Perturbation {
        expert_item: String::new(),
        kind: PerturbationKind::JUMPS,
        position_probability: 0.0,
        rotation_probability: 0.0,
        frames: vec![],
    };
    let mut blank = Trajectory {
        track,
        poses_in_world: vec![],
        visibility: vec![],
        clearance_m: vec![],
        terms: vec![],
        coverage: vec![],
        labels: vec![],
        convergence: vec![],
        certificate: Certificate {
            limits: MucoConfig::default().stated_limits(),
            holds: true,
            violations: vec![],
            mean_visibility: 0.0,
            frames_half_visible: 0.0,
            min_clearance_m: 0.0,
            max_speed_mps: 0.0,
            max_acceleration_mps2: 0.0,
            max_jerk_mps3: 0.0,
            mean_distance_m: 0.0,
            mean_rear_angle_deg: 0.0,
            length_m: 0.0,
            length_ratio: 0.0,
            iterations: 7,
            filtered_boxes: 3,
            ..Certificate::default()
        },
        perturbation: None,
    };
    blank =
        measured(&blank, poses_in_world, no_twin, ExactMap::still(&BoxBvh::build(vec![])), &PerturbConfig::default());
    blank.perturbation = None;
    blank
}

fn seed() -> Seed {
    Seed::of_item(9, "perturbed", "p3")
}

fn twin_of(expert: &Trajectory, exact: &BoxBvh, config: &PerturbConfig, seed: Seed) -> Trajectory {
    match perturb(expert, "p3", ExactMap::still(exact), config, seed) {
        PlanOutcome::Planned(twin) => *twin,
        PlanOutcome::Rejected { reason, .. } => panic!("{reason}"),
    }
}

fn frames(twin: &Trajectory) -> &[FramePerturbation] {
    &twin.perturbation.as_ref().unwrap().frames
}

/// A tunnel around the flight, 3.8 m wide and 3.2 m high: no room for 2 m but along it.
fn tunnel() -> BoxBvh {
    let slab = |y: f64, z: f64, half_y: f64, half_z: f64| OrientedBox {
        center_in_world: DVec3::new(200.0, y, z),
        half_extents_m: DVec3::new(400.0, half_y, half_z),
        yaw_rad: 0.0,
    };
    BoxBvh::build(vec![
        slab(2.9, 20.0, 1.0, 10.0),
        slab(-2.9, 20.0, 1.0, 10.0),
        slab(0.0, 22.1, 3.0, 0.5),
        slab(0.0, 17.9, 3.0, 0.5),
    ])
}

#[test]
fn the_four_states_have_the_papers_shares() {
    let twin = twin_of(&expert(8000), &BoxBvh::build(vec![]), &PerturbConfig::default(), seed());
    for (position, rotation, share) in
        [(false, false, 0.16), (true, false, 0.24), (false, true, 0.24), (true, true, 0.36)]
    {
        let found = frames(&twin).iter().filter(|f| (f.position, f.rotation) == (position, rotation)).count();
        let sigma = (8000.0_f64 * share * (1.0 - share)).sqrt();
        assert!((found as f64 - 8000.0 * share).abs() < 3.0 * sigma, "{position} {rotation}: {found}");
    }
}

#[test]
fn offsets_keep_their_bounds_and_frames_their_expert() {
    let (expert, config) = (expert(500), PerturbConfig::default());
    let twin = twin_of(&expert, &BoxBvh::build(vec![]), &config, seed());
    assert_eq!(twin.poses_in_world.len(), 500);
    for (i, frame) in frames(&twin).iter().enumerate() {
        let (pose, original) = (twin.poses_in_world[i], expert.poses_in_world[i]);
        assert_eq!(frame.expert_frame as usize, i);
        let moved = pose.position_in_world - original.position_in_world;
        assert!((moved - frame.drone_offset_in_world).length() < 1e-9);
        let (drone_m, aim_m) = (frame.drone_offset_in_world.length(), frame.aim_offset_in_world.length());
        if frame.position {
            assert!((2.0..=3.0 + 1e-9).contains(&drone_m) && (2.0 - 1e-9..=3.0 + 1e-9).contains(&aim_m));
            // Before the turn the camera looked at the displaced middle of the body.
            let aim = aim_point(&expert.track.states[i], 1.7) + frame.aim_offset_in_world;
            let mut unturned = pose;
            unturned.pitch_rad -= frame.pitch_offset_rad;
            unturned.yaw_rad -= frame.yaw_offset_rad;
            let seen = unturned.body_from_world_point(aim);
            assert!(seen.y.abs() < 1e-6 && seen.z.abs() < 1e-6, "{seen}");
        } else {
            assert_eq!((drone_m, aim_m), (0.0, 0.0));
        }
        let turned = real::hypot(frame.pitch_offset_rad, frame.yaw_offset_rad).to_degrees();
        assert!(turned <= 5.0 + 1e-9 && (frame.rotation || turned == 0.0));
        if !frame.position && !frame.rotation {
            assert_eq!(pose, original);
        }
    }
    assert!(twin.certificate.holds && twin.certificate.mean_visibility == 1.0);
    assert_eq!(twin.perturbation.as_ref().unwrap().expert_item, "p3");
}

#[test]
fn views_never_turn_past_the_vertical_and_record_what_was_turned() {
    let expert = expert(400);
    let config = PerturbConfig { position_probability: 0.0, max_rotation_deg: 90.0, ..PerturbConfig::default() };
    let twin = twin_of(&expert, &BoxBvh::build(vec![]), &config, seed());
    let steepest = 89.9 + 1e-9;
    let mut stopped = 0;
    for (i, frame) in frames(&twin).iter().enumerate() {
        let (pose, original) = (twin.poses_in_world[i], expert.poses_in_world[i]);
        assert!(pose.pitch_rad.to_degrees().abs() <= steepest, "{}", pose.pitch_rad.to_degrees());
        assert!((original.pitch_rad + frame.pitch_offset_rad - pose.pitch_rad).abs() < 1e-12);
        stopped += usize::from(pose.pitch_rad.to_degrees() < -89.8);
    }
    assert!(stopped > 10, "{stopped}");
}

#[test]
fn a_twin_in_a_tunnel_keeps_its_clearance_along_the_whole_way() {
    let (expert, exact) = (expert(700), tunnel());
    let config = PerturbConfig::default();
    let twin = twin_of(&expert, &exact, &config, seed());
    let positions: Vec<DVec3> = twin.poses_in_world.iter().map(|pose| pose.position_in_world).collect();
    for pair in positions.windows(2) {
        assert!(exact.segment_clearance(pair[0], pair[1], 5.0) >= 1.0 - 1e-9);
    }
    assert!(twin.certificate.holds, "{:?}", twin.certificate.violations);
    let shortened = frames(&twin).iter().filter(|f| f.position && f.drone_offset_in_world.length() < 2.0).count();
    let full = frames(&twin).iter().filter(|f| f.drone_offset_in_world.length() >= 2.0).count();
    assert!(shortened > 5 && full > 100, "{shortened} shortened, {full} full");
    assert!(twin.clearance_m.iter().all(|clearance| *clearance >= 1.0 - 1e-9));
}

#[test]
fn an_expert_closer_than_the_clearance_is_reported_and_not_left() {
    let exact =
        BoxBvh::build(vec![OrientedBox::from_corners(DVec3::new(-30.0, 0.5, 0.0), DVec3::new(90.0, 40.0, 60.0))]);
    let (expert, config) = (expert(100), PerturbConfig::default());
    let twin = twin_of(&expert, &exact, &config, seed());
    assert!(!twin.certificate.holds);
    assert!(twin.certificate.violations[0].starts_with("clearance falls to 0.50 m; the limit is 1 m"));
    assert!(twin.clearance_m.iter().all(|clearance| *clearance >= 0.5 - 1e-9));
}

#[test]
fn a_low_flight_is_not_pushed_into_the_ground() {
    let mut expert = expert(300);
    for pose in &mut expert.poses_in_world {
        pose.position_in_world.z = 3.5;
    }
    let twin = twin_of(&expert, &BoxBvh::build(vec![]), &PerturbConfig::default(), seed());
    assert!(twin.poses_in_world.iter().all(|pose| pose.position_in_world.z >= 3.0));
}

#[test]
fn a_twin_depends_on_its_seed_alone() {
    let (expert, exact, config) = (expert(200), tunnel(), PerturbConfig::default());
    let twin = |seed| twin_of(&expert, &exact, &config, seed);
    assert_eq!(twin(seed()), twin(seed()));
    assert_ne!(twin(seed()), twin(Seed::of_item(9, "perturbed", "p4")));
}

#[test]
fn uneven_and_touching_experts_are_rejected_and_empty_ones_have_empty_twins() {
    let config = PerturbConfig::default();
    let reason = |expert: &Trajectory| match perturb(expert, "p3", ExactMap::still(&tunnel()), &config, seed()) {
        PlanOutcome::Rejected { reason, .. } => reason,
        PlanOutcome::Planned(_) => String::new(),
    };
    let (mut uneven, mut touching) = (expert(10), expert(10));
    uneven.poses_in_world.truncate(4);
    assert_eq!(reason(&uneven), "the expert has 4 poses for 10 frames");
    touching.poses_in_world[5].position_in_world.y = 2.5;
    assert!(reason(&touching).starts_with("the twin comes to"), "{}", reason(&touching));
    assert!(twin_of(&expert(0), &tunnel(), &config, seed()).poses_in_world.is_empty());
}

/// Parameters that give every flight one kind.
fn only(kind: &str) -> PerturbConfig {
    PerturbConfig { mixture: Mixture::of(&[(kind, 1.0)]), ..PerturbConfig::default() }
}

/// Names of the kinds that a drone could fly.
fn flyable() -> impl Iterator<Item = &'static str> {
    KINDS.iter().filter(|kind| matches!(kind.departure, Departure::Flown { .. })).map(|kind| kind.name)
}

/// Largest rate of yaw or pitch, degrees/s.
fn largest_rate_deg_s(twin: &Trajectory) -> f64 {
    let turn = |pair: &[Pose]| {
        let yaw = real::wrap_angle_rad(pair[1].yaw_rad - pair[0].yaw_rad).abs();
        yaw.max((pair[1].pitch_rad - pair[0].pitch_rad).abs()).to_degrees() / 0.5
    };
    twin.poses_in_world.windows(2).map(turn).fold(0.0, f64::max)
}

#[test]
fn flyable_twins_keep_their_limits_in_the_open_and_in_a_tunnel() {
    let (expert, config) = (expert(500), FlyableConfig::default());
    for (exact, is_open) in [(BoxBvh::build(vec![]), true), (tunnel(), false)] {
        for kind in flyable() {
            let twin = twin_of(&expert, &exact, &only(kind), seed());
            let certificate = &twin.certificate;
            assert!(certificate.holds && certificate.min_clearance_m >= 1.0, "{kind:?} {:?}", certificate.violations);
            assert_eq!(certificate.limits.speed_mps, config.max_speed_mps);
            assert!(certificate.max_acceleration_mps2 <= config.max_acceleration_mps2, "{kind:?}");
            assert!(largest_rate_deg_s(&twin) <= config.max_rate_deg_s + 1e-6, "{kind:?}");
            let displaced = frames(&twin).iter().map(|it| it.drone_offset_in_world.length()).fold(0.0, f64::max);
            let turned = frames(&twin).iter().filter(|it| it.rotation).count();
            assert!(displaced > if is_open { 2.0 } else { 0.05 }, "{kind:?} {displaced}");
            assert!(turned > 50 || !matches!(kind, "aim" | "search"), "{kind:?} {turned}");
        }
    }
}

#[test]
fn flyable_twins_record_what_was_flown_and_depend_on_their_seed_alone() {
    let (expert, exact) = (expert(200), tunnel());
    for kind in flyable() {
        let config = only(kind);
        let twin = twin_of(&expert, &exact, &config, seed());
        assert_eq!(twin.perturbation.as_ref().unwrap().kind.name(), kind);
        for (frame, (pose, original)) in twin.poses_in_world.iter().zip(&expert.poses_in_world).enumerate() {
            let moved = pose.position_in_world - original.position_in_world;
            assert!((moved - frames(&twin)[frame].drone_offset_in_world).length() < 1e-9, "{kind:?} {frame}");
        }
        assert_eq!(twin, twin_of(&expert, &exact, &config, seed()));
        assert_ne!(twin, twin_of(&expert, &exact, &config, Seed::of_item(9, "perturbed", "p4")));
    }
}

#[test]
fn without_drift_the_camera_alone_departs() {
    let (expert, exact) = (expert(300), BoxBvh::build(vec![]));
    for kind in ["aim", "search"] {
        let mut config = only(kind);
        config.flyable.drift_m = 0.0;
        let twin = twin_of(&expert, &exact, &config, seed());
        assert!(frames(&twin).iter().all(|it| !it.position) && frames(&twin).iter().any(|it| it.rotation), "{kind:?}");
    }
}

#[test]
fn a_tight_limit_of_acceleration_makes_displacements_smaller() {
    let (expert, exact) = (expert(400), BoxBvh::build(vec![]));
    let mut config = only("gusts");
    let largest = |config: &PerturbConfig| {
        let twin = twin_of(&expert, &exact, config, seed());
        assert!(twin.certificate.max_acceleration_mps2 <= config.flyable.max_acceleration_mps2);
        frames(&twin).iter().map(|it| it.drone_offset_in_world.length()).fold(0.0, f64::max)
    };
    let wide = largest(&config);
    config.flyable.max_acceleration_mps2 = 0.5;
    let narrow = largest(&config);
    assert!(0.0 < narrow && narrow < 0.7 * wide, "{narrow} {wide}");
}

#[test]
fn a_bend_at_the_limit_makes_displacements_smaller_there_and_nowhere_else() {
    let (straight, exact) = (expert(2000), BoxBvh::build(vec![]));
    let mut bent = straight.clone();
    // One metre aside from one frame to the next: 4 m/s^2, which leaves nothing for a gust.
    bent.poses_in_world[1000..].iter_mut().for_each(|pose| pose.position_in_world.y += 1.0);
    let mut reduced = 0;
    for kind in ["drift", "gusts", "timing"] {
        let mut config = only(kind);
        config.flyable.max_acceleration_mps2 = 4.001;
        let [free, kept] = [&straight, &bent].map(|expert| twin_of(expert, &exact, &config, seed()));
        assert!(kept.certificate.max_acceleration_mps2 <= 4.001, "{kind:?}");
        let offset = |twin: &Trajectory, frame: usize| frames(twin)[frame].drone_offset_in_world;
        let is_same = |frame: usize| offset(&free, frame).distance(offset(&kept, frame)) < 1e-9;
        assert!((0..900).chain(1100..2000).all(is_same), "{kind:?}");
        reduced += (960..1040).filter(|at| offset(&kept, *at).length() < 0.9 * offset(&free, *at).length()).count();
    }
    assert!(reduced > 0);
}

#[test]
fn twins_keep_clear_of_boxes_that_move() {
    let (expert, exact) = (expert(300), BoxBvh::build(vec![]));
    // Something flies along, a frame behind, as near as the clearance allows.
    let at = |frame: usize| OrientedBox {
        center_in_world: expert.poses_in_world[frame.saturating_sub(1)].position_in_world + DVec3::new(0.0, 3.2, 0.0),
        half_extents_m: DVec3::splat(1.0),
        yaw_rad: 0.1 * frame as f64,
    };
    let movers = [(0..300).map(at).collect::<Vec<_>>()];
    let map = ExactMap::among(&exact, &movers);
    for kind in KINDS.iter().map(|kind| kind.name) {
        let config = only(kind);
        let PlanOutcome::Planned(twin) = perturb(&expert, "p3", map, &config, seed()) else { panic!("{kind:?}") };
        assert!(twin.certificate.min_clearance_m >= config.clearance_m - 1e-9, "{kind:?}");
        let offsets = frames(&twin).iter().map(|frame| frame.drone_offset_in_world.length());
        assert!(kind == "aim" || kind == "search" || offsets.fold(0.0, f64::max) > 0.1, "{kind:?}");
    }
}

#[test]
fn twins_keep_the_separation_from_other_drones() {
    const SEPARATION_M: f64 = 6.0;
    let (expert, exact) = (expert(300), BoxBvh::build(vec![]));
    let place = |pose: &Pose| pose.position_in_world + DVec3::new(0.0, SEPARATION_M + 0.4, 0.0);
    let other: Vec<DVec3> = expert.poses_in_world.iter().map(place).collect();
    let movers = [drone_boxes(&other)];
    for kind in KINDS.iter().map(|kind| kind.name) {
        let config = only(kind);
        let drones = OtherDrones { count: 1, separation_m: SEPARATION_M };
        let map = ExactMap { drones, clearance_m: config.clearance_m, ..ExactMap::among(&exact, &movers) };
        let PlanOutcome::Planned(twin) = perturb(&expert, "p3", map, &config, seed()) else { panic!("{kind:?}") };
        let apart = twin.poses_in_world.iter().zip(&other).map(|(pose, other)| pose.position_in_world.distance(*other));
        let least_m = apart.fold(f64::INFINITY, f64::min);
        assert!(least_m >= SEPARATION_M - 1e-9, "{kind:?}: {least_m}");
    }
}
