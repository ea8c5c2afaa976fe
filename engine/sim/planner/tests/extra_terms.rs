//! A term from outside joins the search, the refinement and the output like the nine built-in ones.

use cosfly_domain::{PlanOutcome, Trajectory};
use cosfly_frames::{DVec3, TargetState, TargetTrack};
use cosfly_geometry::BoxBvh;
use cosfly_planner::config::{LimitsConfig, SearchConfig, SearchEffort, ViewConfig};
use cosfly_planner::{CostTerm, MucoConfig, TermContext, WeightedTerm, plan_with_terms};
use cosfly_random::Seed;

/// Prefers to be east of the target; knows no gradient.
struct EastOfTarget;

impl CostTerm for EastOfTarget {
    fn name(&self) -> &str {
        "east_of_target"
    }

    fn support(&self) -> usize {
        0
    }

    fn cost(&self, waypoints: &[DVec3], context: &TermContext<'_>, per_frame: &mut [f64]) {
        for ((waypoint, state), cost) in waypoints.iter().zip(&context.track.states).zip(per_frame) {
            let short = (state.feet_in_world.x + 15.0 - waypoint.x).max(0.0);
            *cost = 0.01 * short * short;
        }
    }
}

/// Says nothing but nonsense.
struct Nonsense;

impl CostTerm for Nonsense {
    fn name(&self) -> &str {
        "nonsense"
    }

    fn support(&self) -> usize {
        0
    }

    fn cost(&self, _: &[DVec3], _: &TermContext<'_>, per_frame: &mut [f64]) {
        per_frame.fill(f64::NAN);
    }
}

fn walking_east(frames: usize) -> TargetTrack {
    let state = |i: usize| TargetState {
        feet_in_world: DVec3::new(0.6 * i as f64, 0.0, 0.0),
        heading_rad: 0.0,
        speed_mps: 1.2,
    };
    TargetTrack { dt_s: 0.5, height_m: 1.75, radius_m: 0.3, states: (0..frames).map(state).collect() }
}

fn plan_with(config: &MucoConfig, extra: Vec<WeightedTerm>) -> PlanOutcome {
    let exact = BoxBvh::build(vec![]);
    plan_with_terms(&walking_east(40), &exact, &[], &|_, _| 0.0, config, extra, Seed::of_item(1, "muco", "x"))
}

fn flown(outcome: PlanOutcome) -> Trajectory {
    match outcome {
        PlanOutcome::Planned(flight) => *flight,
        PlanOutcome::Rejected { reason, .. } => panic!("{reason}"),
    }
}

#[test]
fn a_foreign_term_moves_the_flight_and_is_listed_with_its_cost() {
    let config = MucoConfig::default();
    let without = flown(plan_with(&config, vec![]));
    let with = flown(plan_with(&config, vec![WeightedTerm { term: Box::new(EastOfTarget), weight: 5.0 }]));
    let east = |flight: &Trajectory| flight.poses_in_world[20].position_in_world.x - 12.0;
    assert!(east(&without) < -8.0, "behind a target that walks east: {}", east(&without));
    assert!(east(&with) > 10.0, "{}", east(&with));
    assert_eq!(with.terms.len(), 10);
    assert_eq!((with.terms[9].name.as_str(), with.terms[9].weight), ("east_of_target", 5.0));
}

#[test]
fn a_term_that_is_no_number_ends_in_a_reason() {
    let outcome = plan_with(&MucoConfig::default(), vec![WeightedTerm { term: Box::new(Nonsense), weight: 1.0 }]);
    let PlanOutcome::Rejected { reason, .. } = outcome else { panic!("planned on nonsense") };
    assert!(reason.contains("nonsense") && reason.contains("frame 0"), "{reason}");
}

#[test]
fn any_valid_configuration_ends_without_a_panic() {
    let mut stream = Seed::of_item(1, "configs", "any").stream("values");
    let mut planned = 0;
    for _ in 0..60 {
        let mut any = |low: f64, high: f64| stream.uniform(low, high);
        let (low, middle) = (any(0.5, 60.0), any(0.0, 20.0));
        let mut config = MucoConfig {
            limits: LimitsConfig {
                clearance_m: any(0.1, 10.0),
                speed_mps: any(0.5, 20.0),
                acceleration_mps2: any(0.1, 10.0),
                jerk_mps3: any(0.1, 20.0),
                yaw_rate_deg_s: Some(any(10.0, 200.0)),
                pitch_rate_deg_s: Some(any(10.0, 200.0)),
                require_kinematics: any(0.0, 1.0) < 0.5,
            },
            view: ViewConfig {
                distance_m: any(2.0, 60.0),
                pitch_deg: any(5.0, 85.0),
                min_altitude_m: low,
                preferred_altitude_m: low + middle,
                max_altitude_m: low + middle + any(0.0, 20.0),
                min_radius_m: any(0.5, 10.0),
                max_radius_m: any(10.0, 40.0),
                safety_influence_m: any(0.1, 20.0),
                rear_sector_deg: any(10.0, 180.0),
                start_sector_deg: any(10.0, 180.0),
            },
            search: SearchConfig {
                effort: if any(0.0, 1.0) < 0.3 { SearchEffort::Quality } else { SearchEffort::Escalating },
                azimuths: any(8.0, 90.0) as u32,
                altitudes: any(1.0, 6.0) as u32,
                radii: any(1.0, 9.0) as u32,
                keyframe_frames: any(1.0, 10.0) as u32,
                relative_motion: any(0.001, 5.0),
                absolute_motion: any(0.0, 5.0),
                filter_radius_m: any(45.0, 90.0),
            },
            ..MucoConfig::default()
        };
        config.descent.iterations = any(0.0, 20.0) as u32;
        config.descent.difference_m = any(0.001, 0.9);
        assert_eq!(config.validate(), Ok(()));
        match plan_with(&config, vec![]) {
            PlanOutcome::Planned(flight) => {
                planned += 1;
                let certificate = flight.certificate;
                assert!(certificate.holds || !config.limits.require_kinematics, "{:?}", certificate.violations);
            }
            PlanOutcome::Rejected { reason, .. } => assert!(!reason.is_empty()),
        }
    }
    assert!(planned > 30, "{planned}");
}
