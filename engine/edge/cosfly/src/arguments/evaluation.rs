//! `eval`, and the choices of increments that exports share with it.

use super::counts;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Arguments of `eval`.
#[derive(Args, Debug)]
pub struct EvalArguments {
    /// Predictions: of waypoints JSON lines or Parquet, of depth or labels a folder of pictures, of boxes or masks COCO
    /// results [default: none, the baselines alone]
    #[arg(value_name = "PREDICTIONS")]
    pub predictions: Option<PathBuf>,
    /// Folder of the dataset that `cosfly run` delivered
    #[arg(long, value_name = "DIR")]
    pub dataset: PathBuf,
    /// Folder for report.md, report.json and errors.svg [default: <PREDICTIONS>-evaluation]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// What is predicted [default: by what the file or folder holds]
    #[arg(long, value_enum)]
    pub kind: Option<KindChoice>,
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
    /// Resamples behind an interval
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = counts())]
    pub resamples: usize,
    /// Seed of the resamples
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Print the report as JSON
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub pictures: PictureArguments,
}

/// What is predicted.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum KindChoice {
    /// Waypoints of the drone
    Waypoints,
    /// Depth of every pixel: a folder of 16-bit PNG or .npy files
    Depth,
    /// Label of every pixel: a folder of 8-bit PNG or .npy files
    Semantic,
    /// Boxes: COCO results, or JSON lines of them
    Boxes,
    /// Masks: the same with `segmentation`
    Masks,
}

/// Options of `eval` for pictures.
#[derive(Args, Debug)]
#[command(next_help_heading = "Options for depth, labels, boxes and masks")]
pub struct PictureArguments {
    /// Every how many frames there is a prediction
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = counts())]
    pub every: usize,
    /// What whole numbers of depth pictures count a metre as: 100 as `cosfly export` writes them, 1000 for millimetres
    #[arg(long, value_name = "NUMBER", default_value_t = 100.0, value_parser = positive)]
    pub depth_per_metre: f64,
    /// Pixels whose true depth is more do not count, metres
    #[arg(long, value_name = "METRES", default_value_t = 80.0, value_parser = positive)]
    pub max_depth: f64,
    /// Classes that are detected, such as 12 for pedestrians (repeatable) [default: all]
    #[arg(long = "category", value_name = "ID", value_parser = clap::value_parser!(u8).range(0..=28))]
    pub categories: Vec<u8>,
    /// Which frames the `image_id`s are: annotations/instances_<split>.json of `cosfly export --format coco`
    #[arg(long, value_name = "FILE")]
    pub images: Option<PathBuf>,
}

/// A number above 0.
fn positive(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
    if number.is_finite() && number > 0.0 { Ok(number) } else { Err(format!("`{text}` is not more than 0")) }
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
