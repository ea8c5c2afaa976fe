//! The command line: commands, options, help with examples.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use cosfly_bench::planner::Contender;
use cosfly_planner::scenes::SceneKind;
use cosfly_preview::FrameList;
use std::path::PathBuf;

/// The whole command line.
#[derive(Debug, Parser)]
#[command(name = "cosfly", version, about, long_about = LONG_ABOUT, after_long_help = AFTER_HELP, max_term_width = 100)]
pub struct Arguments {
    /// What to do
    #[command(subcommand)]
    pub command: Command,
}

const LONG_ABOUT: &str = "\
Datasets that teach drones to follow a moving target without losing sight of it.

A recipe (one TOML file) describes a town, pedestrians, an expert drone pilot, pictures, captions and a dataset; \
`cosfly run` makes it, item by item, and never computes the same item twice.";

/// Examples and exit codes.
pub const AFTER_HELP: &str = "\
Examples:
  cosfly run recipes/carla_town.toml               make the dataset in out/carla_town
  cosfly plan recipes/carla_town.toml              what would run, and why
  cosfly run recipes/carla_town.toml --set stages.walkers.count=20
  cosfly why recipes/carla_town.toml expert/p00003 what changed since this was last made
  cosfly verify out/carla_town                     check a finished dataset
  cosfly preview out/carla_town                    pictures of a finished flight
  cosfly eval mine.jsonl --dataset out/carla_town  scores of a model's predictions, beside baselines
  cosfly export out/carla_town --format v7 --out out/town-v7

Exit codes:
    0  everything was done
    1  `verify`, `doctor` or `dataset lint` found something wrong, `plan-from` no flight, or `eval` rows that it cannot score
    2  the command line was not understood
    3  the recipe asks for something that cannot be
    4  an input file, the store or a state asked about is broken or does not fit
    5  the machine refused: disk full, no permission, a file vanished
   70  cosfly itself is wrong; please report it
  130  stopped by Ctrl-C; what is finished stays finished

Environment:
  COSFLY_STORE  folder of the store, where `--store` is not given
  COSFLY_SIMD   plain, avx2 or avx512, the best there is unless set; every one makes the same bytes
  NO_COLOR      no colours";

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Make everything a recipe describes
    #[command(after_help = "\
Examples:
  cosfly run recipes/small.toml
  cosfly run recipes/carla_town.toml --jobs 1 --out /data/town
  cosfly run recipes/carla_town.toml --set stages.expert.weights.visibility=5 --set seed=7")]
    Run(RunArguments),
    /// Show the DAG of a recipe: items per stage, what is cached, what would run and why, predicted size
    Plan(PlanArguments),
    /// Ask a finished recipe's expert how to go on from any state of a drone (relabelling, as for DAgger)
    #[command(after_help = "\
Examples:
  cosfly plan-from recipes/small.toml --trajectory expert-p00000 --frame 5 --position 60 60 24
  cosfly plan-from recipes/small.toml --trajectory perturbed-p00000 --frame 8 --position 60 61 24 \\
      --velocity 1 0 0 --horizon 4 --json
  cosfly plan-from recipes/small.toml --batch < states.jsonl > answers.jsonl

