//! Prints the planners' table: `planner_table [SCENE ...] [--paths N] [--seed N] [--planner NAME ...]`.

use cosfly_bench::planner::scene::Ground;
use cosfly_bench::planner::{Contender, PlannerOptions, planner};
use cosfly_planner::MucoConfig;
use cosfly_planner::scenes::SceneKind;

fn main() {
    let (mut kinds, mut contenders) = (Vec::new(), Vec::new());
    let (mut paths, mut seed) = (5, 1);
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_default();
        match word.as_str() {
            "--paths" => paths = value().parse().unwrap_or(5),
            "--seed" => seed = value().parse().unwrap_or(1),
            "--planner" => {
                let name = value();
                contenders.extend(Contender::all().into_iter().filter(|contender| contender.name() == name));
            }
            name => kinds.extend(SceneKind::ALL.into_iter().filter(|kind| kind.name() == name)),
        }
    }
    if kinds.is_empty() {
        kinds = vec![SceneKind::Light, SceneKind::Leafy, SceneKind::Alley, SceneKind::Canyon];
    }
    if contenders.is_empty() {
        contenders = Contender::all();
    }
    let grounds = kinds.into_iter().map(|kind| Ground::scene(kind, seed, paths)).collect();
    let options = PlannerOptions { grounds, contenders, config: MucoConfig::default(), progress: &|_, _| {} };
    print!("{}", planner(&options));
}
