//! Bad tracks, absurd maps and impossible wishes end in a reason or a certified flight, never in a panic.

use cosfly_domain::{OrientedBox, PlanOutcome};
use cosfly_frames::{DVec3, TargetState, TargetTrack};
use cosfly_geometry::BoxBvh;
use cosfly_planner::{MucoConfig, plan};
use cosfly_random::Seed;

fn track(feet: impl IntoIterator<Item = DVec3>) -> TargetTrack {
    let state = |feet_in_world| TargetState { feet_in_world, heading_rad: 0.0, speed_mps: 1.0 };
    TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states: feet.into_iter().map(state).collect() }
}

fn straight(frames: usize) -> TargetTrack {
    track((0..frames).map(|i| DVec3::new(0.65 * i as f64, 0.0, 0.0)))
}

fn plan_among(track: &TargetTrack, boxes: Vec<OrientedBox>, config: &MucoConfig) -> PlanOutcome {
    let exact = BoxBvh::build(boxes.clone());
    plan(track, &exact, &boxes, &|_, _| 0.0, config, Seed::of_item(1, "muco", "x"))
}

fn check_rejected(outcome: PlanOutcome, parts: &[&str]) {
    let PlanOutcome::Rejected { reason, .. } = outcome else { panic!("planned, though {parts:?}") };
    for part in parts {
        assert!(reason.contains(part), "`{reason}` does not say `{part}`");
    }
}

fn check_planned(outcome: PlanOutcome) -> cosfly_domain::Trajectory {
    match outcome {
        PlanOutcome::Planned(flight) => {
            assert!(flight.certificate.holds, "{:?}", flight.certificate.violations);
            *flight
        }
        PlanOutcome::Rejected { reason, .. } => panic!("rejected: {reason}"),
    }
}

fn block(center: DVec3, half: DVec3) -> OrientedBox {
    OrientedBox { center_in_world: center, half_extents_m: half, yaw_rad: 0.0 }
}

#[test]
fn broken_tracks_are_rejected_with_frame_and_value() {
    let config = MucoConfig::default();
    check_rejected(plan_among(&straight(0), vec![], &config), &["no frame"]);
    let mut broken = straight(10);
    broken.states[4].feet_in_world.y = f64::NAN;
    check_rejected(plan_among(&broken, vec![], &config), &["frame 4", "finite"]);
    let mut teleporting = straight(10);
    teleporting.states[6].feet_in_world.x += 100.0;
    check_rejected(plan_among(&teleporting, vec![], &config), &["frame 6", "201.3 m/s", "12 m/s"]);
    let mut timeless = straight(10);
    timeless.dt_s = 0.0;
    check_rejected(plan_among(&timeless, vec![], &config), &["time step", "0"]);
    let far = track([DVec3::splat(1e300), DVec3::splat(1e300)]);
    check_rejected(plan_among(&far, vec![], &config), &["frame 0"]);
}

#[test]
fn short_tracks_without_any_obstacle_are_flown() {
    for frames in [1, 2, 3, 4, 5, 9] {
        let flight = check_planned(plan_among(&straight(frames), vec![], &MucoConfig::default()));
        assert_eq!(flight.poses_in_world.len(), frames);
        assert_eq!(flight.certificate.mean_visibility, 1.0);
        assert_eq!(flight.certificate.min_clearance_m, 50.0);
    }
}

#[test]
fn a_standing_target_has_a_length_ratio_of_zero() {
    let flight = check_planned(plan_among(&track([DVec3::ZERO; 40]), vec![], &MucoConfig::default()));
    assert_eq!((flight.certificate.length_ratio, flight.certificate.mean_rear_angle_deg), (0.0, 0.0));
}

#[test]
fn a_target_inside_a_building_is_followed_unseen() {
    let house = block(DVec3::new(15.0, 0.0, 5.0), DVec3::new(8.0, 8.0, 5.0));
    let flight = check_planned(plan_among(&straight(60), vec![house], &MucoConfig::default()));
    assert_eq!(flight.visibility[23], 0.0);
    assert!(flight.visibility[0] > 0.9);
}

#[test]
fn no_free_viewpoint_is_a_reason() {
    let rock = block(DVec3::ZERO, DVec3::splat(200.0));
    check_rejected(plan_among(&straight(60), vec![rock], &MucoConfig::default()), &["frame 0", "no free viewpoint"]);
}

