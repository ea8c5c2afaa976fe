//! The command line: commands, options, help with examples; one file per family of commands.

mod checks;
mod dataset;
mod evaluation;
mod export;
mod generated;
#[cfg(feature = "plugins")]
mod plugin;
mod recipes;
mod store;

pub use checks::{DoctorArguments, PreviewArguments, VerifyArguments};
pub use dataset::{CheckoutArguments, DatasetCommand, DiffArguments, LintArguments, ListArguments, TagArguments};
pub use evaluation::{AnchorChoice, EvalArguments, FrameChoice, KindChoice, OriginChoice, RoleChoice};
pub use export::{BoxScaleChoice, CarlaJobArguments, ExportArguments};
pub use generated::{SchemaArguments, TownArguments};
#[cfg(feature = "plugins")]
pub use plugin::{PluginBenchArguments, PluginCommand, PluginFileArguments, PluginKind, PluginNewArguments};
pub use recipes::{GraphArguments, GraphFormat, PlanArguments, PlanFromArguments, RunArguments, WhyArguments};
pub use store::{GcArguments, StoreArguments, TaskCommand};

use clap::builder::TypedValueParser;
use clap::{Args, Parser, Subcommand};
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
    Dataset(DatasetCommand),
    /// Examine anyone's data: splits that leak, signs, units, shifts, frozen frames, times, instructions, limits
    #[command(after_help = "\
Examples:
  cosfly doctor out/carla_town                       a dataset of cosfly
  cosfly doctor CosFly/data_v7                       the published release
  cosfly doctor my-lerobot-data                      a LeRobot dataset, exported or anyone's
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
    /// Score a model's predictions on a finished dataset: waypoints (beside baselines), depth, labels, boxes, masks
    #[command(after_help = "\
Examples:
  cosfly eval predictions.jsonl --dataset out/carla_town
  cosfly eval predictions.parquet --dataset out/carla_town --split test --out scores
  cosfly eval answers.jsonl --dataset out/carla_town --frame body --missing-as-zero
  cosfly eval depth-of-my-model --dataset out/carla_town                        a folder of PNG or .npy files
  cosfly eval results.json --dataset out/carla_town --images out/coco/annotations/instances_val.json
  cosfly eval --dataset out/carla_town                                          the baselines alone

A line of predictions is like
  {\"trajectory_id\": \"perturbed-p00000\", \"frame\": 3, \"waypoint_deltas\": [[0.5, 0, 0, 0, 2, 0], ... five in all]}
with the first frame of a window (0, 3, 6, ...) and, per waypoint, dx, dy, dz (m), dpitch, dyaw, droll (degrees) as an
array or an object; a missing dimension counts as 0. Instead of `waypoint_deltas`, `text` may hold what a model wrote:
what is before `</think>` is dropped, and a JSON object in it has `waypoint_deltas`. Optional `boxes` are the target's
boxes in the waypoints' frames. Parquet has the same columns.

Pictures: a file belongs to the frame whose number its name ends in, in a folder that is called like the trajectory, as
in `cosfly export --format imagefolder`: .../perturbed-p00000/000/000012.png. Depth is 16-bit PNG (centimetres unless
`--depth-per-metre` says otherwise; 65535 is the sky) or .npy (metres); labels are 8-bit PNG of CARLA's ids. Boxes and
masks are COCO results: an array, or lines, of
  {\"image_id\": 7, \"category_id\": 12, \"bbox\": [left, top, width, height], \"score\": 0.9}
where `trajectory_id` and `frame` may stand instead of `image_id`, and `segmentation` (run lengths) makes masks.

Rows and files that cannot be scored are counted and named; the exit code is then 1, and 4 when none fits.")]
    Eval(EvalArguments),
    /// Write a finished dataset in the format of others
    #[command(after_help = export::EXPORT_HELP)]
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
    /// Run one planned task (what schedulers call)
    #[command(subcommand)]
    Task(TaskCommand),
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

/// A number from 1 to a million.
fn counts() -> impl TypedValueParser<Value = usize> {
    clap::value_parser!(u64).range(1..=1_000_000).map(|count| count as usize)
}
