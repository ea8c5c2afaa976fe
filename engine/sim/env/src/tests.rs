//! Laws of the environment: same actions, same steps; collisions; latency; baselines that rank as they should.

use crate::policies::{BASELINES, Knowledge, baseline};
use crate::{
    Action, Blackouts, DroneSettings, End, Environment, EnvironmentSettings, Episode, EpisodeScore, FlightSite,
    Observation, Others, Reward, Start, VelocityAxes, readings,
};
use cosfly_domain::{Around, Body, BodyKind, BodyPlan, OrientedBox, PlanOutcome, Traffic, Trajectory};
use cosfly_drone::ViewRates;
use cosfly_drone::models::MODELS;
use cosfly_frames::{DVec3, Seed, TargetState, TargetTrack, real};
use cosfly_planner::{MucoConfig, PlanRequest, plan_request};
use cosfly_scenes::{SceneKind, SeededScene};
use cosfly_sensors::SensorSet;
use std::sync::Arc;

/// Episodes behind walkers of a scene with their experts' flights.
fn episodes(kind: SceneKind, count: u64, frames: usize) -> Vec<(Arc<Episode>, Knowledge, Trajectory)> {
    let scene = SeededScene::generate(kind, 3);
    let place = Arc::new(FlightSite::on_flat_ground(scene.boxes.clone()));
    let config = Arc::new(MucoConfig::default());
    let flights = (0..count).filter_map(|index| {
        let mut track = scene.walker(3, index);
        track.states.truncate(frames);
        let request = PlanRequest::new(&track, &place.exact, &place.planning_boxes, &|_, _| 0.0, &config);
        let PlanOutcome::Planned(flight) = plan_request(request) else { return None };
        let waypoints: Vec<DVec3> = flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect();
        let velocity_in_world = (waypoints[1] - waypoints[0]) / track.dt_s;
        let episode = Episode {
            name: format!("w{index}"),
            stratum: kind.name().to_owned(),
            place: Arc::clone(&place),
            target: Arc::new(track),
            followed: None,
            looks: Seed([0; 32]),
            weather: None,
            others: Arc::default(),
            start: Start { position_in_world: waypoints[0], velocity_in_world },
            seed: Seed::of_item(3, "episodes", &index.to_string()),
        };
        let knowledge = Knowledge { flight: waypoints.into(), config: Arc::clone(&config) };
        Some((Arc::new(episode), knowledge, *flight))
    });
    flights.collect()
}

fn flown(name: &str, episode: &Arc<Episode>, knowledge: &Knowledge, settings: EnvironmentSettings) -> EpisodeScore {
    let mut environment = Environment::new(Arc::clone(episode), settings);
    let mut policy = (baseline(name).unwrap().make)(&environment, knowledge);
    while environment.score().end.is_none() {
        let action = environment.wants_action().then(|| policy.act(&environment));
        environment.step(action.as_ref());
    }
    *environment.score()
}

/// A target that stands 20 m ahead of a drone at a height of 20 m.
fn standing(boxes: Vec<OrientedBox>, seconds: usize) -> Arc<Episode> {
    let target = TargetState { feet_in_world: DVec3::new(20.0, 0.0, 0.0), heading_rad: 0.0, speed_mps: 0.0 };
    Arc::new(Episode {
        name: "standing".into(),
        stratum: String::new(),
        place: Arc::new(FlightSite::on_flat_ground(boxes)),
        target: Arc::new(TargetTrack {
            dt_s: 0.5,
            height_m: 1.75,
            radius_m: 0.25,
            states: vec![target; 2 * seconds + 1],
        }),
        followed: None,
        looks: Seed([0; 32]),
        weather: None,
        others: Arc::default(),
        start: Start { position_in_world: DVec3::new(0.0, 0.0, 20.0), velocity_in_world: DVec3::ZERO },
        seed: Seed([0; 32]),
    })
}

#[test]
fn an_expert_sees_what_its_certificate_says() {
    for kind in [SceneKind::Light, SceneKind::Leafy] {
        let all = episodes(kind, 6, 120);
        assert!(all.len() >= 4);
        let (mut flown_sum, mut stated_sum) = (0.0, 0.0);
        for (episode, knowledge, flight) in &all {
            let score = flown("expert", episode, knowledge, EnvironmentSettings::default());
            assert_eq!(score.end, Some(End::Finished), "{}", episode.name);
            flown_sum += score.mean_visibility();
            stated_sum += flight.certificate.mean_visibility;
        }
        let difference = (flown_sum - stated_sum).abs() / all.len() as f64;
        assert!(difference < 0.01, "{kind:?} {difference}");
    }
}

