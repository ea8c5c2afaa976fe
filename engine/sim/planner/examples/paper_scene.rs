//! Flies the paper's pipeline through seeded scenes and prints what came out, good and bad:
//! `paper_scene [KIND ...] [--paths N] [--seed N] [--iterations N] [--set NAME=VALUE] [--pool] [--split]`.

use cosfly_domain::{Certificate, OrientedBox};
use cosfly_frames::{DVec3, TargetTrack};
use cosfly_geometry::{BoxBvh, SpatialQuery};
use cosfly_planner::certificate::{Kinematics, certify, swept_clearance_m};
use cosfly_planner::paper::{FocusedSurroundings, NearBoxes, PaperFlight, Threads, iteration, plan_paper_in};
use cosfly_planner::problem::Problem;
use cosfly_planner::terms::built_in_terms;
use cosfly_planner::{MucoConfig, Preset, Walk};
use cosfly_scenes::{SceneKind, SeededScene};
use cosfly_surroundings::exact::ExactMap;
use cosfly_surroundings::ground::GroundGrid;
use cosfly_surroundings::local::LocalObstacles;
use std::time::Instant;

/// A clearance below this is a collision of a body of half a metre, metres.
const BODY_M: f64 = 0.5;

struct Options {
    kinds: Vec<SceneKind>,
    paths: u64,
    seed: u64,
    split: bool,
    threads: Threads,
    config: MucoConfig,
}

fn options() -> Options {
    let mut options = Options {
        kinds: vec![],
        paths: 20,
        seed: 1,
        split: false,
        threads: Threads::Caller,
        config: MucoConfig { preset: Preset::Paper, ..MucoConfig::default() },
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_default();
        match word.as_str() {
            "--paths" => options.paths = value().parse().unwrap_or(20),
            "--seed" => options.seed = value().parse().unwrap_or(1),
            "--iterations" => options.config.descent.iterations = value().parse().unwrap_or(80),
            "--pool" => options.threads = Threads::Pool,
            "--split" => options.split = true,
            "--set" => set(&mut options, &value()),
            name => options.kinds.extend(SceneKind::ALL.iter().filter(|kind| kind.name() == name)),
        }
    }
    if options.kinds.is_empty() {
        options.kinds = vec![SceneKind::Light, SceneKind::Leafy, SceneKind::Alley, SceneKind::Canyon];
    }
    options
}

fn set(options: &mut Options, assignment: &str) {
    let (name, value) = assignment.split_once('=').unwrap_or((assignment, ""));
    let value: f64 = value.parse().unwrap_or(0.0);
    let config = &mut options.config;
    let paper = &mut config.paper;
    match name {
        "keyframe_frames" => paper.keyframe_frames = value as u32,
        "rear_sector_deg" => paper.rear_sector_deg = value,
        "search_visibility" => paper.search_visibility = value,
        "keyframe_motion" => paper.keyframe_motion = value,
        "hidden_run_frames" => paper.hidden_run_frames = value as u32,
        "projection_rounds" => paper.projection_rounds = value as u32,
        "visibility" => config.weights.visibility = Some(value),
        "pitch" => config.weights.pitch = Some(value),
        "length" => config.weights.length = Some(value),
        "difference_m" => config.descent.difference_m = value,
        "max_move_m" => config.descent.max_move_m = value,
        "min_altitude_m" => config.view.min_altitude_m = value,
        "clearance_m" => config.limits.clearance_m = value,
        "speed_mps" => config.limits.speed_mps = value,
        _ => eprintln!("`{name}` is not one of the parameters that this example sets"),
    }
}

struct Row {
    certificate: Certificate,
    flight: PaperFlight,
    colliding_segments: usize,
    unsafe_segments: usize,
    plan_ms: f64,
    iteration_ms: f64,
}

