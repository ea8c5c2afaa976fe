//! Requests beside a plain flight: start states, companions, moving boxes, ordered losses, presets.

use cosfly_domain::{OrientedBox, PlanOutcome, Trajectory};
use cosfly_frames::{DVec3, TargetState, TargetTrack};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_planner::certificate::Kinematics;
use cosfly_planner::config::{Planner, SeveralTargets};
use cosfly_planner::{MucoConfig, PlanRequest, Preset, StartState, plan_request};
use cosfly_scenes::{Scene, SceneKind};
use cosfly_surroundings::visibility;
use cosfly_surroundings::visibility::body_points;

fn flown(outcome: PlanOutcome) -> Trajectory {
    match outcome {
        PlanOutcome::Planned(flight) => *flight,
        PlanOutcome::Rejected { reason, .. } => panic!("{reason}"),
    }
}

fn refused(outcome: PlanOutcome, part: &str) {
    let PlanOutcome::Rejected { reason, .. } = outcome else { panic!("planned; expected `{part}`") };
    assert!(reason.contains(part), "{reason}");
}

fn positions(flight: &Trajectory) -> Vec<DVec3> {
    flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect()
}

fn straight(frames: usize, y: f64) -> TargetTrack {
    let state =
        |i: usize| TargetState { feet_in_world: DVec3::new(0.6 * i as f64, y, 0.0), heading_rad: 0.0, speed_mps: 1.2 };
    TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states: (0..frames).map(state).collect() }
}

#[test]
fn any_state_on_a_flight_can_be_continued_from_within_all_limits() {
    let scene = Scene::generate(SceneKind::Leafy, 3);
    let exact = BoxBvh::build(scene.boxes.clone());
    let config = MucoConfig::default();
    let track = scene.walker(3, 0);
    let expert = positions(&flown(plan_request(PlanRequest::new(&track, &exact, &scene.boxes, &|_, _| 0.0, &config))));
    let mut planned = 0;
    for frame in (10..150).step_by(20) {
        let rest = TargetTrack { states: track.states[frame..].to_vec(), ..track.clone() };
        let start = StartState {
            position_in_world: expert[frame] + DVec3::new(1.0, -0.5, 0.5),
            velocity_in_world: (expert[frame] - expert[frame - 1]) / track.dt_s,
        };
        let mut request = PlanRequest::new(&rest, &exact, &scene.boxes, &|_, _| 0.0, &config);
        request.start = Some(start);
        let PlanOutcome::Planned(flight) = plan_request(request) else { continue };
        planned += 1;
        let flight = *flight;
        assert_eq!((flight.track.len(), flight.poses_in_world.len()), (rest.len(), rest.len()));
        let mut with_before = vec![
            start.position_in_world - track.dt_s * 2.0 * start.velocity_in_world,
            start.position_in_world - track.dt_s * start.velocity_in_world,
        ];
        with_before.extend(positions(&flight));
        assert!(with_before[2].distance(start.position_in_world) < 1e-9);
        let states = [&[rest.states[0]; 2][..], &rest.states].concat();
        let longer = TargetTrack { states, ..rest.clone() };
        let kinematics = Kinematics::of(&longer, &with_before, 3);
        assert!(kinematics.violations(&flight.certificate.limits).is_empty(), "{frame}: {kinematics:?}");
        for pair in with_before[2..].windows(2) {
            assert!(exact.segment_clearance(pair[0], pair[1], 5.0) >= config.limits.clearance_m);
        }
    }
    assert!(planned >= 5, "{planned} of 7");
}

#[test]
fn a_state_on_a_known_flight_goes_on_along_it_and_one_beside_it_joins_it() {
    let scene = Scene::generate(SceneKind::Leafy, 4);
    let exact = BoxBvh::build(scene.boxes.clone());
    let config = MucoConfig::default();
    let track = scene.walker(4, 0);
    let flight = positions(&flown(plan_request(PlanRequest::new(&track, &exact, &scene.boxes, &|_, _| 0.0, &config))));
    let mut joined = 0;
    for frame in (2..150).step_by(7) {
        let rest = TargetTrack { states: track.states[frame..].to_vec(), ..track.clone() };
        let velocities = [flight[frame] - flight[frame - 1], 0.5 * (flight[frame + 1] - flight[frame - 1])];
        for (offset, velocity) in
            velocities.iter().map(|it| (DVec3::ZERO, *it)).chain([(DVec3::new(1.0, -2.0, 1.0), velocities[0])])
        {
            let velocity_in_world = velocity / track.dt_s;
            let start = StartState { position_in_world: flight[frame] + offset, velocity_in_world };
            let mut request = PlanRequest::new(&rest, &exact, &scene.boxes, &|_, _| 0.0, &config);
            (request.start, request.flight) = (Some(start), Some(&flight[frame..]));
            let answer = flown(plan_request(request));
            assert!(answer.certificate.holds, "{frame}: {:?}", answer.certificate.violations);
            let way = positions(&answer);
            assert!(way[0].distance(start.position_in_world) < 1e-9);
            let gap = way[16].distance(flight[frame + 16]);
            let is_on_it = offset == DVec3::ZERO;
            assert!(!is_on_it || way[5].distance(flight[frame + 5]) < 0.1, "{frame}: {gap}");
            joined += usize::from(gap < 1e-9);
        }
    }
    assert!(joined >= 60, "{joined} of 66");
    let mut request = PlanRequest::new(&track, &exact, &scene.boxes, &|_, _| 0.0, &config);
    request.flight = Some(&flight[1..]);
    refused(plan_request(request), "the flight to join has");
}