#[test]
fn baselines_rank_as_they_should() {
    let all = episodes(SceneKind::Light, 5, 60);
    let rate = |name: &str| {
        let scores =
            all.iter().map(|(episode, knowledge, _)| flown(name, episode, knowledge, EnvironmentSettings::default()));
        scores.map(|score| score.tracking_rate()).sum::<f64>() / all.len() as f64
    };
    let [random, hold, causal, expert] = ["random", "hold", "causal", "expert"].map(rate);
    assert!(random < causal && hold < causal && causal <= expert, "{random} {hold} {causal} {expert}");
    assert!(expert > 0.8, "{expert}");
}

#[test]
fn the_same_actions_give_the_same_steps_in_a_used_environment_too() {
    let (episode, knowledge, _) = episodes(SceneKind::Light, 3, 40).remove(0);
    for name in BASELINES.iter().map(|it| it.name) {
        let first = flown(name, &episode, &knowledge, EnvironmentSettings::default());
        assert_eq!(flown(name, &episode, &knowledge, EnvironmentSettings::default()), first, "{name}");
    }
    let mut used = Environment::new(standing(vec![], 5), EnvironmentSettings::default());
    (0..10).for_each(|_| _ = used.step(Some(&Action::of_numbers([3.0, 1.0, 0.0, 2.0, 9.0]))));
    used.reset(Arc::clone(&episode));
    let mut fresh = Environment::new(episode, EnvironmentSettings::default());
    for step in 0..50 {
        let action = Action::of_numbers([f64::from(step % 7), -1.0, 0.2, -1.0, 3.0]);
        assert_eq!(used.step(Some(&action)), fresh.step(Some(&action)));
    }
}

/// A leaderboard ranks baselines that do not see the world.
#[test]
fn who_does_not_see_the_world_flies_alike_whatever_the_expert_flew() {
    let (episode, knowledge, _) = episodes(SceneKind::Light, 3, 40).remove(0);
    let elsewhere = Knowledge { flight: knowledge.flight.iter().rev().copied().collect(), ..knowledge.clone() };
    for baseline in BASELINES {
        let known = ["state", "map", "world"];
        assert!(baseline.sees.iter().all(|input| known.contains(input)), "{}: {:?}", baseline.name, baseline.sees);
        let [one, other] =
            [&knowledge, &elsewhere].map(|it| flown(baseline.name, &episode, it, EnvironmentSettings::default()));
        assert_eq!(one == other, !baseline.sees.contains(&"world"), "{}", baseline.name);
    }
}

#[test]
fn a_drone_does_not_fly_through_a_wall_however_thin() {
    let wall = OrientedBox {
        center_in_world: DVec3::new(8.0, 0.0, 20.0),
        half_extents_m: DVec3::new(0.001, 5.0, 5.0),
        yaw_rad: 0.0,
    };
    let settings = EnvironmentSettings { step_s: 0.5, ..EnvironmentSettings::default() };
    let mut environment = Environment::new(standing(vec![wall], 20), settings);
    let ahead = Action { axes: VelocityAxes::World, velocity_mps: 12.0 * DVec3::X, ..Action::default() };
    while environment.score().end.is_none() {
        environment.step(Some(&ahead));
    }
    let after = environment.step(Some(&ahead));
    assert_eq!(after.end, Some(End::Collision));
    assert!(environment.observation().motion.position_in_world.x < 8.0 + 6.0);
    assert_eq!(after.reward, Reward::default(), "after the end nothing moves");
    let mut sinking = Environment::new(standing(vec![], 60), EnvironmentSettings::default());
    while sinking.score().end.is_none() {
        sinking.step(Some(&Action::of_numbers([0.0, 0.0, -3.0, 0.0, 0.0])));
    }
    assert_eq!((sinking.score().end, sinking.observation().above_ground_m < 0.3), (Some(End::Collision), true));
}