A line of a batch is like
  {\"trajectory\": \"expert-p00000\", \"frame\": 5, \"position\": [60, 60, 24], \"velocity\": [1, 0, 0], \"horizon_s\": 4}
velocity and horizon_s may be left out. Each answer is one line of JSON, written at once. Places are in the world
frame, metres. `cosfly run` must have made the recipe's trajectories before.")]
    PlanFrom(PlanFromArguments),
    /// Say which field or input changed since a stage or an item was last made
    #[command(after_help = "\
Examples:
  cosfly why recipes/carla_town.toml expert
  cosfly why recipes/carla_town.toml frames/expert-p00003")]
    Why(WhyArguments),
    /// Print the DAG as a Mermaid or DOT drawing
    Graph(GraphArguments),
    /// Check a finished dataset: hashes, counts, CRCs, schemas, reprojection, action and pose
    Verify(VerifyArguments),
    /// Work with finished datasets: lint their splits, name versions, compare them, write them out again
    #[command(subcommand)]
    Dataset(crate::dataset_arguments::DatasetCommand),
    /// Examine anyone's data: splits that leak, signs, units, shifts, frozen frames, times, instructions, limits
    #[command(after_help = "\
Examples:
  cosfly doctor out/carla_town                       a dataset of cosfly
  cosfly doctor CosFly/data_v7                       the published release
  cosfly doctor out/carla_town --quota 20:2-4        do 20 % of the episodes lose their target for 2 to 4 s?
  cosfly doctor out/carla_town --json verdict.json   every flag, and which episodes are without one

A damage is what the data say and is not so; an imperfection is true and worse than elsewhere. Exits with 1 when there is a
damage, more imperfect episodes than --imperfect allows, or a quota that is not met.")]
    Doctor(DoctorArguments),
    /// Draw a finished flight: contact sheet, animated clip, plan of town and paths
    #[command(after_help = "\
Examples:
  cosfly preview out/carla_town                                  its first flight, into out/carla_town-preview
  cosfly preview out/carla_town --trajectory perturbed-p00002
  cosfly preview out/carla_town --frames 0,50,100
  cosfly preview out/carla_town --frames 0..200:10 --out pictures

A range ends before its second number: `0..200:10` is 0, 10, ... 190. Without `--frames`, the sheet shows six frames and
the clip up to a hundred, evenly spread.")]
    Preview(PreviewArguments),
    /// Score a model's predictions on a finished dataset, beside baselines, by kind of window, with 95 % intervals
    #[command(after_help = "\
Examples:
  cosfly eval predictions.jsonl --dataset out/carla_town
  cosfly eval predictions.parquet --dataset out/carla_town --split test --out scores
  cosfly eval answers.jsonl --dataset out/carla_town --frame body --missing-as-zero
  cosfly eval --dataset out/carla_town                                          the baselines alone
  cosfly eval --dataset out/carla_town --train                                  and small networks, in a minute

A line of predictions is like
  {\"trajectory_id\": \"perturbed-p00000\", \"frame\": 3, \"waypoint_deltas\": [[0.5, 0, 0, 0, 2, 0], ... five in all]}
with the first frame of a window (0, 3, 6, ...) and, per waypoint, dx, dy, dz (m), dpitch, dyaw, droll (degrees) as an
array or an object; a missing dimension counts as 0. Instead of `waypoint_deltas`, `text` may hold what a model wrote:
what is before `</think>` is dropped, and a JSON object in it has `waypoint_deltas`. Optional `boxes` are the target's
boxes in the waypoints' frames. Parquet has the same columns.

Rows that cannot be scored are counted and named; the exit code is then 1, and 4 when no row fits.")]
    Eval(EvalArguments),
    /// Write a finished dataset in the format of others
    #[command(after_help = EXPORT_HELP)]
    Export(ExportArguments),
    /// Write the job with which `plugins/carla/replay.py` flies a dataset's flights through a CARLA server
    #[command(after_help = "\
Examples:
  cosfly carla-job out/Town01 --out job.json
  cosfly carla-job out/Town01 --out job.json --trajectory expert-p00000 --trajectory perturbed-p00000

The job holds poses, walks, weathers and cameras. The script then makes logs with the same topics, whose pictures are the
server's; the map must be one that the server has.")]
    CarlaJob(CarlaJobArguments),
    /// Free space in the store; shows what would go unless `--delete` is given
    Gc(GcArguments),
    /// Print the recipe's JSON Schema, or a generated reference page
    Schema(SchemaArguments),
    /// Print a generated OpenDRIVE town
    #[command(after_help = "Example:\n  cosfly town --seed 7 > my_town.xodr")]
    Town(TownArguments),
    /// Begin, check and measure plugins: cost terms, objectives and stages of your own
    #[cfg(feature = "plugins")]
    #[command(subcommand)]
    Plugin(PluginCommand),
    /// Measure
    #[command(subcommand)]
    Bench(BenchCommand),
    /// Run one planned task (what schedulers call)
    #[command(subcommand)]
    Task(TaskCommand),
}

/// Where the store is.
#[derive(Args, Clone, Debug)]
pub struct StoreArguments {
    /// Folder of the store [default: $COSFLY_STORE, else .cosfly in the current folder]
    #[arg(long, value_name = "DIR", env = "COSFLY_STORE", hide_env = true)]
    pub store: Option<PathBuf>,
}

/// A recipe with changes to it.
#[derive(Args, Clone, Debug)]
pub struct RecipeArguments {
    /// The recipe (TOML)
    #[arg(value_name = "RECIPE")]
    pub recipe: PathBuf,
    /// Change a value of the recipe, such as stages.expert.weights.visibility=5 (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub overrides: Vec<String>,
}

/// Arguments of `run`.
#[derive(Args, Debug)]
pub struct RunArguments {
    #[command(flatten)]
    pub recipe: RecipeArguments,
    #[command(flatten)]
    pub store: StoreArguments,
    /// Folder for the dataset [default: out/<recipe name>]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Tasks at the same time [default: one per core]
    #[arg(long, short, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Print the summary as JSON
    #[arg(long)]
    pub json: bool,
    /// Print errors and the last line only
    #[arg(long, short)]
    pub quiet: bool,
}

/// Arguments of `plan`.
#[derive(Args, Debug)]
pub struct PlanArguments {
    #[command(flatten)]
    pub recipe: RecipeArguments,
    #[command(flatten)]
    pub store: StoreArguments,
}

/// Arguments of `plan-from`.
#[derive(Args, Debug)]
pub struct PlanFromArguments {
    #[command(flatten)]
    pub recipe: RecipeArguments,
    #[command(flatten)]
    pub store: StoreArguments,
    /// The trajectory that the drone left, such as expert-p00000; of a twin, its expert answers
    #[arg(long, value_name = "ID", required_unless_present = "batch")]
    pub trajectory: Option<String>,
    /// Frame of the trajectory at which the drone is there
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = from_zero, required_unless_present = "batch")]
    pub frame: Option<usize>,
    /// Where the drone is, metres
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, required_unless_present = "batch")]
    pub position: Option<Vec<f64>>,
    /// How it moves, m/s
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, default_values_t = [0.0, 0.0, 0.0], hide_default_value = true)]
    pub velocity: Vec<f64>,
    /// How much of the way to tell [default: to the trajectory's end]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub horizon: Option<f64>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Read states from standard input, one JSON object per line, and answer each with one line of JSON
    #[arg(long, conflicts_with_all = ["trajectory", "frame", "position", "velocity", "horizon"])]
    pub batch: bool,
}

