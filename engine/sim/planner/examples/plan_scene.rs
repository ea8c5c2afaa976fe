//! Plans walkers in seeded scenes and prints what came out: `plan_scene [KIND ...] [--paths N] [--seed N] [--preset paper]`.

use cosfly_domain::{Certificate, PlanOutcome};
use cosfly_geometry::BoxBvh;
use cosfly_planner::config::SearchEffort;
use cosfly_planner::{MucoConfig, Preset, plan};
use cosfly_random::Seed;
use cosfly_scenes::{Scene, SceneKind};
use std::time::Instant;

struct Options {
    kinds: Vec<SceneKind>,
    paths: u64,
    seed: u64,
    config: MucoConfig,
    each: bool,
}

fn options() -> Options {
    let mut options = Options { kinds: vec![], paths: 5, seed: 1, config: MucoConfig::default(), each: false };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_default();
        match word.as_str() {
            "--paths" => options.paths = value().parse().unwrap_or(5),
            "--seed" => options.seed = value().parse().unwrap_or(1),
            "--relative" => options.config.search.relative_motion = value().parse().unwrap_or(0.2),
            "--absolute" => options.config.search.absolute_motion = value().parse().unwrap_or(0.3),
            "--effort" if value() == "quality" => options.config.search.effort = SearchEffort::Quality,
            "--each" => options.each = true,
            "--preset" if value() == "paper" => options.config.preset = Preset::Paper,
            name => options.kinds.extend(SceneKind::ALL.iter().filter(|kind| kind.name() == name)),
        }
    }
    if options.kinds.is_empty() {
        options.kinds = vec![SceneKind::Light, SceneKind::Leafy, SceneKind::Alley, SceneKind::Canyon];
    }
    options
}

fn main() {
    let options = options();
    println!("scene    boxes paths rejected   vis  >=.5  dist m  len m  clear m  v max  a max  j max  rear deg    ms");
    for &kind in &options.kinds {
        let scene = Scene::generate(kind, options.seed);
        // The fine map is planned on its coarse twin and judged on all its boxes.
        let coarse = if kind == SceneKind::Fine { SceneKind::Leafy } else { kind };
        let planning = Scene::generate(coarse, options.seed).boxes;
        let exact = BoxBvh::build(scene.boxes.clone());
        let mut planned: Vec<Certificate> = Vec::new();
        let mut rejected = Vec::new();
        let mut seconds = 0.0;
        for index in 0..options.paths {
            let track = scene.walker(options.seed, index);
            let begin = Instant::now();
            let seed = Seed::of_item(options.seed, "plan_scene", kind.name());
            let outcome = plan(&track, &exact, &planning, &|_, _| 0.0, &options.config, seed);
            seconds += begin.elapsed().as_secs_f64();
            match outcome {
                PlanOutcome::Planned(flight) => {
                    let c = &flight.certificate;
                    if options.each {
                        let (seen, best) = (c.mean_visibility, c.lattice_visibility);
                        println!("    {index}: sees {seen:.3} of the lattice's {best:.3}, {} attempts", c.attempts);
                    }
                    planned.push(flight.certificate);
                }
                PlanOutcome::Rejected { reason, .. } => rejected.push(format!("{index}: {reason}")),
            }
        }
        print_row(kind, scene.boxes.len(), &planned, rejected.len(), 1e3 * seconds / options.paths.max(1) as f64);
        rejected.iter().for_each(|reason| println!("    rejected {reason}"));
    }
}

fn print_row(kind: SceneKind, boxes: usize, planned: &[Certificate], rejected: usize, milliseconds: f64) {
    let mean = |of: &dyn Fn(&Certificate) -> f64| planned.iter().map(of).sum::<f64>() / planned.len().max(1) as f64;
    let most = |of: &dyn Fn(&Certificate) -> f64| planned.iter().map(of).fold(0.0, f64::max);
    let clearance = planned.iter().map(|c| c.min_clearance_m).fold(f64::INFINITY, f64::min);
    println!(
        "{:<7} {:>6} {:>5} {:>8} {:>5.3} {:>5.3} {:>7.1} {:>6.0} {:>8.2} {:>6.2} {:>6.2} {:>6.2} {:>9.0} {:>5.0}",
        kind.name(),
        boxes,
        planned.len(),
        rejected,
        mean(&|c| c.mean_visibility),
        mean(&|c| c.frames_half_visible),
        mean(&|c| c.mean_distance_m),
        mean(&|c| c.length_m),
        clearance,
        most(&|c| c.max_speed_mps),
        most(&|c| c.max_acceleration_mps2),
        most(&|c| c.max_jerk_mps3),
        mean(&|c| c.mean_rear_angle_deg),
        milliseconds,
    );
}