#[test]
fn an_action_takes_effect_after_the_latency_and_meanwhile_none_is_asked_for() {
    let ahead = Action { axes: VelocityAxes::World, velocity_mps: 2.0 * DVec3::X, ..Action::default() };
    // (latency, number of actions asked for in six steps, step after which the drone first moves)
    for (latency_s, asked, moves) in [(0.0, 6, 1), (0.057, 6, 1), (0.1, 6, 2), (0.2, 3, 3), (0.25, 2, 3)] {
        let settings = EnvironmentSettings { latency_s, ..EnvironmentSettings::default() };
        let mut environment = Environment::new(standing(vec![], 20), settings);
        let (mut count, mut first) = (0, None);
        for step in 1..=6 {
            let action = environment.wants_action().then_some(&ahead);
            count += usize::from(action.is_some());
            let moved = environment.step(action).observation.motion.position_in_world.x > 0.0;
            first = first.or(moved.then_some(step));
        }
        assert_eq!((count, first), (asked, Some(moves)), "{latency_s}");
    }
}

#[test]
fn numbers_of_observations_and_actions_are_what_their_names_say() {
    let mut environment = Environment::new(standing(vec![], 4), EnvironmentSettings::default());
    let set =
        |name: &str, value: f64| Action::of_numbers(Action::NAMES.map(|own| if own == name { value } else { 0.0 }));
    let turned = |action: Action| [action.view.yaw_rad_s, action.view.pitch_rad_s].map(f64::to_degrees);
    assert!(turned(set("yaw_rate_deg_s", 9.0))[0] > 8.9 && turned(set("pitch_rate_deg_s", 9.0))[1] > 8.9);
    assert_eq!(set("velocity_right_mps", 3.0).velocity_mps, 3.0 * DVec3::Y);
    for _ in 0..5 {
        environment.step(Some(&set("pitch_rate_deg_s", -9.0)));
    }
    let (seen, features) = (environment.observation(), environment.observation().features());
    let named = |name: &str| features[Observation::NAMES.iter().position(|own| *own == name).expect("a name")];
    assert_eq!(named("camera_pitch_deg"), seen.pitch_rad.to_degrees());
    assert_eq!(named("above_ground_m"), seen.above_ground_m);
    assert_eq!((named("is_tracked"), named("sighting_age_s")), (f64::from(seen.tracked), 0.0));
    let way = seen.along_heading(seen.sighting.target.feet_in_world - seen.motion.position_in_world);
    assert_eq!(["target_ahead_m", "target_right_m", "target_up_m"].map(named), way.to_array());
    assert_eq!(named("velocity_up_mps"), seen.motion.velocity_in_world.z);
    assert_eq!(named("acceleration_up_mps2"), seen.motion.acceleration_in_world.z);
}

#[test]
fn a_lost_target_ends_the_episode_and_is_remembered_as_it_was_seen() {
    let mut environment = Environment::new(standing(vec![], 60), EnvironmentSettings::default());
    let turn = Action::of_numbers([0.0, 0.0, 0.0, 0.0, 60.0]);
    for _ in 0..30 {
        environment.step(Some(&turn));
    }
    let seen = environment.observation();
    assert!(!seen.tracked && seen.sighting.time_s < 1.3 && seen.features()[15] > 1.6);
    while environment.score().end.is_none() {
        environment.step(Some(&Action::default()));
    }
    let score = environment.score();
    assert_eq!((score.end, score.losses, score.reacquired), (Some(End::Lost), 1, 0));
    assert!((score.untracked_s - 10.0).abs() < 1e-6 && score.tracking_rate() < 0.05);
}

#[test]
fn quadrotors_hold_their_place_in_wind_and_fall_without_thrust() {
    for model in MODELS.iter().copied().filter(|model| model.parameters.is_some()) {
        let drone = DroneSettings { model, wind_mps: 3.0, gusts: true, sensors: true };
        let settings = EnvironmentSettings { drone, ..EnvironmentSettings::default() };
        let mut environment = Environment::new(standing(vec![], 20), settings);
        let from = environment.observation().motion.position_in_world;
        for _ in 0..50 {
            environment.step(Some(&Action::default()));
        }
        let away_m = environment.observation().motion.position_in_world.distance(from);
        let strain = environment.tracking_error().expect("a quadrotor");
        assert!(away_m < 1.0 && strain.largest_error_m < 1.0 && strain.ticks == 5000, "{model:?} {away_m} {strain:?}");
        assert_eq!(environment.sensed().len(), 1000);
        while environment.score().end.is_none() {
            environment.step(Some(&Action::of_thrust_and_rates([0.0; 6])));
        }
        assert_eq!(environment.score().end, Some(End::Collision));
    }
}

