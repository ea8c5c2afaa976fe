//! Steps and resets per second of state-only environments, on one thread and on two.

use cosfly_env::{Action, Environment, EnvironmentSettings, Episode, FlightSite, Start};
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
    let episodes: Vec<Arc<Episode>> = (0..8)
        .map(|index| {
            let target = scene.walker(3, index);
            let position_in_world = target.states[0].feet_in_world + DVec3::new(-14.0, -3.0, 30.0);
            let start = Start { position_in_world, velocity_in_world: DVec3::ZERO };
            let (name, stratum, seed) = (format!("w{index}"), String::new(), Seed([index as u8; 32]));
            Arc::new(Episode {
                name,
                stratum,
                place: Arc::clone(&place),
                target: Arc::new(target),
                followed: None,
                looks: seed,
                weather: None,
                others: Arc::default(),
                start,
                seed,
            })
        })
        .collect();
    for threads in [1, 2] {
        let began = Instant::now();
        std::thread::scope(|scope| (0..threads).for_each(|_| _ = scope.spawn(|| fly(&episodes))));
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
        if environment.step(Some(&action)).end.is_some() {
            let episode = Arc::clone(environment.episode());
            environment.reset(episode);
        }
    }
}
