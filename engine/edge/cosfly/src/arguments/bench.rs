//! `bench ...`: what can be measured.

use super::counts;
use clap::builder::PossibleValuesParser;
use clap::{Args, Subcommand};
use cosfly_bench::planner::Contender;
use cosfly_planner::scenes::SceneKind;
use std::path::PathBuf;

/// What can be measured.
#[derive(Debug, Subcommand)]
pub enum BenchCommand {
    /// The engine with cheap items: cold overhead, everything cached, one parameter changed and changed back
    Engine {
        /// Items per stage; there are six stages
        #[arg(long, value_name = "N", default_value_t = 1000)]
        items: u64,
    },
    /// Box queries of our tree, of parry's and obvhs's trees and of a plain loop, per second on one core
    #[command(after_help = "\
Examples:
  cosfly bench geometry           50, 200, 2,000 and 65,000 boxes of generated towns (a minute or two)
  cosfly bench geometry --seed 7  other towns and rays
  cosfly bench geometry --json    for programs")]
    Geometry {
        /// Seed of the towns and rays
        #[arg(long, value_name = "N", default_value_t = 1)]
        seed: u64,
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Planners against each other on the same paths: visibility, distance, length, time, nodes, clearance, limits
    #[command(after_help = "\
Examples:
  cosfly bench planner                                       five scenes, 20 paths each, every planner (minutes)
  cosfly bench planner --scene light --paths 5 --seed 7      one scene, paths that nobody has seen
  cosfly bench planner --recipe recipes/carla_town.toml      a recipe's own town and walks
  cosfly bench planner --recipe my.toml --paths 20 --seed 9  its town, twenty other walks
  cosfly bench planner --planner cosfly --planner astar      two planners
  cosfly bench planner --plot out/plots --paths 3            pictures, too
  cosfly bench planner --solver --scene leafy                the paper's solver table: trees or none, one path or many
  cosfly bench planner --split                               where our planner's time goes
  cosfly bench planner --many 6000                           a dataset's worth on all cores
  cosfly bench planner --many 10000 --seed 1000              the same to count collisions (there should be none)")]
    Planner(BenchPlannerArguments),
    /// The renderer: CPU time of a frame by stage, frames per second as finished logs, distance to the memory's limits
    #[command(after_help = "\
Examples:
  cosfly bench render                                        the recipes' town and one of 2,000 boxes, 1280 x 720
  cosfly bench render --json                                 the same for machines
  cosfly bench render --weather ClearSunset --rounds 3       another weather, less noise
  cosfly bench render --width 3840 --height 2160 --views 4   4K
  cosfly bench render --town my.xodr                         another town
  cosfly bench render --boxes boxes.json                     boxes and cameras for the scripts in tests/outside/render_anchors")]
    Render(BenchRenderArguments),
}

/// Arguments of `bench render`.
#[derive(Args, Debug)]
pub struct BenchRenderArguments {
    /// An OpenDRIVE town instead of the one that `cosfly town` prints
    #[arg(long, value_name = "FILE")]
    pub town: Option<PathBuf>,
    /// Weather presets; ClearNoon, HardRainNoon and ClearNight unless told otherwise (repeatable)
    #[arg(long = "weather", value_name = "PRESET")]
    pub weathers: Vec<String>,
    /// Pixels per row
    #[arg(long, value_name = "N", default_value_t = 1280)]
    pub width: u32,
    /// Rows
    #[arg(long, value_name = "N", default_value_t = 720)]
    pub height: u32,
    /// Viewpoints per town
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = counts())]
    pub views: usize,
    /// Boxes of the second town
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = counts())]
    pub box_count: usize,
    /// Rounds over all views; the least time counts
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = counts())]
    pub rounds: usize,
    /// Frames of the flights that are drawn, encoded and written on all threads at once
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = counts())]
    pub frames: usize,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Measure nothing; write the boxes and cameras of the second town as JSON
    #[arg(long, value_name = "FILE")]
    pub boxes: Option<PathBuf>,
}

/// Arguments of `bench planner`.
#[derive(Args, Debug)]
pub struct BenchPlannerArguments {
    /// Scenes; light, leafy, alley, canyon and fine unless told otherwise, all of them with `--many` (repeatable)
    #[arg(long = "scene", value_name = "NAME", value_parser = scene_names())]
    pub scenes: Vec<String>,
    /// The town and the walks of a recipe instead of scenes
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scenes", "many"])]
    pub recipe: Option<PathBuf>,
    /// Planners; all up to `dp` unless told otherwise (repeatable); a single one with `--many`, `cosfly` unless told
    #[arg(long = "planner", value_name = "NAME", value_parser = planner_names())]
    pub planners: Vec<String>,
    /// Paths per scene [default: 20; as many as the recipe has walkers with `--recipe`]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = from_one)]
    pub paths: Option<usize>,
    /// Seed of the scenes and their walkers [default: 1; the recipe's own with `--recipe`]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Plan this many paths on all cores, judge each, and list what came too near
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = from_one, conflicts_with = "paths")]
    pub many: Option<usize>,
    /// Time the paper's own pipeline without a tree, with one, and with the boxes near the path
    #[arg(long, conflicts_with_all = ["many", "planners"])]
    pub solver: bool,
    /// Time the steps of our planner
    #[arg(long, conflicts_with_all = ["many", "solver", "planners"])]
    pub split: bool,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Draw every path from above, coloured by visibility, as SVG into this folder
    #[arg(long, value_name = "DIR", conflicts_with_all = ["many", "solver", "split"])]
    pub plot: Option<PathBuf>,
}

/// Counts of which there must be some.
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