/// Arguments of `why`.
#[derive(Args, Debug)]
pub struct WhyArguments {
    #[command(flatten)]
    pub recipe: RecipeArguments,
    /// A stage, or one of its items
    #[arg(value_name = "STAGE[/ITEM]")]
    pub subject: String,
    #[command(flatten)]
    pub store: StoreArguments,
}

/// Arguments of `graph`.
#[derive(Args, Debug)]
pub struct GraphArguments {
    #[command(flatten)]
    pub recipe: RecipeArguments,
    /// Language of the drawing
    #[arg(long, value_enum, default_value_t = GraphFormat::Mermaid)]
    pub format: GraphFormat,
}

/// Languages of drawings.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum GraphFormat {
    /// For Markdown pages
    Mermaid,
    /// For Graphviz
    Dot,
}

/// Arguments of `verify`.
#[derive(Args, Debug)]
pub struct VerifyArguments {
    /// Folder of the dataset
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
    /// Make so many flights anew from the recipe alone, in an empty store, and compare their logs byte by byte
    #[arg(long, value_name = "N")]
    pub regenerate: Option<u16>,
    /// The recipe for `--regenerate` [default: that of the named version that has these files]
    #[arg(long, value_name = "RECIPE", requires = "regenerate")]
    pub recipe: Option<PathBuf>,
    /// Change a value of that recipe (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE", requires = "recipe")]
    pub overrides: Vec<String>,
    #[command(flatten)]
    pub store: StoreArguments,
}

