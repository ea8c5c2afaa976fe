//! What `cosfly bench planner` measures, without the rest of cosfly:
//! `planner_table [SCENE ...] [--paths N] [--seed N] [--planner NAME ...] [--many N] [--solver] [--split] [--plot DIR]`.

use cosfly_bench::planner::many::{ManyOptions, many};
use cosfly_bench::planner::phases::phases;
use cosfly_bench::planner::plot::picture;
use cosfly_bench::planner::scene::Ground;
use cosfly_bench::planner::solver::solver;
use cosfly_bench::planner::{Contender, PlannerOptions, outcomes, table, tabulate};
use cosfly_planner::MucoConfig;
use cosfly_planner::scenes::SceneKind;

fn main() {
    let (mut kinds, mut contenders) = (Vec::new(), Vec::new());
    let (mut paths, mut seed, mut count, mut solver_table, mut split, mut plots) = (5, 1, 0, false, false, None);
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_default();
        match word.as_str() {
            "--paths" => paths = value().parse().unwrap_or(5),
            "--seed" => seed = value().parse().unwrap_or(1),
            "--many" => count = value().parse().unwrap_or(1000),
            "--solver" => solver_table = true,
            "--split" => split = true,
            "--plot" => plots = Some(value()),
            "--planner" => {
                let name = value();
                contenders.extend(Contender::nameable().into_iter().filter(|contender| contender.name() == name));
            }
            name => kinds.extend(SceneKind::ALL.into_iter().filter(|kind| kind.name() == name)),
        }
    }
    if kinds.is_empty() {
        kinds = vec![SceneKind::Light, SceneKind::Leafy, SceneKind::Alley, SceneKind::Canyon];
    }
    let config = MucoConfig::default();
    if count > 0 {
        let contender = contenders.first().copied().unwrap_or(Contender::Cosfly);
        let progress = &|done: usize, of: usize| eprintln!("{done} of {of}");
        print!("{}", many(&ManyOptions { kinds, seed, count, contender, config, progress }));
        return;
    }
    if contenders.is_empty() {
        contenders = Contender::all();
    }
    let grounds: Vec<Ground> = kinds.into_iter().map(|kind| Ground::scene(kind, seed, paths)).collect();
    if split {
        print!("{}", phases(&grounds, &config));
        return;
    }
    if solver_table {
        grounds.iter().for_each(|ground| print!("{}", solver(ground, &config)));
        return;
    }
    let options = PlannerOptions { grounds, contenders, config, progress: &|_, _| {} };
    let planned = outcomes(&options);
    print!("{}", tabulate(&options, &planned));
    print!("{}", table::LEGEND);
    for outcome in planned.iter().take(if plots.is_some() { usize::MAX } else { 0 }) {
        let ground = &options.grounds[outcome.ground];
        let flights: Vec<_> = options.contenders.iter().map(|c| c.name()).zip(&outcome.flights).collect();
        let file = format!("{}/{}-{:02}.svg", plots.as_deref().unwrap_or("."), ground.name, outcome.path);
        std::fs::write(file, picture(ground, outcome.path, &flights)).expect("the folder can be written");
    }
}