#[test]
fn a_start_state_that_cannot_be_is_refused_with_the_reason() {
    let track = straight(40, 0.0);
    let boxes = vec![OrientedBox::from_corners(DVec3::new(-30.0, -5.0, 0.0), DVec3::new(-20.0, 5.0, 30.0))];
    let exact = BoxBvh::build(boxes.clone());
    let config = MucoConfig::default();
    let from = |position_in_world: DVec3, velocity_in_world: DVec3| {
        let mut request = PlanRequest::new(&track, &exact, &boxes, &|_, _| 0.0, &config);
        request.start = Some(StartState { position_in_world, velocity_in_world });
        plan_request(request)
    };
    refused(from(DVec3::new(-25.0, 0.0, 10.0), DVec3::ZERO), "from an obstacle");
    refused(from(DVec3::new(-19.0, 0.0, 10.0), DVec3::ZERO), "1.00 m from an obstacle");
    refused(from(DVec3::new(0.0, -20.0, 0.5), DVec3::ZERO), "the ground");
    refused(from(DVec3::new(0.0, -20.0, 20.0), DVec3::new(20.0, 0.0, 0.0)), "20.00 m/s");
    refused(from(DVec3::new(f64::NAN, 0.0, 20.0), DVec3::ZERO), "not finite");
    let flight = flown(from(DVec3::new(-5.0, -28.0, 12.0), DVec3::new(0.0, 0.0, 3.0)));
    assert!(positions(&flight)[0].distance(DVec3::new(-5.0, -28.0, 12.0)) < 1e-9);
    assert!(flight.certificate.mean_visibility > 0.95);
}

#[test]
fn companions_are_seen_when_they_count() {
    // A wall hides the companion from most places that see the target.
    let (track, other) = (straight(60, 0.0), straight(60, 9.0));
    let boxes = vec![OrientedBox::from_corners(DVec3::new(-60.0, 4.0, 0.0), DVec3::new(90.0, 5.0, 14.0))];
    let exact = BoxBvh::build(boxes.clone());
    let seen_of_other = |combine: Option<SeveralTargets>| {
        let mut config = MucoConfig::default();
        config.targets.visibility = combine.unwrap_or_default();
        let companions = [other.clone()];
        let mut request = PlanRequest::new(&track, &exact, &boxes, &|_, _| 0.0, &config);
        request.companions = if combine.is_some() { &companions } else { &[] };
        let flight = flown(plan_request(request));
        let seen = positions(&flight).into_iter().zip(&other.states).map(|(w, s)| visibility(&exact, w, s, 1.75));
        (seen.sum::<f64>() / 60.0, flight.certificate.mean_visibility)
    };
    let alone = seen_of_other(None);
    let (mean, minimum) = (seen_of_other(Some(SeveralTargets::Mean)), seen_of_other(Some(SeveralTargets::Minimum)));
    for together in [mean, minimum] {
        assert!(together.0 > 0.9 && together.1 > 0.9, "{alone:?} {mean:?} {minimum:?}");
    }
}

#[test]
fn boxes_that_move_are_kept_clear_of_and_looked_past() {
    let track = straight(60, 0.0);
    let exact = BoxBvh::build(vec![]);
    let config = MucoConfig::default();
    let still = positions(&flown(plan_request(PlanRequest::new(&track, &exact, &[], &|_, _| 0.0, &config))));
    // A balloon that drifts along with the drone, where it would have been.
    let places: Vec<OrientedBox> = still
        .iter()
        .enumerate()
        .map(|(i, w)| OrientedBox {
            center_in_world: *w + DVec3::new(0.0, 0.05 * i as f64, 0.0),
            half_extents_m: DVec3::splat(2.0),
            yaw_rad: 0.02 * i as f64,
        })
        .collect();
    let movers = [places.clone()];
    let mut request = PlanRequest::new(&track, &exact, &[], &|_, _| 0.0, &config);
    request.movers = &movers;
    let flight = flown(plan_request(request));
    for (i, pair) in positions(&flight).windows(2).enumerate() {
        for k in 0..=10 {
            let t = f64::from(k) / 10.0;
            let at = pair[0].lerp(pair[1], t);
            let center = places[i].center_in_world.lerp(places[i + 1].center_in_world, t);
            let gap = ((at - center).abs() - DVec3::splat(2.0 * 1.42)).max(DVec3::ZERO).length();
            assert!(gap > 0.5, "frame {i}: {gap}");
        }
        assert!(flight.clearance_m[i] >= config.limits.clearance_m);
        let seen = body_points(&track.states[i], 1.75);
        assert!(seen.len() == 8 && flight.visibility[i] >= 0.0);
    }
    assert!(flight.certificate.mean_visibility > 0.95, "{}", flight.certificate.mean_visibility);
    let mut request = PlanRequest::new(&track, &exact, &[], &|_, _| 0.0, &config);
    let short = [places[..10].to_vec()];
    request.movers = &short;
    refused(plan_request(request), "10 places");
}