/// Arguments of `doctor`.
#[derive(Args, Debug)]
pub struct DoctorArguments {
    /// Folder of the data
    #[arg(value_name = "DIR")]
    pub dir: PathBuf,
    /// Share of imperfect episodes that does no harm, percent
    #[arg(long, value_name = "PERCENT", default_value_t = 5.0)]
    pub imperfect: f64,
    /// Share of episodes, percent, that lose their target for a time between two lengths in seconds (repeatable)
    #[arg(long = "quota", value_name = "PERCENT:FROM-TO", value_parser = quota)]
    pub quotas: Vec<cosfly_doctor::Quota>,
    /// Write everything that was found as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

fn quota(text: &str) -> Result<cosfly_doctor::Quota, String> {
    let parts = text.split_once(':').and_then(|(share, times)| Some((share, times.split_once('-')?)));
    let number = |text: &str| text.parse::<f64>().ok().filter(|number| number.is_finite() && *number >= 0.0);
    let numbers = parts.and_then(|(share, (from, to))| Some((number(share)?, number(from)?, number(to)?)));
    match numbers {
        Some((percent, from, to)) if percent <= 100.0 && from <= to => {
            Ok(cosfly_doctor::Quota { wanted: percent / 100.0, lost_s: (from, to) })
        }
        _ => Err("it must be a percentage, a colon and two times in seconds, such as 20:2-4".to_owned()),
    }
}

/// Arguments of `preview`.
#[derive(Args, Debug)]
pub struct PreviewArguments {
    /// Folder of the dataset that `cosfly run` delivered
    #[arg(value_name = "DATASET")]
    pub dir: PathBuf,
    /// The flight to draw, such as expert-p00000 [default: the first one]
    #[arg(long, value_name = "ID")]
    pub trajectory: Option<String>,
    /// Frames to show, such as 0,50,100 or 0..200:10
    #[arg(long, value_name = "LIST")]
    pub frames: Option<FrameList>,
    /// Folder for the pictures [default: <DATASET>-preview]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Arguments of `eval`.
#[derive(Args, Debug)]
pub struct EvalArguments {
    /// Predictions, JSON lines or Parquet [default: none, the baselines alone]
    #[arg(value_name = "PREDICTIONS")]
    pub predictions: Option<PathBuf>,
    /// Folder of the dataset that `cosfly run` delivered
    #[arg(long, value_name = "DIR")]
    pub dataset: PathBuf,
    /// Folder for report.md, report.json and errors.svg [default: <PREDICTIONS>-evaluation]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Splits to score (repeatable) [default: those of the predicted flights; without predictions, all but train]
    #[arg(long = "split", value_name = "NAME")]
    pub splits: Vec<String>,
    /// Axes of the increments: those of the world, or of the body that moves (x ahead, y right, z up)
    #[arg(long, value_enum, default_value_t = FrameChoice::World)]
    pub frame: FrameChoice,
    /// Pose that each increment starts from: the waypoint before, or the current pose for all
    #[arg(long, value_enum, default_value_t = OriginChoice::Previous)]
    pub from: OriginChoice,
    /// Pose that the first increment starts from: the last one of the input, or the expert's in the same frame
    #[arg(long, value_enum, default_value_t = AnchorChoice::Input)]
    pub anchor: AnchorChoice,
    /// Flights that models see
    #[arg(long, value_enum, default_value_t = RoleChoice::Perturbed)]
    pub input: RoleChoice,
    /// Frames that a model sees
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = counts())]
    pub history: usize,
    /// Waypoints that it predicts
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = counts())]
    pub horizon: usize,
    /// Frames from one window to the next
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = counts())]
    pub stride: usize,
    /// Score windows without a prediction as if all increments were zero, instead of leaving them out
    #[arg(long)]
    pub missing_as_zero: bool,
    /// Train small networks on split train, too, and test two findings of the paper with them
    #[arg(long)]
    pub train: bool,
    /// Resamples behind an interval
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = counts())]
    pub resamples: usize,
    /// Seed of resamples and networks
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Print the report as JSON
    #[arg(long)]
    pub json: bool,
}

const EXPORT_HELP: &str = "\
Examples:
  cosfly export out/carla_town --format v7 --out out/town-v7
  cosfly export out/carla_town --format v7 --town downtown=Town03 --out out/town-v7
  cosfly export out/carla_town --format coco --split val --every 10 --out out/town-coco
  cosfly export out/carla_town --format vlm --language zh --out out/town-vlm

The new folder appears when it is whole. Flights are chosen with `--split` and `--trajectory`; without them, all are
exported.";

