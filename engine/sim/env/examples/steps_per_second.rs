//! Steps and resets per second of state-only environments: alone, and among the people around a target, on one thread and on two.

use cosfly_domain::{Around, Body, BodyKind, BodyPlan, Traffic};
use cosfly_env::{Action, Environment, EnvironmentSettings, Episode, FlightSite, Others, Start};
use cosfly_frames::{DVec3, Seed};
use cosfly_scenes::{SceneKind, SeededScene};
use std::sync::Arc;
use std::time::Instant;

const STEPS: u32 = 400_000;
const RESETS: u32 = 20_000;

fn main() {
    let scene = SeededScene::generate(SceneKind::Leafy, 3);
    println!("{} boxes", scene.boxes.len());
    let place = Arc::new(FlightSite::on_flat_ground(scene.boxes.clone()));
    for people in [0, 1000] {
        measure(&episodes(&scene, &place, people), people);
    }
}

/// Eight targets, and those of `people` who come within 60 m of each.
fn episodes(scene: &SeededScene, place: &Arc<FlightSite>, people: u64) -> Vec<Arc<Episode>> {
    let person = |number: u64| {
        let (size_m, looks) = (DVec3::new(0.5, 0.5, 1.7), Seed([number as u8; 32]));
        let plan = BodyPlan { source: String::new(), kind: BodyKind::Pedestrian, size_m, looks, group: None };
        Body { plan, first_frame: 0, states: scene.walker(3, 8 + number).states }
    };
    let bodies: Vec<Body> = (0..people).map(person).collect();
    let traffic = Traffic { name: String::new(), dt_s: 0.5, frames: 200, bodies, notes: vec![] };
    (0..8)
        .map(|index| {
            let target = scene.walker(3, index);
            let around = Around::of(&traffic, &target, None, 60.0);
            let followed = traffic.bodies.first().map(|body| body.plan.clone());
            let position_in_world = target.states[0].feet_in_world + DVec3::new(-14.0, -3.0, 30.0);
            let start = Start { position_in_world, velocity_in_world: DVec3::ZERO };
            let (name, stratum, seed) = (format!("w{index}"), String::new(), Seed([index as u8; 32]));
            Arc::new(Episode {
                name,
                stratum,
                place: Arc::clone(place),
                target: Arc::new(target),
                others: Arc::new(Others::new(&around, followed.as_ref())),
                followed,
                looks: seed,
                weather: None,
                start,
                seed,
            })
        })
        .collect()
}

fn measure(episodes: &[Arc<Episode>], people: u64) {
    let around = episodes.iter().map(|episode| episode.others.bodies().len()).sum::<usize>() / episodes.len();
    println!("{people} people, {around} of them near a target");
    for threads in [1, 2] {
        let began = Instant::now();
        std::thread::scope(|scope| (0..threads).for_each(|_| _ = scope.spawn(|| fly(episodes))));
        let seconds = began.elapsed().as_secs_f64();
        println!("{threads} threads: {:.0} steps/s", f64::from(threads * STEPS) / seconds);
    }
    let mut environment = Environment::new(Arc::clone(&episodes[0]), EnvironmentSettings::default());
    let began = Instant::now();
    (0..RESETS).for_each(|round| _ = environment.reset(Arc::clone(&episodes[round as usize % episodes.len()])));
    println!("a reset: {:.2} us", 1e6 * began.elapsed().as_secs_f64() / f64::from(RESETS));
}

/// Drones that keep their place above their targets.
fn fly(episodes: &[Arc<Episode>]) {
    let settings = EnvironmentSettings::default();
    let mut flying: Vec<Environment> = episodes.iter().map(|it| Environment::new(Arc::clone(it), settings)).collect();
    for step in 0..STEPS {
        let environment = &mut flying[step as usize % episodes.len()];
        let velocity = environment.observation().sighting.velocity_in_world;
        let action = Action { axes: cosfly_env::VelocityAxes::World, velocity_mps: velocity, ..Action::default() };
        let end = environment.step(Some(&action)).end;
        std::hint::black_box(environment.look_alikes());
        if end.is_some() {
            let episode = Arc::clone(environment.episode());
            environment.reset(episode);
        }
    }
}
