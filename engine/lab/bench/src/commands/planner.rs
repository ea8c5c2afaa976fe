//! `planner`: cosfly's planner, the paper's, and the baselines on the same paths.

use super::outcome::{Outcome, Refusals, json, print};
use super::town_of_recipe;
use clap::Args;
use clap::builder::PossibleValuesParser;
use cosfly_lab::planner::many::{ManyOptions, many};
use cosfly_lab::planner::phases::phases;
use cosfly_lab::planner::scene::Ground;
use cosfly_lab::planner::solver::solver;
use cosfly_lab::planner::{Contender, PlannerOptions, front, outcomes, table, tabulate};
use cosfly_planner::MucoConfig;
use cosfly_scenes::SceneKind;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::path::PathBuf;

/// Default scenes of the table.
const SCENES: [SceneKind; 5] =
    [SceneKind::Light, SceneKind::Leafy, SceneKind::Alley, SceneKind::Canyon, SceneKind::Fine];

/// Default number of paths per scene.
const PATHS: usize = 20;
/// Default seed.
const SEED: u64 = 1;

/// Examples of `planner`.
pub const EXAMPLES: &str = "\
Examples:
  cosfly-lab planner                                       five scenes, 20 paths each, every planner (minutes)
  cosfly-lab planner --scene light --paths 5 --seed 7      one scene, paths that nobody has seen
  cosfly-lab planner --recipe recipes/carla_town.toml      a recipe's own town and walks
  cosfly-lab planner --recipe my.toml --paths 20 --seed 9  its town, twenty other walks
  cosfly-lab planner --planner cosfly --planner astar      two planners
  cosfly-lab planner --front --recipe recipes/carla_town.toml --paths 60   visibility against learnability
  cosfly-lab planner --solver --scene leafy                the paper's solver table: trees or none, one path or many
  cosfly-lab planner --split                               where our planner's time goes
  cosfly-lab planner --many 6000                           a dataset's worth on all cores
  cosfly-lab planner --many 10000 --seed 1000              the same to count collisions (there should be none)
  cosfly-lab planner --many 10000 --movers 50              the same among people, vehicles and things that fly
  cosfly-lab planner --many 40 --movers 50 --planner astar A* among the same, by the same judge";

/// Arguments of `planner`.
#[derive(Args, Debug)]
pub struct PlannerArguments {
    /// Scenes; by default light, leafy, alley, canyon and fine, with `--many` all scenes (repeatable)
    #[arg(long = "scene", value_name = "NAME", value_parser = scene_names())]
    pub scenes: Vec<String>,
    /// The town and the walks of a recipe instead of scenes
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scenes", "many"])]
    pub recipe: Option<PathBuf>,
    /// Planners; by default all up to `dp` (repeatable); with `--many` a single one, by default `cosfly`
    #[arg(long = "planner", value_name = "NAME", value_parser = planner_names())]
    pub planners: Vec<String>,
    /// Paths per scene [default: 20; as many as the recipe has walkers with `--recipe`]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = from_one)]
    pub paths: Option<usize>,
    /// Seed of the scenes and their walkers [default: 1; the recipe's own with `--recipe`]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Plan this many paths on all cores, check each, and list flights that come too near to obstacles
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = from_one, conflicts_with = "paths")]
    pub many: Option<usize>,
    /// Boxes that move around each walker; their paths are also planned without them, to compare the time
    #[arg(long, value_name = "N", default_value_t = 0, requires = "many")]
    pub movers: usize,
    /// Time the paper's pipeline without a tree, with a tree, and with the boxes near the path
    #[arg(long, conflicts_with_all = ["many", "planners"])]
    pub solver: bool,
    /// Time the steps of cosfly's planner
    #[arg(long, conflicts_with_all = ["many", "solver", "planners"])]
    pub split: bool,
    /// Set visibility against learnability: presets, A* and the paper's pipeline, unless `--planner` names others
    #[arg(long, conflicts_with_all = ["many", "solver", "split", "plot"])]
    pub front: bool,
    /// Set a value of the recipe, such as stages.expert.search.relative_motion=4 (repeatable)
    #[arg(long = "set", value_name = "KEY=VALUE", requires = "recipe")]
    pub set: Vec<String>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// Measures and prints the tables.