/// Arguments of `export`.
#[derive(Args, Debug)]
pub struct ExportArguments {
    /// Folder of the dataset that `cosfly run` delivered
    #[arg(value_name = "DATASET")]
    pub dir: PathBuf,
    /// The format
    #[arg(long, value_name = "NAME", value_parser = format_names())]
    pub format: String,
    /// The folder to make; it must not be there yet
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Splits to export (repeatable) [default: all]
    #[arg(long = "split", value_name = "NAME")]
    pub splits: Vec<String>,
    /// Flights to export, such as expert-p00000 (repeatable) [default: all]
    #[arg(long = "trajectory", value_name = "ID")]
    pub trajectories: Vec<String>,
    /// Every how many frames there is a picture; coco, webdataset, imagefolder
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = counts())]
    pub every: usize,
    /// Language of instructions; all but v7, which has them in all, and coco, which has none
    #[arg(long, value_name = "CODE", default_value = "en", value_parser = ["en", "zh"])]
    pub language: String,
    /// Axes of increments: those of the world, or of the body that moves (x ahead, y right, z up); vlm, lerobot
    #[arg(long, value_enum, default_value_t = FrameChoice::World)]
    pub frame: FrameChoice,
    /// Flights that models see; vlm
    #[arg(long, value_enum, default_value_t = RoleChoice::Perturbed)]
    pub input: RoleChoice,
    /// Frames that a model sees; vlm
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = counts())]
    pub history: usize,
    /// Waypoints that it predicts; vlm
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = counts())]
    pub horizon: usize,
    /// Frames from one window to the next; vlm
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = counts())]
    pub stride: usize,
    /// Scale of boxes in texts: pixels, or thousandths of width and height; vlm
    #[arg(long, value_enum, default_value_t = BoxScaleChoice::Pixels)]
    pub box_scale: BoxScaleChoice,
    /// Size from which on a new file begins, MB; webdataset
    #[arg(long, value_name = "MB", default_value_t = 300, value_parser = counts())]
    pub shard_size: usize,
    /// v7: a name of CARLA for a town of another name, such as downtown=Town01 (repeatable)
    #[arg(long = "town", value_name = "TOWN=NAME", value_parser = town_name)]
    pub towns: Vec<(String, String)>,
}

/// Scale of boxes in texts.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum BoxScaleChoice {
    /// Pixels of the pictures
    Pixels,
    /// Thousandths of width and height
    Thousandths,
}

fn format_names() -> PossibleValuesParser {
    let formats = cosfly_export::EXPORTERS;
    PossibleValuesParser::new(formats.map(|format| PossibleValue::new(format.name()).help(format.about())))
}

fn town_name(text: &str) -> Result<(String, String), String> {
    let names = text.split_once('=').filter(|(town, name)| !town.is_empty() && !name.is_empty());
    let names = names.map(|(town, name)| (town.to_owned(), name.to_owned()));
    names.ok_or_else(|| "it must be a town of the dataset and a name for it, such as downtown=Town01".to_owned())
}

/// Axes of increments.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum FrameChoice {
    /// The world's
    World,
    /// The body's
    Body,
}

/// Where increments start.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum OriginChoice {
    /// At the waypoint before
    Previous,
    /// At the current pose, all of them
    Current,
}

/// Where the first increment starts.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum AnchorChoice {
    /// Where the drone is
    Input,
    /// Where the expert is
    Expert,
}

/// Flights that models see.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum RoleChoice {
    /// Perturbed ones
    Perturbed,
    /// Experts
    Expert,
}

/// Arguments of `carla-job`.
#[derive(Args, Debug)]
pub struct CarlaJobArguments {
    /// Folder of the dataset that `cosfly run` delivered
    #[arg(value_name = "DATASET")]
    pub dir: PathBuf,
    /// The job file
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Flights, such as expert-p00000 (repeatable) [default: all]
    #[arg(long = "trajectory", value_name = "ID")]
    pub trajectories: Vec<String>,
}

