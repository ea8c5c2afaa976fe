//! Laws of the environment: same actions, same steps; collisions; latency; baselines that rank as they should.

use crate::policies::{BASELINES, Knowledge, baseline};
use crate::{Action, Axes, End, Environment, Episode, Place, Reward, Score, Settings, Start};
use cosfly_frames::{DVec3, Seed, TargetState, TargetTrack};
use cosfly_geometry::OrientedBox;
use cosfly_planner::{MucoConfig, PlanOutcome, PlanRequest, Trajectory, plan_request};
use cosfly_scenes::{Scene, SceneKind};
use std::sync::Arc;

/// Episodes behind walkers of a scene with their experts' flights.
fn episodes(kind: SceneKind, count: u64, frames: usize) -> Vec<(Arc<Episode>, Knowledge, Trajectory)> {
    let scene = Scene::generate(kind, 3);
    let place = Arc::new(Place::on_flat_ground(scene.boxes.clone()));
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
            start: Start { position_in_world: waypoints[0], velocity_in_world },
            seed: Seed::of_item(3, "episodes", &index.to_string()),
        };
        let knowledge = Knowledge { flight: waypoints.into(), config: Arc::clone(&config) };
        Some((Arc::new(episode), knowledge, *flight))
    });
    flights.collect()
}

fn flown(name: &str, episode: &Arc<Episode>, knowledge: &Knowledge, settings: Settings) -> Score {
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
        place: Arc::new(Place::on_flat_ground(boxes)),
        target: Arc::new(TargetTrack {
            dt_s: 0.5,
            height_m: 1.75,
            radius_m: 0.25,
            states: vec![target; 2 * seconds + 1],
        }),
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
            let score = flown("expert", episode, knowledge, Settings::default());
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
        let scores = all.iter().map(|(episode, knowledge, _)| flown(name, episode, knowledge, Settings::default()));
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
        let first = flown(name, &episode, &knowledge, Settings::default());
        assert_eq!(flown(name, &episode, &knowledge, Settings::default()), first, "{name}");
    }
    let mut used = Environment::new(standing(vec![], 5), Settings::default());
    (0..10).for_each(|_| _ = used.step(Some(&Action::of_numbers([3.0, 1.0, 0.0, 9.0, 2.0]))));
    used.reset(Arc::clone(&episode));
    let mut fresh = Environment::new(episode, Settings::default());
    for step in 0..50 {
        let action = Action::of_numbers([f64::from(step % 7), -1.0, 0.2, 3.0, -1.0]);
        assert_eq!(used.step(Some(&action)), fresh.step(Some(&action)));
    }
}

#[test]
fn a_drone_does_not_fly_through_a_wall_however_thin() {
    let wall = OrientedBox {
        center_in_world: DVec3::new(8.0, 0.0, 20.0),
        half_extents_m: DVec3::new(0.001, 5.0, 5.0),
        yaw_rad: 0.0,
    };
    let settings = Settings { step_s: 0.5, ..Settings::default() };
    let mut environment = Environment::new(standing(vec![wall], 20), settings);
    let ahead = Action { axes: Axes::World, velocity_mps: 12.0 * DVec3::X, ..Action::default() };
    while environment.score().end.is_none() {
        environment.step(Some(&ahead));
    }
    let after = environment.step(Some(&ahead));
    assert_eq!(after.end, Some(End::Collision));
    assert!(environment.observation().motion.position_in_world.x < 8.0 + 6.0);
    assert_eq!(after.reward, Reward::default(), "after the end nothing moves");
    let mut sinking = Environment::new(standing(vec![], 60), Settings::default());
    while sinking.score().end.is_none() {
        sinking.step(Some(&Action::of_numbers([0.0, 0.0, -3.0, 0.0, 0.0])));
    }
    assert_eq!((sinking.score().end, sinking.observation().above_ground_m < 0.3), (Some(End::Collision), true));
}

#[test]
fn an_action_takes_effect_after_the_latency_and_meanwhile_none_is_asked_for() {
    let ahead = Action { axes: Axes::World, velocity_mps: 2.0 * DVec3::X, ..Action::default() };
    // (latency, number of actions asked for in six steps, step after which the drone first moves)
    for (latency_s, asked, moves) in [(0.0, 6, 1), (0.057, 6, 1), (0.1, 6, 2), (0.2, 3, 3), (0.25, 2, 3)] {
        let settings = Settings { latency_s, ..Settings::default() };
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
fn a_lost_target_ends_the_episode_and_is_remembered_as_it_was_seen() {
    let mut environment = Environment::new(standing(vec![], 60), Settings::default());
    let turn = Action::of_numbers([0.0, 0.0, 0.0, 60.0, 0.0]);
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