/// A body that moves evenly along y from `from` for so many frames of 0.5 s.
fn crossing(kind: BodyKind, size_m: DVec3, from: DVec3, speed_mps: f64, frames: usize) -> Body {
    let heading_rad = real::FRAC_PI_2.copysign(speed_mps);
    let state = |frame: usize| TargetState {
        feet_in_world: from + DVec3::Y * (0.5 * frame as f64 * speed_mps),
        heading_rad,
        speed_mps: speed_mps.abs(),
    };
    let plan = BodyPlan { source: String::new(), kind, size_m, looks: Seed([1; 32]), group: None };
    Body { plan, first_frame: 0, states: (0..frames).map(state).collect() }
}

fn around(bodies: Vec<Body>, frames: u32) -> Around {
    let numbers = (0..bodies.len() as u32).collect();
    Around { numbers, traffic: Traffic { dt_s: 0.5, frames, bodies, ..Traffic::default() } }
}

#[test]
fn a_lorry_hides_the_target_while_it_passes_and_is_hit() {
    // It passes between a low camera and the target, its middle in the line of sight after 6 s.
    let lorry = crossing(BodyKind::Truck, DVec3::new(8.0, 2.5, 3.5), DVec3::new(16.0, -30.0, 0.0), 5.0, 41);
    let base = standing(vec![], 20);
    let start = Start { position_in_world: DVec3::new(0.0, 0.0, 4.0), velocity_in_world: DVec3::ZERO };
    let others = Arc::new(Others::new(&around(vec![lorry], 41), None));
    let episode = Arc::new(Episode { start, others, ..(*base).clone() });
    let mut environment = Environment::new(Arc::clone(&episode), EnvironmentSettings::default());
    let mut seen = vec![];
    while environment.score().end.is_none() && seen.len() < 100 {
        seen.push(environment.step(Some(&Action::default())).observation.visible);
    }
    assert!(seen[..40].iter().all(|visible| *visible == 1.0) && seen[75..].iter().all(|visible| *visible == 1.0));
    assert!(seen[55..65].iter().all(|visible| *visible < 0.3), "{seen:?}");
    // A drone that flies low along x meets it; one that waits does not.
    let low = Start { position_in_world: DVec3::new(4.0, 0.0, 2.0), velocity_in_world: DVec3::ZERO };
    for (speed_mps, end) in [(2.0, Some(End::Collision)), (0.0, None)] {
        let episode = Arc::new(Episode { start: low, ..(*episode).clone() });
        let mut environment = Environment::new(episode, EnvironmentSettings::default());
        let ahead = Action { axes: VelocityAxes::World, velocity_mps: speed_mps * DVec3::X, ..Action::default() };
        (0..90).for_each(|_| _ = environment.step(Some(&ahead)));
        assert_eq!(environment.score().end, end);
        let x = environment.observation().motion.position_in_world.x;
        assert!(end.is_none() || (14.0..18.0).contains(&x), "{x}");
    }
}

#[test]
fn a_followed_car_is_its_box_and_hides_nothing_of_itself() {
    let car = crossing(BodyKind::Car, DVec3::new(4.5, 1.8, 1.5), DVec3::new(20.0, 0.0, 0.0), 0.0, 41);
    let base = standing(vec![], 20);
    let target = TargetTrack { height_m: 1.5, radius_m: car.plan.radius_m(), states: car.states.clone(), dt_s: 0.5 };
    let followed = Some(car.plan.clone());
    // Alone, and with its own body among the others.
    for bodies in [vec![], vec![car.clone()]] {
        let others = Arc::new(Others::new(&around(bodies, 41), followed.as_ref()));
        let is_alone = others.is_empty();
        assert!(others.bodies().iter().all(|body| body.is_look_alike));
        let target = Arc::new(target.clone());
        let episode = Episode { target, followed: followed.clone(), others, ..(*base).clone() };
        assert_eq!(episode.visible(0.0, base.start.position_in_world, &car.states[0]), 1.0);
        // The car stands along y: beside its middle there is room within the circle around it.
        let clearance_m = |x: f64| {
            let at = DVec3::new(x, 0.0, 1.0);
            episode.vehicle_clearance_m([0.0, 0.1], [at, at], 9.0)
        };
        assert!((clearance_m(17.0) - 2.1).abs() < 0.011, "{}", clearance_m(17.0));
        let descend = |x: f64| {
            let start = Start { position_in_world: DVec3::new(x, 0.0, 4.0), velocity_in_world: DVec3::ZERO };
            let mut environment =
                Environment::new(Arc::new(Episode { start, ..episode.clone() }), EnvironmentSettings::default());
            let down = Action { velocity_mps: -0.5 * DVec3::Z, ..Action::default() };
            (0..60).for_each(|_| _ = environment.step(Some(&down)));
            environment.score().end
        };
        assert_eq!(descend(20.0), Some(End::Collision));
        assert_eq!(descend(18.5), None, "{is_alone}");
    }
}