/// Arguments of `gc`.
#[derive(Args, Debug)]
pub struct GcArguments {
    #[command(flatten)]
    pub store: StoreArguments,
    /// Really delete; without it the sizes are only shown
    #[arg(long)]
    pub delete: bool,
    /// Runs per recipe whose results stay
    #[arg(long, value_name = "N", default_value_t = 3)]
    pub keep_runs: usize,
    /// Nothing younger than this goes
    #[arg(long, value_name = "DAYS", default_value_t = 7)]
    pub keep_days: u64,
}

/// Arguments of `schema`.
#[derive(Args, Debug)]
pub struct SchemaArguments {
    /// The recipe reference as Markdown instead
    #[arg(long, conflicts_with = "tables")]
    pub reference: bool,
    /// The dataset's tables and channels as Markdown instead
    #[arg(long)]
    pub tables: bool,
}

/// Arguments of `town`.
#[derive(Args, Debug)]
pub struct TownArguments {
    /// Seed; every seed is another town
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
}

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
    /// Frames per thread that are drawn, encoded and written at once
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = counts())]
    pub frames: usize,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Measure nothing; write the boxes and cameras of the second town as JSON
    #[arg(long, value_name = "FILE")]
    pub boxes: Option<PathBuf>,
}

/// A number from 1 to a million.
fn counts() -> impl TypedValueParser<Value = usize> {
    clap::value_parser!(u64).range(1..=1_000_000).map(|count| count as usize)
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

/// Counts of things that are numbered from 0.
fn from_zero(text: &str) -> Result<usize, String> {
    text.parse().map_err(|_| "it must be a whole number from 0 on".to_owned())
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

/// What is done with plugins.
#[cfg(feature = "plugins")]
#[derive(Debug, Subcommand)]
pub enum PluginCommand {
    /// Write the beginning of a plugin: a Rust project that builds
    #[command(after_help = "Example:\n  cosfly plugin new --kind cost-term keep_low")]
    New(PluginNewArguments),
    /// Say what a plugin is and wants, and try the laws of its kind: pure, finite, local, gradient
    #[command(after_help = "\
Examples:
  cosfly plugin check recipes/plugins/orbit.wasm
  cosfly plugin check recipes/plugins/wind.wasm --params '{\"speed_mps\": 9}'")]
    Check(PluginFileArguments),
    /// Measure what the border costs: plugins against the same terms in native code, and a cost term of your own
    #[command(after_help = "\
Examples:
  cosfly plugin bench
  cosfly plugin bench recipes/plugins/wind.wasm")]
    Bench(PluginBenchArguments),
}

/// Kinds of plugins.
#[cfg(feature = "plugins")]
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum PluginKind {
    /// Says what is costly about a flight
    CostTerm,
    /// Says what to look at, from where, when
    Objective,
    /// Judges or labels finished flights
    Stage,
}

/// Arguments of `plugin new`.
#[cfg(feature = "plugins")]
#[derive(Args, Debug)]
pub struct PluginNewArguments {
    /// What it is to be
    #[arg(long, value_enum)]
    pub kind: PluginKind,
    /// Folder to write, called like the plugin
    #[arg(value_name = "NAME")]
    pub path: PathBuf,
}

/// Arguments of `plugin check`.
#[cfg(feature = "plugins")]
#[derive(Args, Debug)]
pub struct PluginFileArguments {
    /// The plugin
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Its parameters as a JSON object [default: its defaults]
    #[arg(long, value_name = "JSON")]
    pub params: Option<String>,
    /// Run it in strict mode with this many instructions per call
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub fuel: u64,
}

/// Arguments of `plugin bench`.
#[cfg(feature = "plugins")]
#[derive(Args, Debug)]
pub struct PluginBenchArguments {
    /// A cost term of your own, measured beside the others
    #[arg(value_name = "FILE")]
    pub file: Option<PathBuf>,
    /// Its parameters as a JSON object [default: its defaults]
    #[arg(long, value_name = "JSON")]
    pub params: Option<String>,
}

/// Single tasks.
#[derive(Debug, Subcommand)]
pub enum TaskCommand {
    /// Run the task whose plan document has this digest, if it is not done yet
    Run {
        /// Digest of the plan document, 64 hex digits
        #[arg(value_name = "PLAN-DIGEST")]
        digest: String,
        #[command(flatten)]
        store: StoreArguments,
    },
}