#[test]
fn contradictory_bands_are_rejected() {
    let mut config = MucoConfig::default();
    config.view.min_altitude_m = 60.0;
    check_rejected(plan_among(&straight(5), vec![], &config), &["view.min_altitude_m", "60"]);
}

#[test]
fn limits_that_cannot_be_met_are_named_or_tolerated_as_the_recipe_says() {
    let mut config = MucoConfig::default();
    config.limits.acceleration_mps2 = 0.1;
    let turning = track((0..60).map(|i| {
        let forth = if (i / 6) % 2 == 0 { i % 6 } else { 6 - i % 6 };
        DVec3::new(5.5 * f64::from(forth), 0.0, 0.0)
    }));
    match plan_among(&turning, vec![], &config) {
        PlanOutcome::Planned(flight) => assert!(flight.certificate.max_acceleration_mps2 <= 0.1 + 1e-6),
        PlanOutcome::Rejected { reason, .. } => assert!(reason.contains("limit is 0.1"), "{reason}"),
    }
    config.limits.require_kinematics = false;
    let PlanOutcome::Planned(_) = plan_among(&turning, vec![], &config) else { panic!("rejected") };
}

#[test]
fn broken_and_degenerate_boxes_do_no_harm() {
    let boxes = vec![
        block(DVec3::NAN, DVec3::ONE),
        block(DVec3::new(10.0, 5.0, 20.0), DVec3::ZERO),
        block(DVec3::new(10.0, 5.0, 25.0), DVec3::new(f64::INFINITY, 1.0, 1.0)),
        block(DVec3::new(10.0, -5.0, 2.0), DVec3::new(4.0, 0.0, 2.0)),
    ];
    let exact = BoxBvh::build(vec![boxes[1], boxes[3]]);
    let seed = Seed::of_item(1, "muco", "x");
    check_planned(plan(&straight(40), &exact, &boxes, &|_, _| f64::NAN, &MucoConfig::default(), seed));
}

#[test]
fn hills_are_flown_over_at_the_lowest_altitude() {
    let hill = |x: f64, y: f64| 0.12 * x + 3.0 * cosfly_frames::real::sin(0.05 * y);
    let walker = track((0..120).map(|i| {
        let (x, y) = (0.6 * f64::from(i), 10.0);
        DVec3::new(x, y, hill(x, y))
    }));
    let exact = BoxBvh::build(vec![]);
    let outcome = plan(&walker, &exact, &[], &hill, &MucoConfig::default(), Seed::of_item(1, "muco", "x"));
    for pose in check_planned(outcome).poses_in_world {
        let p = pose.position_in_world;
        assert!(p.z - hill(p.x, p.y) > 18.0, "{p}");
    }
}

#[test]
fn a_hundred_thousand_frames_take_time_in_proportion_and_the_memory_of_a_stretch() {
    let frames = 100_000;
    let long = track((0..frames).map(|i| {
        let i = f64::from(i);
        DVec3::new(0.6 * i, 20.0 * cosfly_frames::real::sin(0.01 * i), 0.0)
    }));
    let boxes: Vec<OrientedBox> =
        (0..6000).map(|i| block(DVec3::new(10.0 * f64::from(i), 25.0, 8.0), DVec3::new(3.0, 3.0, 8.0))).collect();
    let flight = check_planned(plan_among(&long, boxes, &MucoConfig::default()));
    assert_eq!(flight.poses_in_world.len(), frames as usize);
    assert!(flight.certificate.mean_visibility > 0.9, "{}", flight.certificate.mean_visibility);
}

#[test]
fn a_million_boxes_are_filtered_per_path() {
    let boxes: Vec<OrientedBox> = (0..1_000_000)
        .map(|i| {
            let (column, row) = (f64::from(i % 1000), f64::from(i / 1000));
            block(DVec3::new(12.0 * column - 6000.0, 12.0 * row - 5996.0, 3.0), DVec3::new(2.0, 1.0, 3.0))
        })
        .collect();
    let flight = check_planned(plan_among(&straight(120), boxes, &MucoConfig::default()));
    assert!(flight.certificate.filtered_boxes < 400, "{}", flight.certificate.filtered_boxes);
}