#[test]
fn the_target_is_lost_on_purpose_and_the_shortfall_is_told() {
    let scene = Scene::generate(SceneKind::Alley, 2);
    let exact = BoxBvh::build(scene.boxes.clone());
    let mut config = MucoConfig::default();
    config.occlusion.count = 1;
    let (mut ordered, mut reached) = (0.0, 0.0);
    for index in 0..4 {
        let track = scene.walker(2, index);
        let flight = flown(plan_request(PlanRequest::new(&track, &exact, &scene.boxes, &|_, _| 0.0, &config)));
        let certificate = &flight.certificate;
        assert!(certificate.holds && certificate.occlusion_reached_s <= certificate.occlusion_ordered_s);
        let longest = flight.visibility.split(|seen| *seen > 0.0).map(<[f64]>::len).max().unwrap_or(0);
        assert!(longest as f64 * track.dt_s <= 6.0, "{longest} frames");
        ordered += certificate.occlusion_ordered_s;
        reached += certificate.occlusion_reached_s;
    }
    assert!((ordered - 12.0).abs() < 2.1, "{ordered}");
    assert!(reached > 0.5 * ordered, "{reached} of {ordered}");
    // In the open nothing hides anybody.
    let open = BoxBvh::build(vec![]);
    let flight = flown(plan_request(PlanRequest::new(&straight(60, 0.0), &open, &[], &|_, _| 0.0, &config)));
    assert!(flight.certificate.occlusion_ordered_s > 0.0);
    assert_eq!(flight.certificate.occlusion_reached_s, 0.0);
}

#[test]
fn presets_fly_behind_the_walker_or_short_ways() {
    let scene = Scene::generate(SceneKind::Light, 4);
    let exact = BoxBvh::build(scene.boxes.clone());
    let of = |preset: Preset| {
        let config = MucoConfig { preset, ..MucoConfig::default() };
        let flights = (0..6).map(|index| {
            let track = scene.walker(4, index);
            flown(plan_request(PlanRequest::new(&track, &exact, &scene.boxes, &|_, _| 0.0, &config))).certificate
        });
        let sum = flights.fold((0.0, 0.0, 0.0), |sum, c| {
            (sum.0 + c.mean_rear_angle_deg, sum.1 + c.length_ratio, sum.2 + c.mean_visibility)
        });
        (sum.0 / 6.0, sum.1 / 6.0, sum.2 / 6.0)
    };
    let (usual, rear, short) = (of(Preset::Cosfly), of(Preset::Rear), of(Preset::Short));
    assert!(rear.0 < 0.8 * usual.0, "{usual:?} {rear:?}");
    assert!(short.1 < 0.85 * usual.1, "{usual:?} {short:?}");
    assert!(rear.2 > 0.9 && short.2 > 0.9, "{usual:?} {rear:?} {short:?}");
}

#[test]
fn a_baseline_plans_in_place_of_the_optimiser_and_is_judged_like_it() {
    let track = straight(30, 0.0);
    let boxes = vec![OrientedBox::from_corners(DVec3::new(-10.0, 6.0, 0.0), DVec3::new(10.0, 16.0, 12.0))];
    let exact = BoxBvh::build(boxes.clone());
    let by = |planner: Planner, require_kinematics: bool| {
        let mut config = MucoConfig { planner, ..MucoConfig::default() };
        config.limits.require_kinematics = require_kinematics;
        plan_request(PlanRequest::new(&track, &exact, &boxes, &|_, _| 0.0, &config))
    };
    for planner in [Planner::Astar, Planner::AstarSmoothed, Planner::Beam, Planner::Dp] {
        let flight = flown(by(planner, false));
        assert!(flight.certificate.min_clearance_m >= 1.5 && flight.certificate.mean_visibility > 0.9, "{planner:?}");
    }
    assert!(flown(by(Planner::AstarSmoothed, true)).certificate.holds);
    let config = MucoConfig { planner: Planner::Dp, ..MucoConfig::default() };
    let mut request = PlanRequest::new(&track, &exact, &boxes, &|_, _| 0.0, &config);
    request.companions = core::slice::from_ref(&track);
    refused(plan_request(request), "`planner` must be `muco`");
}