#[test]
fn look_alikes_count_where_they_are_seen() {
    let person = DVec3::new(0.5, 0.5, 1.75);
    let body = |x: f64, y: f64, kind: BodyKind, looks: u8| {
        let mut body = crossing(kind, person, DVec3::new(x, y, 0.0), 0.0, 41);
        body.plan.looks = Seed([looks; 32]);
        body
    };
    // The same clothes ahead, behind a wall, behind the camera and beyond 60 m; a bicycle, and other clothes.
    let alike =
        [(25.0, 3.0), (25.0, -9.0), (-20.0, 0.0), (80.0, 0.0)].map(|(x, y)| body(x, y, BodyKind::Pedestrian, 1));
    let others = [body(22.0, 2.0, BodyKind::Bicycle, 1), body(22.0, 4.0, BodyKind::Pedestrian, 9)];
    let bodies: Vec<Body> = alike.iter().chain(&others).cloned().collect();
    let wall = OrientedBox {
        center_in_world: DVec3::new(22.0, -9.0, 5.0),
        half_extents_m: DVec3::new(0.2, 4.0, 5.0),
        yaw_rad: 0.0,
    };
    let followed = Some(alike[0].plan.clone());
    let others = Arc::new(Others::new(&around(bodies, 41), followed.as_ref()));
    assert_eq!(others.bodies().iter().filter(|body| body.is_look_alike).count(), 4);
    let episode = Episode { others, followed, ..(*standing(vec![wall], 20)).clone() };
    assert_eq!(Environment::new(Arc::new(episode), EnvironmentSettings::default()).look_alikes(), 1);
}

#[test]
fn an_expert_among_traffic_sees_what_its_certificate_says() {
    let scene = SeededScene::generate(SceneKind::Light, 3);
    let place = Arc::new(FlightSite::on_flat_ground(scene.boxes.clone()));
    let config = Arc::new(MucoConfig::default());
    let (mut flown_sum, mut stated_sum, mut count) = (0.0, 0.0, 0.0);
    for index in 0..4 {
        let mut track = scene.walker(3, index);
        track.states.truncate(100);
        let walk = track.states[0].feet_in_world;
        let bus = |k: usize| {
            let from = walk + DVec3::new(3.0 * k as f64 - 10.0, -20.0 - 9.0 * k as f64, 0.0);
            crossing(BodyKind::Bus, DVec3::new(11.0, 2.5, 6.0), from, 1.5, 100)
        };
        let around = around((0..6).map(bus).collect(), 100);
        let movers = around.boxes();
        let mut request = PlanRequest::new(&track, &place.exact, &place.planning_boxes, &|_, _| 0.0, &config);
        request.movers = &movers;
        let PlanOutcome::Planned(flight) = plan_request(request) else { continue };
        let waypoints: Vec<DVec3> = flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect();
        let velocity_in_world = (waypoints[1] - waypoints[0]) / track.dt_s;
        let episode = Arc::new(Episode {
            name: format!("w{index}"),
            place: Arc::clone(&place),
            target: Arc::new(track),
            others: Arc::new(Others::new(&around, None)),
            start: Start { position_in_world: waypoints[0], velocity_in_world },
            ..(*standing(vec![], 1)).clone()
        });
        let knowledge = Knowledge { flight: waypoints.into(), config: Arc::clone(&config) };
        let score = flown("expert", &episode, &knowledge, EnvironmentSettings::default());
        assert_eq!(score.end, Some(End::Finished));
        flown_sum += score.mean_visibility();
        stated_sum += flight.certificate.mean_visibility;
        count += 1.0;
        assert!(flown("causal", &episode, &knowledge, EnvironmentSettings::default()).steps > 0);
    }
    assert!(count >= 2.0 && (flown_sum - stated_sum).abs() / count < 0.01, "{flown_sum} {stated_sum} {count}");
}