fn fly(track: &TargetTrack, exact: &BoxBvh, boxes: &[OrientedBox], options: &Options) -> Row {
    let (config, walk) = (&options.config, Walk::of(track));
    let terms = built_in_terms(&config.resolved_weights());
    let problem =
        Problem { track, view: &config.view, walk: &walk, terms: &terms, built_in: terms.len(), first_frame: 0 };
    let flat = |_: f64, _: f64| 0.0;
    let ground = GroundGrid::sample(track, &flat, config.search.filter_radius_m + 10.0);
    let influence_m = config.view.safety_influence_m;
    let begin = Instant::now();
    let obstacles = LocalObstacles::filter(track, boxes, &ground, config.search.filter_radius_m, influence_m);
    let mut near =
        NearBoxes::new(&obstacles, track.len(), influence_m).expect("one target among boxes that stand still");
    let flight = plan_paper_in(&problem, &mut near, config, &config.paper, options.threads);
    let plan_ms = 1e3 * begin.elapsed().as_secs_f64();
    near.focus_on(&flight.waypoints);
    let times = (0..5).map(|_| {
        let begin = Instant::now();
        std::hint::black_box(iteration(&problem, &near, &config.descent, options.threads, &flight.waypoints));
        1e3 * begin.elapsed().as_secs_f64()
    });
    let iteration_ms = times.fold(f64::INFINITY, f64::min);
    let certificate = certify(track, &flight.waypoints, 0, ExactMap::still(exact), &flat, config).certificate;
    let closer = |limit_m: f64| {
        let near = |pair: &&[DVec3]| exact.segment_clearance(pair[0], pair[1], limit_m + 1.0) < limit_m;
        flight.waypoints.windows(2).filter(near).count()
    };
    let (colliding_segments, unsafe_segments) = (closer(BODY_M), closer(config.limits.clearance_m));
    if options.split {
        print_split(&problem, &obstacles, exact, &flight);
    }
    Row { certificate, flight, colliding_segments, unsafe_segments, plan_ms, iteration_ms }
}

fn print_split(problem: &Problem<'_>, obstacles: &LocalObstacles<'_>, exact: &BoxBvh, flight: &PaperFlight) {
    let kinematics = Kinematics::of(problem.track, &flight.waypoints, 0);
    println!("    {:?}", flight.counts);
    let (first, last) = (flight.convergence.first(), flight.convergence.iter().rev().nth(1));
    println!("    cost {first:.0?} -> {last:.0?} -> after clean-up {:.0?}", flight.convergence.last());
    let clearance = swept_clearance_m(ExactMap::still(exact), &flight.waypoints);
    println!("    {} boxes, clearance {clearance:.2} m, {kinematics:.1?}", obstacles.count());
}

fn main() {
    let options = options();
    println!(
        "scene   paths   vis  >=.5 dist m  len m  ratio  rear  clear m  hit<.5 seg<lim  v max  a max  j max iter   ms ms/iter"
    );
    for &kind in &options.kinds {
        let scene = SeededScene::generate(kind, options.seed);
        let exact = BoxBvh::build(scene.boxes.clone());
        let rows: Vec<Row> = (0..options.paths)
            .map(|index| fly(&scene.walker(options.seed, index), &exact, &scene.boxes, &options))
            .collect();
        print_row(kind, &rows);
    }
}

fn print_row(kind: SceneKind, rows: &[Row]) {
    let mean = |of: &dyn Fn(&Row) -> f64| rows.iter().map(of).sum::<f64>() / rows.len().max(1) as f64;
    let most = |of: &dyn Fn(&Row) -> f64| rows.iter().map(of).fold(0.0, f64::max);
    let clearance = rows.iter().map(|r| r.certificate.min_clearance_m).fold(f64::INFINITY, f64::min);
    let sum = |of: &dyn Fn(&Row) -> usize| rows.iter().map(of).sum::<usize>();
    println!(
        "{:<7} {:>5} {:>5.3} {:>5.3} {:>6.1} {:>6.0} {:>6.2} {:>5.0} {:>8.2} {:>7} {:>7} {:>6.1} {:>6.1} {:>6.1} {:>4.0} {:>4.1} {:>7.3}",
        kind.name(),
        rows.len(),
        mean(&|r| r.certificate.mean_visibility),
        mean(&|r| r.certificate.frames_half_visible),
        mean(&|r| r.certificate.mean_distance_m),
        mean(&|r| r.certificate.length_m),
        mean(&|r| r.certificate.length_ratio),
        mean(&|r| r.certificate.mean_rear_angle_deg),
        clearance,
        sum(&|r| r.colliding_segments),
        sum(&|r| r.unsafe_segments),
        most(&|r| r.certificate.max_speed_mps),
        most(&|r| r.certificate.max_acceleration_mps2),
        most(&|r| r.certificate.max_jerk_mps3),
        mean(&|r| f64::from(r.flight.iterations)),
        mean(&|r| r.plan_ms),
        mean(&|r| r.iteration_ms),
    );
}
