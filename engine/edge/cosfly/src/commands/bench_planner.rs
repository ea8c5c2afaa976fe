//! `cosfly bench planner`: our planner, the paper's, and the baselines on the same paths.

use super::{Outcome, Refusals, town_of_recipe};
use crate::arguments::{Arguments, BenchPlannerArguments};
use crate::exit;
use clap::CommandFactory;
use cosfly_bench::planner::many::{ManyOptions, many};
use cosfly_bench::planner::phases::phases;
use cosfly_bench::planner::scene::Ground;
use cosfly_bench::planner::solver::solver;
use cosfly_bench::planner::{Contender, PathOutcome, PlannerOptions, outcomes, plot, table, tabulate};
use cosfly_diagnose::Diagnostic;
use cosfly_planner::MucoConfig;
use cosfly_planner::scenes::SceneKind;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::path::Path;

/// Scenes of the table when none is named.
const SCENES: [SceneKind; 5] =
    [SceneKind::Light, SceneKind::Leafy, SceneKind::Alley, SceneKind::Canyon, SceneKind::Fine];

/// Paths per scene when it is not said.
const PATHS: usize = 20;
/// Seed when it is not said.
const SEED: u64 = 1;

/// Measures.
pub fn planner(arguments: &BenchPlannerArguments) -> Outcome {
    if let Some(folder) = &arguments.plot {
        // Before minutes of work, not after them.
        std::fs::create_dir_all(folder).map_err(|error| unwritable(folder, &error))?;
    }
    if arguments.many.is_some() && arguments.planners.len() > 1 {
        let rule = "`--many` takes a single `--planner`";
        Arguments::command().error(clap::error::ErrorKind::ArgumentConflict, rule).exit();
    }
    let bar = bar();
    let progress = |done: usize, of: usize| {
        bar.set_length(of as u64);
        bar.set_position(done as u64);
    };
    let done = match arguments.many {
        Some(count) => flown_in_bulk(arguments, count, &progress),
        None => compared(arguments, &progress),
    };
    bar.finish_and_clear();
    crate::print(&done?)?;
    Ok(exit::SUCCESS)
}

/// `--many`: one planner, all cores.
fn flown_in_bulk(
    arguments: &BenchPlannerArguments,
    count: usize,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<String, Refusals> {
    let contender = contenders(arguments).first().copied().unwrap_or(Contender::Cosfly);
    let kinds = if arguments.scenes.is_empty() { SceneKind::ALL.to_vec() } else { kinds(arguments) };
    let (seed, config) = (arguments.seed.unwrap_or(SEED), MucoConfig::default());
    let report = many(&ManyOptions { kinds, seed, count, contender, config, progress });
    Ok(if arguments.json { json(&report) } else { report.to_string() })
}

/// The tables: every planner on every path, our planner's steps, or the paper's solver table.
fn compared(arguments: &BenchPlannerArguments, progress: &(dyn Fn(usize, usize) + Sync)) -> Result<String, Refusals> {
    let (grounds, config) = match &arguments.recipe {
        Some(recipe) => {
            let (ground, config) = town_of_recipe::town_of_recipe(recipe, arguments.paths, arguments.seed)?;
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
    let mut words = String::new();
    if let Some(folder) = &arguments.plot {
        let count = pictures(&options, &planned, folder)?;
        words = format!("\n{count} pictures in {}\n", folder.display());
    }
    let table = tabulate(&options, &planned);
    Ok(if arguments.json { json(&table) } else { format!("{table}\n{}{words}", table::LEGEND) })
}

/// Writes one picture per path; how many there are.
fn pictures(options: &PlannerOptions<'_>, planned: &[PathOutcome], folder: &Path) -> Result<usize, Refusals> {
    for outcome in planned {
        let ground = &options.grounds[outcome.ground];
        let flights: Vec<_> = options.contenders.iter().map(|who| who.name()).zip(&outcome.flights).collect();
        let file = folder.join(format!("{}-{:02}.svg", ground.name, outcome.path));
        std::fs::write(file, plot::picture(ground, outcome.path, &flights))
            .map_err(|error| unwritable(folder, &error))?;
    }
    Ok(planned.len())
}

fn unwritable(folder: &Path, error: &std::io::Error) -> Refusals {
    vec![Diagnostic::io(format!("write pictures to `{}`", folder.display()), error)]
}

fn kinds(arguments: &BenchPlannerArguments) -> Vec<SceneKind> {
    if arguments.scenes.is_empty() {
        return SCENES.to_vec();
    }
    let named = |kind: &SceneKind| arguments.scenes.iter().any(|name| name == kind.name());
    SceneKind::ALL.into_iter().filter(named).collect()
}

/// All planners, or those that were named; A* off its default settings only by name.
fn contenders(arguments: &BenchPlannerArguments) -> Vec<Contender> {
    if arguments.planners.is_empty() {
        return Contender::all();
    }
    let named = |who: &Contender| arguments.planners.iter().any(|name| name == who.name());
    Contender::nameable().into_iter().filter(named).collect()
}

fn json(value: &impl serde::Serialize) -> String {
    let mut text = serde_json::to_string_pretty(value).unwrap_or_default();
    text.push('\n');
    text
}

/// A bar on a terminal, nothing otherwise.
fn bar() -> ProgressBar {
    let terminal = std::io::stderr().is_terminal();
    let target = if terminal { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
    let style = ProgressStyle::with_template("planning {wide_bar:.cyan/blue} {pos}/{len} {eta:>5} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::with_draw_target(Some(0), target).with_style(style)
}