#[test]
fn a_blind_camera_tracks_nothing_and_the_target_is_found_again() {
    let blackouts = Blackouts { count: 2, length_s: [2.0, 4.0] };
    let mut environment =
        Environment::new(standing(vec![], 60), EnvironmentSettings { blackouts, ..EnvironmentSettings::default() });
    let mut blind_steps = 0;
    while environment.score().end.is_none() {
        let step = environment.step(Some(&Action::default()));
        assert_eq!(step.observation.tracked, !environment.is_blind());
        blind_steps += u32::from(environment.is_blind());
    }
    let score = environment.score();
    assert_eq!((score.losses, score.reacquired, score.end), (2, 2, Some(End::Finished)));
    assert!((40..=80).contains(&blind_steps), "{blind_steps}");
}

#[test]
fn inertial_readings_are_without_the_truth_and_follow_the_drone() {
    let sensors = SensorSet::of(|sensor| sensor.name == "inertial_unit");
    for model in MODELS {
        let drone = DroneSettings { model: *model, ..DroneSettings::default() };
        let settings = EnvironmentSettings { sensors, drone, ..EnvironmentSettings::default() };
        let mut environment = Environment::new(standing(vec![], 60), settings);
        let heading_rad = |environment: &Environment| {
            let nose = environment.airframe().world_from_body.x_axis;
            real::atan2(nose.y, nose.x)
        };
        let (mut turns_rad, begin_rad) = (0.0, heading_rad(&environment));
        for step in 0..40 {
            let view = ViewRates { yaw_rad_s: 0.3, pitch_rad_s: 0.0 };
            let velocity_mps = if step < 20 { DVec3::X } else { DVec3::ZERO };
            environment.step(Some(&Action { velocity_mps, view, ..Action::default() }));
            let [(sensor, values)] = &readings(&environment)[..] else { panic!("one sensor") };
            assert_eq!(values.len(), sensor.quantities.len());
            let airframe = environment.airframe();
            let force = airframe.force_in_body().to_array();
            assert!(force.iter().zip(values).all(|(exact, value)| (exact - value).abs() < 0.1), "{force:?} {values:?}");
            // Thrust alone is felt along z, but for the drag of a quadrotor.
            assert!(
                force[0].abs() + force[1].abs() < 1.0 && (force[2] - 9.81).abs() < 3.0,
                "{}: {force:?}",
                model.name
            );
            turns_rad += airframe.rates_in_body.z * settings.step_s;
        }
        let turned_rad = heading_rad(&environment) - begin_rad;
        assert!(turned_rad > 0.8 && (turns_rad - turned_rad).abs() < 0.1, "{}: {turns_rad}, {turned_rad}", model.name);
    }
}

#[test]
fn sensors_meet_roofs_and_whoever_is_below() {
    let sensors = SensorSet::of(|sensor| sensor.name == "laser_altimeter");
    let settings = EnvironmentSettings { sensors, ..EnvironmentSettings::default() };
    let range_m = |episode: Episode| {
        let [(sensor, values)] = &readings(&Environment::new(Arc::new(episode), settings))[..] else {
            panic!("one sensor")
        };
        assert_eq!((sensor.name, values.len()), ("laser_altimeter", 2));
        values[0]
    };
    // 20 m above the origin; the target stands 20 m ahead.
    let plain = Episode::clone(&standing(vec![], 1));
    assert_eq!(range_m(plain.clone()), 100.0, "flat ground without surfaces is no ground");
    let roof = OrientedBox::from_corners(DVec3::new(-1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, 8.0));
    assert_eq!(range_m(Episode::clone(&standing(vec![roof], 1))), 12.0);
    let start = Start { position_in_world: DVec3::new(20.0, 0.0, 20.0), ..plain.start };
    let above_target = 20.0 - plain.target.height_m;
    assert_eq!(range_m(Episode { start, ..plain.clone() }), above_target);
    let bus = crossing(BodyKind::Bus, DVec3::new(11.0, 2.5, 3.0), DVec3::ZERO, 0.0, 2);
    let others = Arc::new(Others::new(&around(vec![bus], 2), None));
    assert_eq!(range_m(Episode { others, ..plain.clone() }), 17.0);
    assert!(readings(&Environment::new(Arc::new(plain), EnvironmentSettings::default())).is_empty());
}