pub fn planner(arguments: &PlannerArguments) -> Outcome {
    if arguments.many.is_some() && arguments.planners.len() > 1 {
        let rule = "`--many` takes a single `--planner`\n";
        clap::Error::raw(clap::error::ErrorKind::ArgumentConflict, rule).exit();
    }
    let bar = bar();
    let progress = |done: usize, of: usize| {
        bar.set_length(of as u64);
        bar.set_position(done as u64);
    };
    let done = match arguments.many {
        Some(count) => Ok(flown_in_bulk(arguments, count, &progress)),
        None => compared(arguments, &progress),
    };
    bar.finish_and_clear();
    print(&done?)
}

/// Runs `--many`: one planner, all cores.
fn flown_in_bulk(arguments: &PlannerArguments, count: usize, progress: &(dyn Fn(usize, usize) + Sync)) -> String {
    let contender = contenders(arguments).first().copied().unwrap_or(Contender::Cosfly);
    let kinds = if arguments.scenes.is_empty() { SceneKind::ALL.to_vec() } else { kinds(arguments) };
    let (seed, config) = (arguments.seed.unwrap_or(SEED), MucoConfig::default());
    let movers = arguments.movers;
    let report = many(&ManyOptions { kinds, seed, count, movers, contender, config, progress });
    if arguments.json { json(&report) } else { report.to_string() }
}

/// Prints the tables: every planner on every path, the planner's steps, or the paper's solver table.
fn compared(arguments: &PlannerArguments, progress: &(dyn Fn(usize, usize) + Sync)) -> Result<String, Refusals> {
    let (grounds, config) = match &arguments.recipe {
        Some(recipe) => {
            let (ground, config) =
                town_of_recipe::town_of_recipe(recipe, &arguments.set, arguments.paths, arguments.seed)?;
            (vec![ground], config)
        }
        None => {
            let (seed, paths) = (arguments.seed.unwrap_or(SEED), arguments.paths.unwrap_or(PATHS));
            let scene = |kind| Ground::scene(kind, seed, paths);
            (kinds(arguments).into_iter().map(scene).collect(), MucoConfig::default())
        }
    };
    if arguments.split {
        let table = phases(&grounds, &config);
        return Ok(if arguments.json { json(&table) } else { table.to_string() });
    }
    if arguments.solver {
        let tables: Vec<_> = grounds.iter().map(|ground| solver(ground, &config)).collect();
        return Ok(if arguments.json { json(&tables) } else { tables.iter().map(ToString::to_string).collect() });
    }
    let options = PlannerOptions { grounds, contenders: contenders(arguments), config, progress };
    let planned = outcomes(&options);
    if arguments.front {
        let front = front::front(&options, &planned);
        return Ok(if arguments.json { json(&front) } else { format!("{front}\n{}", front::FRONT_LEGEND) });
    }
    let table = tabulate(&options, &planned);
    Ok(if arguments.json { json(&table) } else { format!("{table}\n{}", table::LEGEND) })
}

fn kinds(arguments: &PlannerArguments) -> Vec<SceneKind> {
    if arguments.scenes.is_empty() {
        return SCENES.to_vec();
    }
    let named = |kind: &SceneKind| arguments.scenes.iter().any(|name| name == kind.name());
    SceneKind::ALL.into_iter().filter(named).collect()
}

/// All planners, or the named ones; A* with non-default settings only by name.
fn contenders(arguments: &PlannerArguments) -> Vec<Contender> {
    if arguments.planners.is_empty() {
        return if arguments.front { Contender::of_front() } else { Contender::all() };
    }
    let named = |who: &Contender| arguments.planners.iter().any(|name| name == who.name());
    Contender::nameable().into_iter().filter(named).collect()
}

/// Progress bar on a terminal, hidden otherwise.
fn bar() -> ProgressBar {
    let terminal = std::io::stderr().is_terminal();
    let target = if terminal { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
    let style = ProgressStyle::with_template("planning {wide_bar:.cyan/blue} {pos}/{len} {eta:>5} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::with_draw_target(Some(0), target).with_style(style)
}

/// Parses a count of at least 1.
fn from_one(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| *count > 0);
    count.ok_or_else(|| "it must be a whole number from 1 on".to_owned())
}

fn scene_names() -> PossibleValuesParser {
    PossibleValuesParser::new(SceneKind::ALL.map(SceneKind::name))
}

fn planner_names() -> PossibleValuesParser {
    PossibleValuesParser::new(Contender::nameable().into_iter().map(Contender::name))
}
